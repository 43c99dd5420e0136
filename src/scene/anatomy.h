/* How vessels hang together, beside their shape: what a file of a scene names, so that who uses the
 * scene can tell its vessels apart and follow them. Coordinates are those of the Geometry. */
#ifndef CORCAST_SCENE_ANATOMY_H
#define CORCAST_SCENE_ANATOMY_H

#include "geom/geom.h"
#include <stddef.h>
#include <stdint.h>

/* Constant once made [stage_anatomy]. */
typedef struct Anatomy {
    int *order;     /* owned; Strahler order of each segment, by its number; 0 at roots */
    uint32_t *tree; /* owned; the tree of each segment, by its number, from 0 on */
    Vec3 *root;     /* owned; of each tree */
    size_t n_trees; /* at least 1 */
    Vec3 *path; /* owned; the main branch of the first tree, from its root on: different points */
    size_t n_path; /* at least 1 */
} Anatomy;

/* Frees the arrays and zeroes *anatomy. */
void anatomy_release(Anatomy *anatomy);

#endif
