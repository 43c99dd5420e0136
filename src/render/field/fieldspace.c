/* Workspaces only grow, so that memory is asked for a few times a picture. */
#include "render/field/fieldspace.h"

#include <stdlib.h>

static bool is_blob(const FieldSpace *space)
{
    return model_has(space->geometry->model, MODEL_BLOB);
}

Status fieldspace_init(const Geometry *geometry, FieldSpace *space, Err *err)
{
    *space = (FieldSpace){.geometry = geometry};
    return geometry->blend.n_groups ? localgroups_new(geometry, &space->groups, err) : STATUS_OK;
}

void fieldspace_release(FieldSpace *space)
{
    free(space->terms);
    free(space->candidates);
    tilework_release(&space->work);
    localgroups_free(space->groups);
    fieldscratch_free(space->scratch);
    blobscratch_free(space->blob_scratch);
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
    FieldScratch *larger = NULL;
    BlobScratch *larger_blob = NULL;
    size_t capacity = n > 2 * space->scratch_capacity ? n : 2 * space->scratch_capacity;
    if (is_blob(space))
        TRY(blobscratch_new(capacity, &larger_blob, err));
    else
        TRY(fieldscratch_new(space->geometry, capacity, &larger, err));
    fieldscratch_free(space->scratch);
    blobscratch_free(space->blob_scratch);
    space->scratch = larger;
    space->blob_scratch = larger_blob;
    space->scratch_capacity = capacity;
    return STATUS_OK;
}

bool fieldspace_first_hit(FieldSpace *space, size_t n, Ray ray, double t_min, double *t,
                          Vec3 *normal, uint32_t *segment)
{
    if (is_blob(space))
        return blobcast_first_hit_among(space->geometry, space->candidates, n, space->blob_scratch,
                                        ray, t_min, HUGE_VAL, t, normal, segment);
    return field_first_hit_among(space->geometry, space->candidates, n, space->scratch, ray, t_min,
                                 HUGE_VAL, t, normal, segment);
}

bool fieldspace_is_shadowed(FieldSpace *space, size_t n, Ray ray)
{
    if (is_blob(space))
        return blobcast_any_hit_among(space->geometry, space->candidates, n, space->blob_scratch,
                                      ray, 0, HUGE_VAL);
    return field_is_shadowed_among(space->geometry, space->candidates, n, space->scratch, ray, 0,
                                   HUGE_VAL);
}
