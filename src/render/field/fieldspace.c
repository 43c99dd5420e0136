/* Workspaces only grow, so that memory is allocated only a few times per image. */
#include "render/field/fieldspace.h"

#include <stdlib.h>

Status fieldspace_init(const Geometry *geometry, FieldSpace *space, Err *err)
{
    *space = (FieldSpace){.geometry = geometry, .search = raysearch_for(geometry, false)};
    return geometry->blend.n_groups ? localgroups_new(geometry, &space->groups, err) : STATUS_OK;
}

void fieldspace_release(FieldSpace *space)
{
    free(space->terms);
    free(space->candidates);
    tilework_release(&space->work);
    localgroups_free(space->groups);
    if (space->search)
        space->search->workspace_free(space->scratch);
    *space = (FieldSpace){0};
}

Status fieldspace_reserve(FieldSpace *space, size_t n, Err *err)
{
    TRY(mem_reserve(&space->terms, &space->terms_capacity, n, sizeof *space->terms, "terms", err));
    TRY(mem_reserve(&space->candidates, &space->candidates_capacity, n, sizeof *space->candidates,
                    "terms", err));
    return tilework_reserve(&space->work, n, err);
}

Status fieldspace_reserve_rays(FieldSpace *space, size_t n, Err *err)
{
    if (n <= space->scratch_capacity)
        return STATUS_OK;
    void *larger;
    size_t capacity = n > 2 * space->scratch_capacity ? n : 2 * space->scratch_capacity;
    TRY(space->search->workspace_new(space->geometry, capacity, &larger, err));
    space->search->workspace_free(space->scratch);
    space->scratch = larger;
    space->scratch_capacity = capacity;
    return STATUS_OK;
}

bool fieldspace_first_hit(FieldSpace *space, size_t n, Ray ray, double t_min, RayHit *hit)
{
    const RayIndex index = {.geometry = space->geometry, .list = space->candidates, .n = n};
    const RayPart part = {ray, t_min, HUGE_VAL};
    return space->search->first(&index, space->scratch, &part, hit);
}

bool fieldspace_is_shadowed(FieldSpace *space, size_t n, Ray ray)
{
    const RayIndex index = {.geometry = space->geometry, .list = space->candidates, .n = n};
    const RayPart part = {ray, 0, HUGE_VAL};
    return space->search->any(&index, space->scratch, &part);
}
