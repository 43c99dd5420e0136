/* --color-by: colors each segment by the value of a field of the tree.
 *
 * A Coloring stores the options. coloring_join reads values from a file into the tree, if
 * --color-by names a file. coloring_appearance then maps the field's values to colors. The Look
 * supplies the single color of the vessels without --color-by.
 *
 * Use, for a parsed Coloring:
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

/* The segments whose values set the range of the scale, if --range does not specify its ends. */
typedef enum RangeOf { RANGE_OF_DRAWN, RANGE_OF_TREE } RangeOf;

typedef struct Coloring {
    const char *field; /* NULL: the look's single color */
    const char *colormap;
    const char *unit; /* unit of all numbers below; NULL: the field's unit */
    RangeEnds range;
    bool has_range, log;
    int frame; /* frame of values that change with time, counted from 1; 0: all frames */
    RangeOf range_of;
    NumberList classes; /* one number: the count of classes, where 1 gives each value its own color;
                         * more numbers: the bounds of the classes */
    Vec3 under, over, none; /* sRGB in [0, 1] */
    bool has_under, has_over, has_none;
    BloodOptions blood;
    bool uses_blood, uses_flow; /* options on blood, or on how flow divides, have an effect even
                                 * without a field */
} Coloring;

/* Sets the defaults of a zeroed Coloring. */
void coloring_set_defaults(Coloring *coloring);
extern const OptionTable coloring_table; /* sets a Coloring, except Coloring.blood */
/* The option tables that set a Coloring, including its blood. `path` is the Coloring's member in
 * `Type`, the options of a command. */
#define COLORING_TABLES(Type, path)                                                                \
    {&coloring_table, offsetof(Type, path)},                                                       \
    {                                                                                              \
        &blood_table, offsetof(Type, path.blood)                                                   \
    }

/* Converts a color from an option, sRGB in [0, 1], to linear RGB. */
Rgb rgb_of_option(Vec3 srgb);

/* Reads a look, by its name in templates/looks or by its path. Errors: as template_file and
 * look_read. */
MUST_CHECK Status coloring_read_look(const char *name, Look *look, Err *err);

/* Reads the file that --color-by names, if it names one, and adds the values to the tree.
 *
 * joined  receives the name of the values in the tree; release it with free. Unchanged if
 *         --color-by names no file.
 * Errors  as tree_read_values. */
MUST_CHECK Status coloring_join(const Coloring *coloring, Tree *tree, char **joined, Err *err);

/* A tree that is colored. All pointers are borrowed. */
typedef struct ColoredTree {
    const char *path;   /* the tree's file, named in errors */
    const char *joined; /* from coloring_join, or NULL */
    const Tree *drawn;  /* the tree without its pruned segments */
    const Tree *whole;  /* the tree with the pruned segments, for RANGE_OF_TREE */
} ColoredTree;

/* Sets the colors of the vessels.
 *
 * Without --color-by, the vessels have the look's single color. With --color-by, the color map is
 * applied to the values of the field, and appearance->meaning describes the scale. The scale goes
 * from the smallest to the largest finite value, in all frames, of the segments that can be drawn.
 * --range replaces the ends of the scale.
 *
 * appearance  set on success; release it with appearance_release.
 * Errors      STATUS_USAGE if templates/ does not contain the map, if the frame does not exist, if
 *             the field does not have the unit, if the range cannot be logarithmic, if classes do
 *             not ascend, or if classes are missing for a map of separate colors. STATUS_INPUT,
 *             naming the tree's path, if the field has no value to show. STATUS_INPUT, naming the
 *             map's file, if the map is bad. Other errors: as derive_series. */
MUST_CHECK Status coloring_appearance(const Coloring *coloring, const ColoredTree *tree,
                                      const Look *look, Appearance *appearance, Err *err);

/* Colors the vessels by the logarithm of the radius: the thickest have the look's `color`, the
 * thinnest 2 % the look's `tips`. If no segment has a radius, or if more segments meet at a node
 * than POV-Ray can color, all vessels have the look's `color`. The appearance has no meaning that a
 * legend would show.
 *
 * appearance  set on success; release it with appearance_release.
 * Errors      STATUS_MEMORY. */
MUST_CHECK Status coloring_by_radius(const ColoredTree *tree, const Look *look,
                                     Appearance *appearance, Err *err);

/* Reports, as notes, what the colors mean. Recommends --log if the field spans more than three
 * decades: a linear scale hardly shows the lowest values. Reports nothing if appearance->meaning is
 * NULL. */
void coloring_report(const Appearance *appearance, const Talk *talk);
/* Returns what the colors mean as JSON, for --json; JSON null without a scale. New reference. */
json_t *coloring_json(const Appearance *appearance);

#endif
