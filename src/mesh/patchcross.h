/* Finds triangles of one region that cross each other, before the region is part of the mesh. */
#ifndef CORCAST_MESH_PATCHCROSS_H
#define CORCAST_MESH_PATCHCROSS_H

#include "mesh/lattice/patch.h"

typedef enum PatchCrossing {
    PATCHCROSS_NONE,
    PATCHCROSS_OWN,     /* triangles cross, wherever the patch is */
    PATCHCROSS_ROUNDING /* they cross only after their points are rounded to the grid of the mesh */
} PatchCrossing;

/* Finds whether triangles near those with a point of index `first_new` or higher cross each other,
 * after the points are rounded to integer multiples of `grid_mm`. If so, finds whether they also
 * cross before.
 *
 * Errors   STATUS_MEMORY.
 * Cost     O(triangles), and O(n log n) for n triangles near the new ones. */
MUST_CHECK Status patchcross_find(const Patch *patch, size_t first_new, double grid_mm,
                                  PatchCrossing *crossing, Err *err);

#endif
