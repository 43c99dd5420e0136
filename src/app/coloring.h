/* --color-by: a field of the tree as one colour a segment. */
#ifndef CORCAST_APP_COLORING_H
#define CORCAST_APP_COLORING_H

#include "app/blood.h"
#include "app/options.h"
#include "derive/derive.h"
#include "image/image.h"
#include "scene/scene.h"
#include "stage/stage.h"
#include "tree/tree.h"

typedef struct Coloring {
    const char *field; /* NULL: the look's one colour */
    const char *colormap;
    double range[2];
    bool has_range, log;
    int frame;   /* of values over time, from 1 on; 0: all */
    int classes; /* 1: a colour for each value */
    BloodOptions blood;
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

/* Reads a look by its name in templates/looks or its path. Errors as template_file and look_read.
 */
MUST_CHECK Status coloring_read_look(const char *name, Look *look, Err *err);

/* Whether the option has an effect; those on blood and colours have one with a field alone. */
bool coloring_takes(const Coloring *coloring, const Option *option);
/* STATUS_USAGE when an option of the command line has none. */
MUST_CHECK Status coloring_check_needs(const Coloring *coloring, const Parsed *parsed, Err *err);

/* Where --color-by names a file, reads the values into the tree, and what they are called there
 * into *joined (owned; else unchanged). As tree_read_values. */
MUST_CHECK Status coloring_join(const Coloring *coloring, Tree *tree, char **joined, Err *err);

/* What a look's vessels are to be coloured by, in *appearance (owned; appearance_release): without
 * --color-by the look's one colour; else the values of a field of the tree on a scale of the map,
 * from the least to the greatest finite value of all frames unless --range gives its ends; `joined`
 * is from coloring_join. STATUS_USAGE when templates/ lacks the map, there is no such frame or the
 * range cannot be logarithmic; else as derive_series; STATUS_INPUT,
 * naming `tree_path`, when the field has no value to show, and naming the map's file otherwise. */
MUST_CHECK Status coloring_appearance(const Coloring *coloring, const Tree *tree,
                                      const char *tree_path, const char *joined, const Look *look,
                                      Appearance *appearance, Err *err);

#endif
