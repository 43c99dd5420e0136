/* The options for reading the file of a tree (ReadOptions), and the report of the reader
 * (TreeReading).
 *
 * Most formats state neither the unit nor the direction of flow, and many files hold a network that
 * is not a tree. The report records the assumptions of the reader and their reasons; the command
 * `info` prints it. */
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
/* Converts a length from mm to a unit. The quotient is adjusted by at most one unit in the last
 * place, so that its conversion to mm is nearest to `mm`. A number that was read is thus written
 * with the same digits. */
double length_from_mm(double mm, LengthUnit unit);

/* The options for reading. Zeroed: none is set. Texts are borrowed. */
typedef struct ReadOptions {
    bool has_unit, has_voxel_size;
    LengthUnit unit;  /* of coordinates and radii; if !has_unit, the format's usual unit */
    Vec3 voxel_size;  /* factors that the coordinates are multiplied by, each above 0 */
    bool voxel_radii; /* radii are in voxels, too; they are multiplied by the geometric mean
                       * of voxel_size */
    double merge_tolerance_mm; /* points this close are merged; 0: only points at one position */
    bool break_loops;          /* cut each loop at its thinnest line; false: keep the loop. The
                                * line that closes it becomes a node with a link [Tree.link] */
    const char *radius_array;  /* name of the array with the radii; NULL: search for usual names */
    const char *graphml_keys;  /* "x=KEY,y=KEY,...": the GraphML keys of the attributes */
    const char *columns;       /* "x=NAME,y=NAME,...": the columns of a table */
    const char *edges;         /* path of the table of lines that belongs to a table of points */
    const char *format;        /* main extension of the format, "vtk"; NULL: detect the format from
                                * the name and the content of the file */
    double radius_mm;          /* radius of segments whose radius is 0 or missing in the file; 0: a
                                * file without radii is an error */
    bool repair_radii;         /* replace radii that are negative, infinite, 0 or missing
                                * [reading_fill_radii] */
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

/* READ_MAX_DEGREE and READ_MAX_CUTS limit the arrays below. With fewer than READ_MIN_POINTS points,
 * integer coordinates may be a coincidence and do not suggest voxels. The reasons for the values
 * are not recorded. */
enum { READ_MAX_DEGREE = 8, READ_MAX_CUTS = 1000, READ_MIN_POINTS = 20 };

/* How a tree was made from a network, which consists of the points and lines of a file. */
typedef struct NetworkReading {
    size_t points, lines;  /* numbers of points and lines in the file */
    size_t merged;         /* number of points merged with another point */
    size_t unused;         /* number of points without a line */
    size_t without_length; /* number of lines from a point to itself */
    size_t repeated;       /* number of lines that repeat another line */
    size_t against;        /* number of lines whose direction in the file is towards the root */
    size_t loops;          /* number of loops that were opened by cutting their thinnest line */
    size_t links;          /* number of lines that close a loop and were kept */
    size_t near_ends;      /* number of ends that nearly touch another component */
    double near_mm;        /* the widest gap at such an end, mm */
    ReadCut *cut;          /* the first READ_MAX_CUTS of the lines that were cut; owned */
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
    size_t degree[READ_MAX_DEGREE + 1]; /* degree[k]: number of points where k segments meet; the
                                         * last entry also counts higher degrees */
    size_t without_radius;              /* number of segments with radius 0 */
    size_t given_radius;                /* number of segments that got ReadOptions.radius_mm */
    size_t repaired_radii;              /* number of segments whose radius was repaired */
    int32_t *repaired;                  /* ids of these segments; NULL: there are none; owned */
    double median_radius_mm;            /* median over all segments; 0 if there are none */
    LengthUnit unit;                    /* the unit that was used for coordinates and radii */
    bool unit_is_stated;                /* options or the file state the unit */
    bool voxels;                        /* coordinates were multiplied by the size of a voxel */
    bool has_plausible_unit;   /* there is a unit in which the median radius is plausible for
                                * a vessel */
    LengthUnit plausible_unit; /* that unit: `unit` if it is plausible; set only if
                                * has_plausible_unit */
    bool looks_like_voxels;    /* no unit is stated, and all coordinates of READ_MIN_POINTS or more
                                * points are integers */
    char **note;               /* sentences about assumptions, without full stops; owned */
    size_t n_notes, notes_capacity;
} TreeReading;

/* Frees the report and zeroes it. */
void reading_release(TreeReading *reading);

/* Adds a sentence, without a full stop, about an assumption: "radius is the point array 'Radius'".
 * `reading` may be NULL. Errors: STATUS_MEMORY. */
MUST_CHECK Status reading_note(TreeReading *reading, Err *err, const char *format, ...)
    PRINTF_LIKE(3, 4);

/* Checks a radius of a file. NAN, a missing radius, is accepted. A radius that is infinite or
 * negative becomes NAN if options->repair_radii is set; reading_fill_radii replaces it later.
 * Otherwise it is an error. `options` may be NULL.
 *
 * Errors   STATUS_INPUT; the caller adds the file and the record to the sentence. */
MUST_CHECK Status reading_radius(const ReadOptions *options, double *radius, Err *err);

/* Returns STATUS_INPUT for a bad radius, with a sentence that begins "the WHAT is 'TEXT'". The
 * caller adds the file and the record. */
MUST_CHECK Status reading_refuse_radius(const char *what, const char *text, Err *err);

/* Replaces the missing radii, which are NAN or 0, and counts them in *reading. If
 * options->repair_radii is set, radii are repaired. Then, if options->radius_mm is above 0, radii
 * that are still missing become radius_mm. If neither option is set, the tree does not change.
 *
 * A repaired radius is interpolated along its branch between the nearest known radii. Between an
 * end of the branch and the first known radius, it is that radius. A branch without a known radius
 * gets the radius of its parent or of its thickest daughter, whichever is smaller. If both are
 * unknown, it gets the median radius of the tree.
 *
 * Errors  STATUS_INPUT if there is no radius at all; STATUS_MEMORY.
 * Cost    O(n). */
MUST_CHECK Status reading_fill_radii(TreeReading *reading, const ReadOptions *options, Tree *tree,
                                     Err *err);

/* Returns true if x, y and z are integers, as in coordinates of voxels. */
bool reading_is_voxel(Vec3 position);

/* Completes the report about a tree: records the roots if no reader has recorded them, counts the
 * degrees, and finds the median radius and the plausible unit. Errors: STATUS_MEMORY. Cost:
 * O(n log n). */
MUST_CHECK Status reading_measure(TreeReading *reading, const Tree *tree, Err *err);

#endif
