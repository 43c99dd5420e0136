/* Crossings of a patch that is not in the mesh yet. */
#ifndef CORCAST_MESH_PATCHCROSS_H
#define CORCAST_MESH_PATCHCROSS_H

#include "mesh/lattice/patch.h"

typedef enum PatchCrossing {
    PATCHCROSS_NONE,
    PATCHCROSS_OWN,     /* triangles cross wherever the patch lies */
    PATCHCROSS_ROUNDING /* they cross only once their points are rounded to the grid of the mesh */
} PatchCrossing;

/* Finds whether triangles near those that have a point from `first_new` on cross each other, once
 * the points are rounded to whole multiples of `grid_mm`, and if so, whether they also cross
 * before.
 *
 * Errors   STATUS_MEMORY.
 * Cost     O(triangles), and n log n in those near. */
MUST_CHECK Status patchcross_find(const Patch *patch, size_t first_new, double grid_mm,
                                  PatchCrossing *crossing, Err *err);

#endif
