/* The workspace of one thread for the terms of a tile, and for rays in double precision among them.
 * Workspaces only grow, so that memory is allocated only a few times per image. */
#include "render/field/fieldspace.h"

#include <stdlib.h>

Status fieldspace_init(const Geometry *geometry, FieldSpace *space, Err *err)
{
    *space = (FieldSpace){.geometry = geometry, .search = raysearch_for(geometry, false)};
    return geometry->blend.n_groups ? localgroups_new(geometry, &space->groups, err) : STATUS_OK;
}

void fieldspace_release(FieldSpace *space)
{
    ARRAY_RELEASE(&space->terms);
    ARRAY_RELEASE(&space->candidates);
    free(space->work);
    localgroups_free(space->groups);
    if (space->search)
        space->search->workspace_free(space->scratch);
    *space = (FieldSpace){0};
}

/* Returns the larger of n and twice the capacity, so that workspaces seldom grow. */
static size_t grown(size_t capacity, size_t n)
{
    return n > 2 * capacity ? n : 2 * capacity;
}

Status fieldspace_reserve(FieldSpace *space, size_t n, Err *err)
{
    TRY(ARRAY_RESERVE(&space->terms, n, "terms", err));
    TRY(ARRAY_RESERVE(&space->candidates, n, "terms", err));
    if (n <= space->work_capacity)
        return STATUS_OK;
    const size_t capacity = grown(space->work_capacity, n);
    void *work = capacity <= SIZE_MAX / TILE_WORK_BYTES
                     ? aligned_alloc(64, capacity * TILE_WORK_BYTES)
                     : NULL;
    if (!work)
        return err_set(err, STATUS_MEMORY, "no memory for %zu terms of the potential", capacity);
    free(space->work);
    space->work = work;
    space->work_capacity = capacity;
    return STATUS_OK;
}

Status fieldspace_reserve_rays(FieldSpace *space, size_t n, Err *err)
{
    if (n <= space->scratch_capacity)
        return STATUS_OK;
    void *larger;
    const size_t capacity = grown(space->scratch_capacity, n);
    TRY(space->search->workspace_new(space->geometry, capacity, &larger, err));
    space->search->workspace_free(space->scratch);
    space->scratch = larger;
    space->scratch_capacity = capacity;
    return STATUS_OK;
}

bool fieldspace_first_hit(FieldSpace *space, size_t n, Ray ray, double t_min, RayHit *hit)
{
    const RayIndex index = {.geometry = space->geometry, .list = space->candidates.items, .n = n};
    const RayPart part = {ray, t_min, HUGE_VAL};
    return space->search->first(&index, space->scratch, &part, hit);
}

bool fieldspace_is_shadowed(FieldSpace *space, size_t n, Ray ray)
{
    const RayIndex index = {.geometry = space->geometry, .list = space->candidates.items, .n = n};
    const RayPart part = {ray, 0, HUGE_VAL};
    return space->search->any(&index, space->scratch, &part);
}
