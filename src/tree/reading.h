/* How a tree's file is to be read, where the user says so, and what was found in it.
 *
 * Most formats say neither their unit nor which way blood flows, and what they hold is often no
 * tree. What is believed, and why, stands in a TreeReading, which `info` prints. */
#ifndef CORCAST_TREE_READING_H
#define CORCAST_TREE_READING_H

#include "base/base.h"
#include "geom/geom.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct Tree Tree;

typedef enum LengthUnit { LENGTH_MM, LENGTH_UM, LENGTH_CM, LENGTH_M, LENGTH_UNITS } LengthUnit;

/* By LengthUnit, "mm"; NULL ends them. */
extern const char *const length_unit_names[LENGTH_UNITS + 1];
/* How many mm the unit has. */
double length_unit_mm(LengthUnit unit);
/* The number of units that, read as such, comes nearest to `mm`: what has been read and is written
 * is the same number again. */
double length_from_mm(double mm, LengthUnit unit);

/* Zeroed: nothing is said. Texts are borrowed. */
typedef struct ReadOptions {
    bool has_unit, has_voxel_size;
    LengthUnit unit;           /* of coordinates and radii; else what is custom in the format */
    Vec3 voxel_size;           /* by which coordinates are multiplied first, each above 0 */
    bool voxel_radii;          /* radii are voxels, too: of the geometric mean of voxel_size */
    double merge_tolerance_mm; /* points this near are one; 0: those at the same place */
    bool break_loops;          /* cut each loop at its thinnest line, or else refuse loops */
    const char *radius_array;  /* the array that holds the radii; NULL: by its name */
    const char *graphml_keys;  /* "x=KEY,y=KEY,...": the keys that GraphML's attributes have */
    const char *columns;       /* "x=NAME,y=NAME,...": the columns of a table */
    const char *edges;         /* path of the table of lines beside one of points */
    const char *format;        /* the format's chief extension, "vtk"; NULL: by name and bytes */
    double radius_mm;          /* of segments whose radius the file does not state or states as 0;
                                * 0: files must state radii */
    bool repair_radii;         /* a radius that is negative or not finite becomes the parent's */
} ReadOptions;

/* What coordinates and radii of a file are multiplied by, to be mm. */
typedef struct LengthScale {
    Vec3 position;
    double radius;
} LengthScale;

/* As the options (may be NULL) say; without them, of a file in `unit`. */
LengthScale length_scale(const ReadOptions *options, LengthUnit unit);
Vec3 length_scaled(const LengthScale *scale, Vec3 position);

/* Why a node is a root. */
typedef enum RootReason {
    ROOT_SAID,      /* the file says so */
    ROOT_DIRECTION, /* lines lead away from it and none to it */
    ROOT_THICKEST,  /* the thickest of the ends */
    ROOT_REASONS
} RootReason;

/* By RootReason, "the file says so". */
extern const char *const root_reason_texts[ROOT_REASONS];

typedef struct ReadRoot {
    int32_t id;
    RootReason reason;
    size_t nodes; /* of its component */
} ReadRoot;

/* A line that was left out where a loop closed. */
typedef struct ReadCut {
    size_t record; /* of the line, in the file */
    Vec3 position; /* of its middle, mm */
    double radius_mm;
} ReadCut;

enum { READ_MAX_DEGREE = 8, READ_MAX_CUTS = 1000, READ_FEW = 20 };

/* The points and lines of a file that need not form a tree, and how a tree was made of them. */
typedef struct NetworkReading {
    size_t points, lines;  /* in the file */
    size_t merged;         /* points at the place of another point */
    size_t unused;         /* points that no line uses */
    size_t without_length; /* lines from a point to itself */
    size_t repeated;       /* lines that repeat another line */
    size_t against;        /* lines that the file directs towards the root */
    size_t loops;          /* lines that close a loop, and were cut */
    size_t near_ends;      /* ends that nearly touch another component */
    double near_mm;        /* the widest of these gaps */
    ReadCut *cut;          /* owned; the first READ_MAX_CUTS of the lines that were cut */
    size_t n_cuts;
} NetworkReading;

/* Zeroed: nothing is known; reading_release. */
typedef struct TreeReading {
    const char *format; /* its name, "VTK"; not owned */
    bool is_network;    /* the format holds points and lines, not a tree; `network` is filled in */
    NetworkReading network;
    /* Of every tree. */
    ReadRoot *root; /* owned; each is one component */
    size_t n_roots, roots_capacity;
    size_t degree[READ_MAX_DEGREE + 1]; /* nodes by segments that meet there; the last: or more */
    size_t without_radius;              /* segments whose radius is 0 */
    size_t given_radius;                /* segments that got ReadOptions.radius_mm */
    size_t repaired_radii;              /* segments that got the radius of their parent */
    double median_radius_mm;            /* of the segments; 0: there are none */
    LengthUnit unit;        /* of coordinates and radii, used for the tree, which is so ... */
    bool unit_said;         /* ... because options or file say it */
    bool voxels;            /* coordinates were multiplied by a voxel's size */
    LengthUnit believed;    /* what the radii look like */
    bool believes;          /* ... if they look like vessels in any unit */
    bool looks_like_voxels; /* all of READ_FEW points or more are whole numbers */
    char **note;            /* owned; sentences about what was assumed */
    size_t n_notes, notes_capacity;
} TreeReading;

void reading_release(TreeReading *reading);

/* Adds a sentence, without a full stop, about what was assumed: "radius is the point array
 * 'Radius'". `reading` may be NULL. */
MUST_CHECK Status reading_note(TreeReading *reading, Err *err, const char *format, ...)
    PRINTF_LIKE(3, 4);

/* Checks a radius that a file states. With options->repair_radii a bad radius becomes NAN, which
 * reading_fill_radii replaces. STATUS_INPUT, without file and record, for a radius that is infinite
 * or negative; NAN is accepted. `options` may be NULL. */
MUST_CHECK Status reading_radius(const ReadOptions *options, double *radius, Err *err);

/* Refuses a radius by its text, and calls it `what`: STATUS_INPUT, without file and record. */
MUST_CHECK Status reading_refuse_radius(const char *what, const char *text, Err *err);

/* Replaces missing radii, which are NAN or 0, as the options say, and counts them in *reading.
 * Other trees stay as they are. STATUS_INPUT when neither a node nor its ancestors have a radius.
 * O(n). */
MUST_CHECK Status reading_fill_radii(TreeReading *reading, const ReadOptions *options, Tree *tree,
                                     Err *err);

/* Whether all coordinates are whole numbers. */
bool reading_is_voxel(Vec3 position);

/* Adds what a tree shows: roots that no one gave a reason for, degrees, median radius, the unit
 * believed. O(nodes log nodes). */
MUST_CHECK Status reading_measure(TreeReading *reading, const Tree *tree, Err *err);

#endif
