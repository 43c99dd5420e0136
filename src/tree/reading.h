/* Options for reading a tree's file, and the report of what was found and assumed.
 *
 * Most formats state neither the unit nor the direction of flow, and many files hold a network that
 * is not a tree. A TreeReading records what was assumed, and why; `info` prints it. */
#ifndef CORCAST_TREE_READING_H
#define CORCAST_TREE_READING_H

#include "base/base.h"
#include "geom/geom.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct Tree Tree;

typedef enum LengthUnit { LENGTH_MM, LENGTH_UM, LENGTH_CM, LENGTH_M, LENGTH_UNITS } LengthUnit;

/* Per LengthUnit: its name, "mm"; NULL at the end. */
extern const char *const length_unit_names[LENGTH_UNITS + 1];
/* Returns the length of the unit in mm. */
double length_unit_mm(LengthUnit unit);
/* Converts a length from mm to a unit. Of the numbers near mm / length_unit_mm(unit), returns the
 * one that converts back to `mm` best. A number that is read and written again therefore keeps its
 * text. */
double length_from_mm(double mm, LengthUnit unit);

/* The options for reading. Zeroed: none is set. Texts are borrowed. */
typedef struct ReadOptions {
    bool has_unit, has_voxel_size;
    LengthUnit unit;  /* of coordinates and radii; if !has_unit, the format's usual unit */
    Vec3 voxel_size;  /* factors that the coordinates are multiplied by, each above 0 */
    bool voxel_radii; /* radii are in voxels, too; they are multiplied by the geometric mean
                       * of voxel_size */
    double merge_tolerance_mm; /* points this close are merged; 0: only points at one position */
    bool break_loops;          /* cut each loop at its thinnest line; false: keep it by a link */
    const char *radius_array;  /* name of the array with the radii; NULL: search for usual names */
    const char *graphml_keys;  /* "x=KEY,y=KEY,...": the GraphML keys of the attributes */
    const char *columns;       /* "x=NAME,y=NAME,...": the columns of a table */
    const char *edges;         /* path of the table of lines that belongs to a table of points */
    const char *format;        /* main extension of the format, "vtk"; NULL: detect the format from
                                * the name and the content of the file */
    double radius_mm;          /* radius of the segments for which the file states none or 0; 0: a
                                * file without radii is an error */
    bool repair_radii;         /* fill radii that are negative, infinite, 0 or missing */
} ReadOptions;

/* Factors that convert the coordinates and radii of a file to mm. */
typedef struct LengthScale {
    Vec3 position;
    double radius;
} LengthScale;

/* Returns the factors that follow from the options. Uses `unit` if the options set no unit.
 * `options` may be NULL. */
LengthScale length_scale(const ReadOptions *options, LengthUnit unit);
/* Converts a position to mm. */
Vec3 length_scaled(const LengthScale *scale, Vec3 position);

/* Why a node is a root. */
typedef enum RootReason {
    ROOT_STATED,    /* the file states that the node is a root */
    ROOT_DIRECTION, /* directed lines leave the node, and none ends there */
    ROOT_THICKEST,  /* the node is the thickest end of its connected component */
    ROOT_REASONS
} RootReason;

/* Per RootReason: a text for reports, "from the file". */
extern const char *const root_reason_texts[ROOT_REASONS];

/* A root of the tree that was read. */
typedef struct ReadRoot {
    int32_t id; /* id of the node */
    RootReason reason;
    size_t nodes; /* number of nodes in its connected component */
} ReadRoot;

/* A line that was removed to open a loop. */
typedef struct ReadCut {
    size_t record; /* index of the line in the file */
    Vec3 position; /* middle of the line, mm */
    double radius_mm;
} ReadCut;

/* READ_MAX_DEGREE and READ_MAX_CUTS bound the arrays below. READ_FEW is the minimum number of
 * points whose integer coordinates are taken for voxels, and not for chance. Reasons of the values
 * not recorded. */
enum { READ_MAX_DEGREE = 8, READ_MAX_CUTS = 1000, READ_FEW = 20 };

/* How a tree was made from a network, which consists of the points and lines of a file. */
typedef struct NetworkReading {
    size_t points, lines;  /* counts in the file */
    size_t merged;         /* count of points merged with another point */
    size_t unused;         /* count of points without a line */
    size_t without_length; /* count of lines from a point to itself */
    size_t repeated;       /* count of lines that repeat another line */
    size_t against;        /* count of lines whose direction in the file is towards the root */
    size_t loops;          /* count of lines that were cut because they closed a loop */
    size_t links;          /* count of lines that close a loop and were kept */
    size_t near_ends;      /* count of ends that nearly touch another component */
    double near_mm;        /* the widest gap at such an end */
    ReadCut *cut;          /* owned; the first READ_MAX_CUTS of the lines that were cut */
    size_t n_cuts;
} NetworkReading;

/* The report about a tree that was read. Zeroed: empty. Release with reading_release. */
typedef struct TreeReading {
    const char *format; /* name of the format, "VTK"; borrowed */
    bool is_network;    /* the format holds points and lines, not a tree; false: `network` is
                         * zeroed */
    NetworkReading network;
    ReadRoot *root; /* the roots, one per component; owned */
    size_t n_roots, roots_capacity;
    size_t degree[READ_MAX_DEGREE + 1]; /* degree[k]: count of places where k segments meet;
                                         * the last entry counts higher degrees, too */
    size_t without_radius;              /* count of segments with radius 0 */
    size_t given_radius;                /* count of segments that got ReadOptions.radius_mm */
    size_t repaired_radii;              /* count of segments whose radius was repaired */
    int32_t *repaired;                  /* ids of these segments; NULL: there are none; owned */
    double median_radius_mm;            /* median over all segments; 0 if there are none */
    LengthUnit unit;                    /* the unit that was used for coordinates and radii */
    bool unit_is_stated;                /* options or the file state the unit */
    bool voxels;                        /* coordinates were multiplied by the size of a voxel */
    bool has_plausible_unit;            /* the median radius is plausible for vessels in `unit` or,
                                         * if not, in another unit */
    LengthUnit plausible_unit;          /* this unit; set if has_plausible_unit */
    bool looks_like_voxels; /* no unit is stated, and all coordinates of READ_FEW or more points are
                             * integers */
    char **note;            /* sentences about what was assumed, without full stops; owned */
    size_t n_notes, notes_capacity;
} TreeReading;

/* Frees the report and zeroes it. */
void reading_release(TreeReading *reading);

/* Adds a sentence, without a full stop, about an assumption: "radius is the point array 'Radius'".
 * `reading` may be NULL. Errors: STATUS_MEMORY. */
MUST_CHECK Status reading_note(TreeReading *reading, Err *err, const char *format, ...)
    PRINTF_LIKE(3, 4);

/* Checks a radius of a file. NAN stands for a missing radius and is accepted. A radius that is
 * infinite or negative becomes NAN if options->repair_radii is set, and reading_fill_radii replaces
 * it later. Otherwise such a radius is an error. `options` may be NULL.
 *
 * Errors  STATUS_INPUT with a sentence that lacks the file and the record, which the caller adds.
 */
MUST_CHECK Status reading_radius(const ReadOptions *options, double *radius, Err *err);

/* Refuses a bad radius: returns STATUS_INPUT with a sentence that begins "the WHAT is 'TEXT'". The
 * caller adds the file and the record. */
MUST_CHECK Status reading_refuse_radius(const char *what, const char *text, Err *err);

/* Replaces the missing radii, which are NAN or 0, and counts them in *reading. With
 * options->repair_radii it repairs them. Otherwise they become options->radius_mm if that is above
 * 0, and the tree is not changed if it is 0.
 *
 * A repaired radius is interpolated along its branch between the nearest known radii. At an end of
 * the branch it is the nearest known radius. A branch without a known radius gets the smaller one
 * of the radii of its parent and of its thickest daughter. If both are unknown, it gets the median
 * of the tree.
 *
 * Errors  STATUS_INPUT if there is no radius at all; STATUS_MEMORY.
 * Cost    O(n). */
MUST_CHECK Status reading_fill_radii(TreeReading *reading, const ReadOptions *options, Tree *tree,
                                     Err *err);

/* Returns true if x, y and z are integers. */
bool reading_is_voxel(Vec3 position);

/* Completes the report about a tree: records the roots if no reader has recorded them, counts the
 * degrees, and finds the median radius and the plausible unit. Errors: STATUS_MEMORY. Cost:
 * O(n log n). */
MUST_CHECK Status reading_measure(TreeReading *reading, const Tree *tree, Err *err);

#endif
