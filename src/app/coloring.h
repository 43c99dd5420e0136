/* --color-by: a field of the tree as one colour a segment. */
#ifndef CORCAST_APP_COLORING_H
#define CORCAST_APP_COLORING_H

#include "app/options.h"
#include "derive/derive.h"
#include "image/image.h"
#include "scene/scene.h"
#include "tree/tree.h"

typedef struct Coloring {
    const char *field; /* NULL: the look's one colour */
    const char *colormap;
    double range[2];
    bool has_range, log;
    TreeMeta flow; /* what the user says of the tree */
} Coloring;

/* Of a zeroed Coloring. */
void coloring_set_defaults(Coloring *coloring);
extern const OptionTable coloring_table; /* sets a Coloring */

/* The colour map of --colormap in *map (owned). STATUS_USAGE when templates/ lacks the name. */
MUST_CHECK Status coloring_read_map(const Coloring *coloring, Colormap *map, Err *err);

/* One linear colour of the map a node in *colors (owned), NULL when no field is asked for. Without
 * --range, the colours run from the least to the greatest finite value of the field. */
MUST_CHECK Status coloring_apply(const Coloring *coloring, const Colormap *map, const Tree *tree,
                                 Rgb **colors, Err *err);

#endif
