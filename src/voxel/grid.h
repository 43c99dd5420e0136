/* Voxels in space, and the bodies that they are filled by; private to the room voxel. */
#ifndef CORCAST_VOXEL_GRID_H
#define CORCAST_VOXEL_GRID_H

#include "scene/scene.h"
#include "voxel/cover.h"
#include "voxel/voxel.h"

/* The bodies that a rounded geometry is the union of, and where they are. */
typedef struct Bodies {
    Body *body; /* owned */
    size_t n;
    BoxTree tree;
    const uint32_t *ids; /* of segments, by number; borrowed from the geometry */
} Bodies;

MUST_CHECK Status bodies_make(const Geometry *geometry, Bodies *out, Err *err);
void bodies_release(Bodies *bodies);

/* A list of bodies that grows. */
typedef struct BodyList {
    uint32_t *item; /* owned */
    size_t n, capacity;
} BodyList;

/* The bodies whose boxes meet the box, by rising number. */
MUST_CHECK Status bodies_in(const Bodies *bodies, Box box, BodyList *list, Err *err);

static inline Cell grid_cell(const VoxelGrid *grid, int64_t x, int64_t y, int64_t z)
{
    return (Cell){.center = vec3(grid->first.x + (double)x * grid->step.x,
                                 grid->first.y + (double)y * grid->step.y,
                                 grid->first.z + (double)z * grid->step.z),
                  .half = vec3_scale(grid->step, 0.5)};
}

static inline Box cell_box(const Cell *cell)
{
    return (Box){vec3_sub(cell->center, cell->half), vec3_add(cell->center, cell->half)};
}

/* The voxel that a coordinate is in, along an axis. */
static inline int64_t grid_index(const VoxelGrid *grid, int axis, double x)
{
    double first = vec3_component(grid->first, axis);
    return (int64_t)floor((x - first) / vec3_component(grid->step, axis) + 0.5);
}

/* Returns the segment whose body, of the n > 0 in the list, fills the most of the cell; of equals
 * the one with the lowest id. */
uint32_t cell_owner(const Bodies *bodies, const uint32_t *list, size_t n, const Cell *cell);

#endif
