/* How far from the origin a tree lies, and what that leaves of the precision of its mesh. */
#ifndef CORCAST_MESH_PRECISION_H
#define CORCAST_MESH_PRECISION_H

#include "base/base.h"
#include "scene/scene.h"

/* Returns a distance, mm, that no coordinate of the tree's mesh exceeds. */
double mesh_reach(const VesselTree *tree);

/* Returns the step of the grid that the points of a mesh lie on: the spacing of floats at the
 * coordinate farthest from 0, so that each coordinate is an integer of less than 26 bits of it, and
 * a float. */
double mesh_grid(double reach_mm);

/* Refuses a tree whose thinnest vessel has a radius of less than REACH_LEAST_STEPS steps of the
 * grid: no mesh of it could be sound, and the search for one would have no end.
 *
 * reach_mm   0, or a coordinate farther from 0 of what the mesh is to be joined with.
 * Errors     STATUS_INPUT. */
#define REACH_LEAST_STEPS 16
MUST_CHECK Status reach_check(const VesselTree *tree, double reach_mm, Err *err);

/* Returns STATUS_INPUT: the segment's place is what makes its mesh unsound. The sentence names the
 * distance, the step and the radius. */
MUST_CHECK Status reach_refuse(const VesselTree *tree, uint32_t segment, double grid_mm, Err *err);

/* Whether roundings are what makes triangles cross: where trees near the origin are sound, those
 * whose thinnest radius is fewer steps of the grid than this are often not. */
bool precision_is_short(const VesselTree *tree);

/* Returns the segment of the smallest radius; the tree must have one. */
uint32_t reach_thinnest(const VesselTree *tree);

#endif
