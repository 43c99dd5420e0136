/* The single precision of a mesh: how far a tree is from the origin, and how coarse that makes the
 * coordinates of its mesh. */
#ifndef CORCAST_MESH_PRECISION_H
#define CORCAST_MESH_PRECISION_H

#include "base/base.h"
#include "scene/scene.h"

/* Returns a distance, mm, that no coordinate of the tree's mesh exceeds in magnitude. */
double mesh_reach(const VesselTree *tree);

/* Returns the step of the grid that the points of a mesh are on, mm: the spacing of floats at the
 * largest coordinate, so that each coordinate is a float, and an integer of less than 26 bits times
 * the step. */
double mesh_grid(double reach_mm);

/* Returns the multiple of `grid_mm` that is nearest to a coordinate. */
static inline float mesh_rounded(double x_mm, double grid_mm)
{
    return (float)(round(x_mm / grid_mm) * grid_mm);
}

/* In units of the grid's step: the smallest radius for which a mesh is attempted. No mesh of a
 * thinner vessel could be valid, and the search for one would not end. */
#define REACH_LEAST_STEPS 16

/* Refuses a tree whose thinnest vessel is thinner than REACH_LEAST_STEPS.
 *
 * reach_mm   0, or a coordinate of another object that the mesh is to be joined with.
 * Errors     STATUS_INPUT. */
MUST_CHECK Status reach_check(const VesselTree *tree, double reach_mm, Err *err);

/* Returns STATUS_INPUT with a sentence that says that the tree is too far from the origin. It names
 * the distance, the step, and the segment with its radius. */
MUST_CHECK Status reach_refuse(const VesselTree *tree, uint32_t segment, double grid_mm, Err *err);

/* Returns true if rounding is the likely reason for triangles that cross: the thinnest radius is
 * only a few steps of the grid. Trees nearer to the origin have valid meshes; such trees often have
 * not. */
bool precision_is_short(const VesselTree *tree);

/* Returns the segment with the smallest radius. The tree has at least one segment. */
uint32_t reach_thinnest(const VesselTree *tree);

#endif
