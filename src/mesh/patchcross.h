/* Finds triangles of one junction region that cross each other, before the region is copied to the
 * mesh. Only the neighbourhood of the triangles that were split last is searched, because only
 * splits create crossings. Private to the module mesh. */
#ifndef CORCAST_MESH_PATCHCROSS_H
#define CORCAST_MESH_PATCHCROSS_H

#include "mesh/lattice/patch.h"

/* The result of patchcross_find. */
typedef enum PatchCrossing {
    PATCHCROSS_NONE,
    PATCHCROSS_REAL,    /* triangles cross even without rounding; a finer lattice of the region may
                         * help */
    PATCHCROSS_ROUNDING /* triangles cross only after their points are rounded to the grid of the
                         * mesh; a finer lattice makes it worse */
} PatchCrossing;

/* Tests the triangles near the new points for crossings.
 *
 * patch      stays unchanged; the function rounds copies of its points.
 * first_new  points with this index or a higher one are new.
 * grid_mm    points are rounded to integer multiples of it. If triangles cross after rounding, the
 *            test is repeated on a finer grid, with coordinates relative to the region, which are
 *            small enough for it. If they still cross, the crossing is real.
 * crossing   receives the result.
 * Errors     STATUS_MEMORY.
 * Cost       O(triangles), and O(n log n) for n triangles near the new points. */
MUST_CHECK Status patchcross_find(const Patch *patch, size_t first_new, double grid_mm,
                                  PatchCrossing *crossing, Err *err);

#endif
