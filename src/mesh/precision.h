/* The single precision of a mesh: how far a tree is from the origin, and how coarse that makes the
 * coordinates of its mesh. */
#ifndef CORCAST_MESH_PRECISION_H
#define CORCAST_MESH_PRECISION_H

#include "base/base.h"
#include "scene/scene.h"

/* Returns a distance, mm, that no coordinate of the tree's mesh exceeds in magnitude. */
double mesh_max_coordinate(const VesselTree *tree);

/* Returns the grid step of a mesh, mm. All coordinates of the mesh are multiples of this step. The
 * step is the spacing of floats at the largest coordinate, so each multiple is exactly a float. The
 * multiples are integers of less than 26 bits. */
double mesh_grid(double max_coordinate_mm);

/* Returns the multiple of `grid_mm` that is nearest to a coordinate. */
static inline float mesh_rounded(double x_mm, double grid_mm)
{
    return (float)(round(x_mm / grid_mm) * grid_mm);
}

/* The smallest radius for which a mesh is attempted, in grid steps. A mesh of a thinner vessel
 * cannot be valid, and the search for a valid mesh would not end. */
#define PRECISION_MIN_STEPS 16

/* Refuses a tree whose smallest radius is less than PRECISION_MIN_STEPS grid steps.
 *
 * max_coordinate_mm   0, or a coordinate of another object that the mesh is to be joined with.
 * Errors     STATUS_INPUT. */
MUST_CHECK Status precision_check(const VesselTree *tree, double max_coordinate_mm, Err *err);

/* Returns STATUS_INPUT with a sentence that says that the tree is too far from the origin. It names
 * the distance, the step, and the segment with its radius. */
MUST_CHECK Status precision_refuse(const VesselTree *tree, uint32_t segment, double grid_mm,
                                   Err *err);

/* Returns true if the smallest radius is only a few grid steps. Rounding is then the likely reason
 * for triangles that cross. */
bool precision_is_short(const VesselTree *tree);

/* Returns the segment with the smallest radius. The tree has at least one segment. */
uint32_t precision_thinnest_segment(const VesselTree *tree);

#endif
