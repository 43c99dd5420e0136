/* Colors each segment by the value of a field of the tree (--color-by).
 *
 * A Coloring stores the options. If --color-by names a file, coloring_join adds the file's values
 * to the tree. coloring_appearance then maps the values of the field to colors. Without --color-by,
 * all vessels have the single color of the Look.
 *
 *     TRY(coloring_read_look(name, &look, err));
 *     TRY(coloring_join(&coloring, &tree, &joined, err));
 *     TRY(coloring_appearance(&coloring, &colored_tree, &look, &appearance, err)); */
#ifndef CORCAST_JOB_PICTURE_COLORING_H
#define CORCAST_JOB_PICTURE_COLORING_H

#include "derive/derive.h"
#include "image/image.h"
#include "job/tree/blood.h"
#include "options/options.h"
#include "scene/scene.h"
#include "stage/stage.h"
#include "tree/tree.h"

/* The segments whose values determine the range of the scale, if --range does not specify both
 * ends: the drawn segments, or all segments of the tree. */
typedef enum RangeOf { RANGE_OF_DRAWN, RANGE_OF_TREE } RangeOf;

typedef struct Coloring {
    const char *field; /* value of --color-by: name of a field, or "FILE" or "FILE:COLUMN"; NULL:
                        * the single color of the look */
    const char *colormap;
    const char *unit; /* unit of `range` and `classes`; NULL: the field's unit */
    RangeEnds range;
    bool has_range, log;
    int frame; /* time step of values that change with time, counted from 1; 0: all time steps */
    RangeOf range_of;
    NumberList classes; /* one number n > 1: n classes of equal width; 1: each different value is a
                         * class; several numbers: the bounds of the classes; empty: no classes */
    /* colors of values below the range, above it, and of missing values (NaN); sRGB in [0, 1] */
    Vec3 under, over, none;
    bool has_under, has_over, has_none;
    BloodOptions blood;
    bool uses_blood, uses_flow; /* set by the command: its output contains blood (flow) values, so
                                 * options about blood (flow) have an effect even without `field` */
} Coloring;

/* Sets the defaults of a zeroed Coloring. */
void coloring_set_defaults(Coloring *coloring);
extern const OptionTable coloring_table; /* sets a Coloring, except Coloring.blood */
/* The option tables that set a Coloring, including its `blood`. The Coloring is the member `path`
 * of the command's options struct `Type`. */
#define COLORING_TABLES(Type, path)                                                                \
    {&coloring_table, offsetof(Type, path)},                                                       \
    {                                                                                              \
        &blood_table, offsetof(Type, path.blood)                                                   \
    }

/* Converts a color from an option, sRGB in [0, 1], to linear RGB. */
Rgb rgb_of_option(Vec3 srgb);

/* Reads a look, by its name in templates/looks or by its path. Errors: STATUS_USAGE if there is no
 * such look; STATUS_INPUT, with file and line, if the file is malformed; STATUS_IO; STATUS_MEMORY.
 */
MUST_CHECK Status coloring_read_look(const char *name, Look *look, Err *err);

/* If --color-by names a file, reads the file and adds its values to the tree as a column.
 *
 * joined  receives the name of the column; release it with free. Unchanged if --color-by names no
 *         file.
 * Errors  STATUS_INPUT if the file is malformed or has no such column; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status coloring_join(const Coloring *coloring, Tree *tree, char **joined, Err *err);

/* A tree that is colored. All pointers are borrowed. */
typedef struct ColoredTree {
    const char *path;   /* the tree's file, named in errors */
    const char *joined; /* name of the column from coloring_join; NULL: --color-by names no file */
    const Tree *drawn;  /* the tree without its pruned segments */
    const SmoothTree *pieces; /* the pieces of `drawn`, which are drawn instead of its segments;
                               * NULL: the segments are drawn */
    const Tree *whole;        /* the tree with the pruned segments, for RANGE_OF_TREE */
} ColoredTree;

/* Sets the colors of the segments, or of the pieces of a smooth tree. A piece has the value at its
 * position along the segment [derive_pieces]. The range of the scale is computed from the values of
 * the segments, not of the pieces.
 *
 * Without --color-by, the vessels have the single color of the look. With --color-by, the color map
 * is applied to the values of the field, and appearance->meaning describes the scale. The scale
 * goes from the smallest to the largest finite value, in all time steps, of the segments that
 * coloring->range_of selects and that have a radius and a length. --range replaces the ends of the
 * scale.
 *
 * appearance  set on success; release it with appearance_release.
 * Errors      STATUS_USAGE in these cases: templates/ does not contain the color map; the time step
 *             does not exist; the field cannot be converted to the unit; the range cannot be
 *             logarithmic; bounds of classes do not ascend; the map is a list of separate colors,
 *             and --classes is missing. STATUS_INPUT, with the tree's path, if the field has no
 *             value to show; with the map's path, if the map is malformed. The errors of
 *             derive_series. STATUS_MEMORY. */
MUST_CHECK Status coloring_appearance(const Coloring *coloring, const ColoredTree *tree,
                                      const Look *look, Appearance *appearance, Err *err);

/* Colors the segments or the pieces by the logarithm of the radius, from the look's color `tips` at
 * the 2nd percentile of the radii to the look's `color` at the largest radius. With the percentile,
 * a few stray thin vessels do not stretch the scale. All vessels have the look's `color` if no
 * segment has a radius, or if more than 255 segments begin at one node, because POV-Ray cannot
 * color them. appearance->meaning is NULL: there is no scale for a legend.
 *
 * appearance  set on success; release it with appearance_release.
 * Errors      STATUS_MEMORY. */
MUST_CHECK Status coloring_by_radius(const ColoredTree *tree, const Look *look,
                                     Appearance *appearance, Err *err);

/* Sends notes with the meaning of the colors. Recommends --log if the field spans more than three
 * decades, because a linear scale hardly distinguishes the lowest values. Does nothing if
 * appearance->meaning is NULL. */
void coloring_report(const Appearance *appearance, const Talk *talk);
/* Returns the meaning of the colors as JSON, for --json: a new reference; JSON null without a
 * scale; NULL if memory runs out. */
json_t *coloring_json(const Appearance *appearance);

#endif
