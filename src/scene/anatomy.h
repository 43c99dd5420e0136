/* Anatomy: how the vessels of a tree are connected. stage_anatomy [stage/stage.h] builds an
 * Anatomy; emitters write it beside the geometry, so that the reader of a scene file can identify
 * vessels and follow them. Coordinates are in mm, those of the Geometry. */
#ifndef CORCAST_SCENE_ANATOMY_H
#define CORCAST_SCENE_ANATOMY_H

#include "geom/geom.h"
#include <stddef.h>
#include <stdint.h>

/* The connections of a tree. Does not change after stage_anatomy has built it. All arrays are
 * owned. */
typedef struct Anatomy {
    int *order;     /* per segment index: Strahler order of the segment. 0 at roots,
                     * and at all nodes of a network with loops, which has no Strahler orders */
    uint32_t *tree; /* per node: index of its connected component, from 0 */
    Vec3 *root;     /* per connected component: position of its first root */
    size_t n_trees; /* number of connected components, at least 1 */
    Vec3 *path;     /* points of the main branch of component 0, from its root; no point occurs
                     * twice */
    size_t n_path;  /* number of points of `path`, at least 1 */
} Anatomy;

/* Frees the arrays and zeroes *anatomy. */
void anatomy_release(Anatomy *anatomy);

#endif
