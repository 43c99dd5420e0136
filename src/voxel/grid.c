/* Chooses the grid of voxels for a scene, and finds the bodies that meet a voxel.
 *
 * Centres of voxels are at multiples of the step for any tree. So the volumes of two trees, or of a
 * tree and a part of it, have voxels at the same positions. */
#include "voxel/grid.h"

#include <stdlib.h>

Status voxelgrid_make(const Geometry *geometry, Vec3 step, VoxelGrid *out, Err *err)
{
    VoxelGrid grid = {.step = step, .origin = geometry->origin};
    double low[3], first[3];
    for (int axis = 0; axis < 3; axis++) {
        double mm = vec3_component(step, axis), origin = vec3_component(geometry->origin, axis);
        low[axis] = floor((vec3_component(geometry->bounds.low, axis) + origin) / mm + 0.5) - 1;
        double n = floor((vec3_component(geometry->bounds.high, axis) + origin) / mm + 0.5) -
                   low[axis] + 2;
        if (!(n < INT32_MAX))
            return err_set(
                err, STATUS_INFEASIBLE,
                "`voxel`: %g mm would make %.3g voxels along an axis; the maximum is 2^31", mm, n);
        grid.n[axis] = (int64_t)n;
        first[axis] = low[axis] * mm - origin;
    }
    grid.first = vec3(first[0], first[1], first[2]);
    *out = grid;
    return STATUS_OK;
}

Status bodies_make(const Geometry *geometry, Bodies *out, Err *err)
{
    Bodies made = {.n = geometry->n_primitives, .ids = geometry->ids};
    Box *boxes = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&made.body, made.n, sizeof *made.body, "vessels", err));
    TRY_GOTO(mem_calloc(&boxes, made.n, sizeof *boxes, "vessels", err));
    for (size_t i = 0; i < made.n; i++) {
        const Primitive *primitive = &geometry->primitives[i];
        made.body[i] =
            body_make(primitive->a, primitive->b, primitive->radius_mm, primitive->segment);
        boxes[i] = body_box(&made.body[i]);
    }
    TRY_GOTO(boxtree_build(boxes, made.n, &made.tree, err));
    *out = made;
    made = (Bodies){0};
done:
    free(boxes);
    bodies_release(&made);
    return status;
}

void bodies_release(Bodies *bodies)
{
    free(bodies->body);
    boxtree_release(&bodies->tree);
    *bodies = (Bodies){0};
}

static int compare_indices(const void *a, const void *b)
{
    uint32_t first = *(const uint32_t *)a, second = *(const uint32_t *)b;
    return (first > second) - (first < second);
}

Status bodies_in(const Bodies *bodies, Box box, BodyList *list, Err *err)
{
    uint32_t item;
    list->n = 0;
    for (BoxWalk walk = boxwalk_box(&bodies->tree, box); boxwalk_next(&walk, &item);)
        TRY(ARRAY_PUSH(list, "vessels", err, item));
    qsort(list->items, list->n, sizeof *list->items, compare_indices);
    return STATUS_OK;
}

uint32_t cell_owner(const Bodies *bodies, const uint32_t *list, size_t n, const VoxelCell *cell)
{
    double most = -1;
    uint32_t owner = 0;
    for (size_t i = 0; i < n; i++) {
        const Body *body = &bodies->body[list[i]];
        double part = n > 1 ? body_fraction(body, cell) : 0;
        if (part > most || (part == most && bodies->ids[body->segment] < bodies->ids[owner])) {
            most = part;
            owner = body->segment;
        }
    }
    return owner;
}
