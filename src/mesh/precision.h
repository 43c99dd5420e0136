/* Computes how coarse the single-precision coordinates of a mesh are, and refuses trees that are
 * too far from the origin for a valid mesh.
 *
 * Points are rounded to a grid before a mesh is checked, so that the checked mesh is equal to the
 * mesh that is written as floats. The grid step grows with the distance from the origin. If the
 * step is not small compared with the thinnest vessel, triangles are folded over each other.
 * Exported by the public header of the module mesh. */
#ifndef CORCAST_MESH_PRECISION_H
#define CORCAST_MESH_PRECISION_H

#include "base/base.h"
#include "scene/scene.h"

/* Returns an upper bound, mm, of the magnitude of all coordinates of the tree's mesh: the largest
 * coordinate of a segment's end plus twice the radius. Returns 0 for a tree without segments. */
double mesh_max_coordinate(const VesselTree *tree);

/* Returns the grid step of a mesh, mm. All coordinates of the mesh are multiples of this step. The
 * step is the spacing of floats at the largest coordinate: each multiple is exactly a float. The
 * factors are integers of at most 2^24 in magnitude.
 *
 * max_coordinate_mm   the largest magnitude of a coordinate, mm. */
double mesh_grid(double max_coordinate_mm);

/* Returns the multiple of `grid_mm` that is nearest to a coordinate, mm. */
static inline float mesh_round_to_grid(double x_mm, double grid_mm)
{
    return (float)(round(x_mm / grid_mm) * grid_mm);
}

/* The smallest radius for which a mesh is attempted, in grid steps. Rounding moves a point by up to
 * 1/32 of this radius, more than the usual tolerance of 0.02, so triangles of a thinner vessel fold
 * over each other. Finer cells do not help, and the search for a valid mesh would not end. */
#define PRECISION_MIN_STEPS 16

/* Refuses a tree whose smallest radius is less than PRECISION_MIN_STEPS grid steps. A tree without
 * segments passes.
 *
 * max_coordinate_mm   0, or the largest coordinate of another mesh on the same grid.
 * Errors              STATUS_INPUT. */
MUST_CHECK Status precision_check(const VesselTree *tree, double max_coordinate_mm, Err *err);

/* Sets the error "the tree reaches ... mm from the origin" and returns STATUS_INPUT. The sentence
 * names the distance, the step `grid_mm`, and the segment with its radius. */
MUST_CHECK Status precision_refuse(const VesselTree *tree, uint32_t segment, double grid_mm,
                                   Err *err);

/* Returns true if rounding is the likely reason why triangles of a finished mesh cross: the
 * smallest radius is less than 2000 grid steps, so that rounding moves a point by more than 2.5e-4
 * radii. The tree must have at least one segment. */
bool precision_explains_crossings(const VesselTree *tree);

/* Returns the index of the segment with the smallest radius. The tree must have at least one. */
uint32_t precision_thinnest_segment(const VesselTree *tree);

#endif
