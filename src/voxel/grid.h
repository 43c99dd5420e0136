/* The voxels of a grid, and the bodies that fill them. Private to the module voxel. */
#ifndef CORCAST_VOXEL_GRID_H
#define CORCAST_VOXEL_GRID_H

#include "scene/scene.h"
#include "voxel/cover.h"
#include "voxel/voxel.h"

/* The cylinders and balls whose union a geometry is, and a tree of their boxes. */
typedef struct Bodies {
    Body *body; /* owned */
    size_t n;
    BoxTree tree;
    const uint32_t *ids; /* per segment index: SWC id; borrowed from the geometry */
} Bodies;

/* Makes the bodies of a geometry. Release *out with bodies_release. Errors: STATUS_MEMORY. */
MUST_CHECK Status bodies_make(const Geometry *geometry, Bodies *out, Err *err);
void bodies_release(Bodies *bodies);

/* Indices of bodies. */
typedef ARRAY(uint32_t) BodyList;

/* Lists the bodies whose boxes meet `box`, by rising index. Replaces what *list held; the caller
 * releases it with ARRAY_RELEASE, also after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status bodies_in(const Bodies *bodies, Box box, BodyList *list, Err *err);

/* Returns the box of a voxel. */
static inline VoxelCell grid_cell(const VoxelGrid *grid, int64_t x, int64_t y, int64_t z)
{
    return (VoxelCell){.center = vec3(grid->first.x + (double)x * grid->step.x,
                                      grid->first.y + (double)y * grid->step.y,
                                      grid->first.z + (double)z * grid->step.z),
                       .half = vec3_scale(grid->step, 0.5)};
}

static inline Box cell_box(const VoxelCell *cell)
{
    return (Box){vec3_sub(cell->center, cell->half), vec3_add(cell->center, cell->half)};
}

/* Returns the index of the voxel that holds a coordinate, along an axis. May lie outside the grid.
 */
static inline int64_t grid_index(const VoxelGrid *grid, int axis, double x)
{
    double first = vec3_component(grid->first, axis);
    return (int64_t)floor((x - first) / vec3_component(grid->step, axis) + 0.5);
}

/* Returns the segment index of the body that fills most of the cell, among the n > 0 bodies of
 * `list`. On a tie, returns the segment with the lowest SWC id. */
uint32_t cell_owner(const Bodies *bodies, const uint32_t *list, size_t n, const VoxelCell *cell);

#endif
