/* How the vessels of a tree are connected. Emitters write it beside the geometry, so that the user
 * of a scene file can identify vessels and follow them. Coordinates are those of the Geometry. */
#ifndef CORCAST_SCENE_ANATOMY_H
#define CORCAST_SCENE_ANATOMY_H

#include "geom/geom.h"
#include <stddef.h>
#include <stdint.h>

/* Immutable once made [stage_anatomy]. All arrays are owned. */
typedef struct Anatomy {
    int *order;     /* per node: Strahler order of the segment that ends there; 0 at roots, and in a
                     * network with loops, which has no orders */
    uint32_t *tree; /* per node: index of its tree or connected network, from 0 */
    Vec3 *root;     /* per tree: position of its first root */
    size_t n_trees; /* at least 1 */
    Vec3 *path;     /* the main branch of the first tree, from its root; no point occurs twice */
    size_t n_path;  /* at least 1 */
} Anatomy;

/* Frees the arrays and zeroes *anatomy. */
void anatomy_release(Anatomy *anatomy);

#endif
