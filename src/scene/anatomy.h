/* Anatomy: how the vessels of a tree are connected. stage_anatomy [stage/stage.h] builds an
 * Anatomy; the exporters of the module emit write it beside the geometry, so that the reader of a
 * scene file can identify vessels and follow them. Coordinates are in mm, those of the Geometry. */
#ifndef CORCAST_SCENE_ANATOMY_H
#define CORCAST_SCENE_ANATOMY_H

#include "geom/geom.h"
#include <stddef.h>
#include <stdint.h>

/* The connections of a tree. Does not change after stage_anatomy has built it. All arrays are
 * owned. */
typedef struct Anatomy {
    int *order; /* per node: Strahler order of the segment that ends there. 0 at roots, and at all
                 * nodes of a network with loops, which has no Strahler orders */
    uint32_t *component; /* per node: index of its connected component, from 0 */
    Vec3 *root;          /* per component: position of its first root; only networks have several */
    size_t n_trees;      /* number of components, at least 1 */
    Vec3 *main_branch;   /* points of the main branch of component 0, from its root: the branch [the
                          * field `branch`, derive/derive.h] that begins with the thickest segment at
                          * the root. Consecutive points differ */
    size_t n_main_branch; /* number of points of `main_branch`, at least 1 */
} Anatomy;

/* Frees the arrays and zeroes *anatomy. */
void anatomy_release(Anatomy *anatomy);

#endif
