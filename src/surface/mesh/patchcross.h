/* Crossings of a patch that is not in the mesh yet. */
#ifndef CORCAST_SURFACE_PATCHCROSS_H
#define CORCAST_SURFACE_PATCHCROSS_H

#include "surface/mesh/patch.h"

/* Whether triangles near those that have a point from `first_new` on cross each other, once the
 * points are rounded to whole multiples of `grid_mm`. O(triangles), and n log n in those near. */
MUST_CHECK Status patchcross_find(const Patch *patch, size_t first_new, double grid_mm,
                                  bool *crossing, Err *err);

#endif
