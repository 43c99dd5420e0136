/* The bodies of a geometry in a bounding volume hierarchy, and conversions between voxels and
 * coordinates.
 *
 * bodies_make builds the bodies; bodies_in lists those near a box. grid_cell returns the cell of
 * the voxel with three indices; grid_index returns the index along an axis of the voxel that
 * contains a coordinate. VoxelGrid.first is the centre of the voxel with the indices 0. Private to
 * the module voxel. */
#ifndef CORCAST_VOXEL_GRID_H
#define CORCAST_VOXEL_GRID_H

#include "scene/scene.h"
#include "voxel/cover.h"
#include "voxel/voxel.h"

/* The bodies (cylinders and balls) whose union is the geometry, and a bounding volume hierarchy
 * over their boxes. */
typedef struct Bodies {
    Body *body; /* owned */
    size_t n;
    BoxTree tree;        /* hierarchy of the boxes of the bodies */
    const uint32_t *ids; /* per segment index: its SWC id; borrowed from the geometry */
} Bodies;

/* Makes the bodies of a geometry, which must outlive them. Release *out with bodies_release.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status bodies_make(const Geometry *geometry, Bodies *out, Err *err);
void bodies_release(Bodies *bodies);

/* Indices of bodies. Release it with ARRAY_RELEASE. */
typedef ARRAY(uint32_t) BodyList;

/* Lists the bodies whose boxes meet `box`, by ascending index. Replaces the content of *list, which
 * the caller releases with ARRAY_RELEASE, also after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status bodies_in(const Bodies *bodies, Box box, BodyList *list, Err *err);

/* Returns the cell (centre and half sides, mm) of the voxel with these indices, which may be
 * outside the grid. */
static inline VoxelCell grid_cell(const VoxelGrid *grid, int64_t x, int64_t y, int64_t z)
{
    return (VoxelCell){.center = vec3(grid->first.x + (double)x * grid->step.x,
                                      grid->first.y + (double)y * grid->step.y,
                                      grid->first.z + (double)z * grid->step.z),
                       .half = vec3_scale(grid->step, 0.5)};
}

/* Returns a cell as a box. */
static inline Box cell_box(const VoxelCell *cell)
{
    return (Box){vec3_sub(cell->center, cell->half), vec3_add(cell->center, cell->half)};
}

/* Returns the index along an axis of the voxel that contains the coordinate x, mm. The index may be
 * outside the grid. */
static inline int64_t grid_index(const VoxelGrid *grid, int axis, double x)
{
    double first = vec3_component(grid->first, axis);
    return (int64_t)floor((x - first) / vec3_component(grid->step, axis) + 0.5);
}

/* Returns the index of the segment whose body fills most of the cell, among the n > 0 bodies of
 * `list`. On a tie, returns the segment with the lowest SWC id. */
uint32_t cell_owner(const Bodies *bodies, const uint32_t *list, size_t n, const VoxelCell *cell);

#endif
