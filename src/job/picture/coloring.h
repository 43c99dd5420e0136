/* --color-by: a field of the tree as one color a segment. */
#ifndef CORCAST_JOB_PICTURE_COLORING_H
#define CORCAST_JOB_PICTURE_COLORING_H

#include "derive/derive.h"
#include "image/image.h"
#include "job/tree/blood.h"
#include "options/options.h"
#include "scene/scene.h"
#include "stage/stage.h"
#include "tree/tree.h"

/* Whose values a range without ends of its own is of. */
typedef enum RangeOf { RANGE_OF_DRAWN, RANGE_OF_TREE } RangeOf;

typedef struct Coloring {
    const char *field; /* NULL: the look's one color */
    const char *colormap;
    const char *unit; /* of all numbers that follow; NULL: the field's */
    RangeEnds range;
    bool has_range, log;
    int frame; /* of values over time, from 1 on; 0: all */
    RangeOf range_of;
    NumberList classes;     /* one number: how many, 1 for a color for each value; else bounds */
    Vec3 under, over, none; /* sRGB in [0, 1] */
    bool has_under, has_over, has_none;
    BloodOptions blood;
    bool uses_blood, uses_flow; /* options on blood, or on how flow parts, have an effect even
                                 * without a field */
} Coloring;

/* Of a zeroed Coloring. */
void coloring_set_defaults(Coloring *coloring);
extern const OptionTable coloring_table; /* sets a Coloring but its blood */
/* The tables that set the Coloring at `path` of a command's options. */
#define COLORING_TABLES(Type, path)                                                                \
    {&coloring_table, offsetof(Type, path)},                                                       \
    {                                                                                              \
        &blood_table, offsetof(Type, path.blood)                                                   \
    }

/* What of a color the options take, decoded to linear RGB. */
Rgb rgb_of_option(Vec3 srgb);

/* Reads a look by its name in templates/looks or its path. Errors as template_file and look_read.
 */
MUST_CHECK Status coloring_read_look(const char *name, Look *look, Err *err);

/* Where --color-by names a file, reads the values into the tree, and what they are called there
 * into *joined (owned; else unchanged). As tree_read_values. */
MUST_CHECK Status coloring_join(const Coloring *coloring, Tree *tree, char **joined, Err *err);

/* A tree that is colored. */
typedef struct ColoredTree {
    const char *path;   /* for sentences */
    const char *joined; /* from coloring_join, or NULL */
    const Tree *drawn;  /* without what is pruned */
    const Tree *whole;  /* with it, for RANGE_OF_TREE */
} ColoredTree;

/* What a look's vessels are to be colored by, in *appearance (owned; appearance_release): without
 * --color-by the look's one color; else the values of a field of the tree on a scale of the map,
 * with appearance->meaning. The scale goes from the least to the greatest finite value, in all
 * frames, of the segments that can be drawn, unless --range gives its ends. STATUS_USAGE when
 * templates/ lacks the map, there is no such frame, the field has no such unit, the range cannot be
 * logarithmic, or classes do not ascend or are missing for a separate map; else as derive_series;
 * STATUS_INPUT, naming the path, when the field has no value to show, and naming the map's file
 * otherwise. */
MUST_CHECK Status coloring_appearance(const Coloring *coloring, const ColoredTree *tree,
                                      const Look *look, Appearance *appearance, Err *err);

/* Says what the colors mean, and whether --log would show more. Without a scale says nothing. */
void coloring_say(const Appearance *appearance, const Talk *talk);
/* The same for programs; null without a scale. */
json_t *coloring_json(const Appearance *appearance);

#endif
