/* One of five searches, by what the geometry is: primitives and triangles by bounding volume
 * hierarchies, a blob piece by piece, an isosurface by proof, or as POV-Ray's own root finder finds
 * it. What all have
 * in common is here: POV-Ray's limits of what is too near to be seen or to cast a shadow, and
 * normals that face the viewer. Searches that need room while they run have a workspace for each
 * thread. */
#include "render/cast/caster.h"

#include "render/cast/blobcast.h"
#include "render/cast/bvh.h"
#include "render/cast/fieldcast.h"
#include "render/cast/meshcast.h"
#include "render/cast/povray_isosurface.h"
#include <stdlib.h>

/* POV-Ray's limit [docs/POVRAY.md section 3]: blockers within it of the lit point or of the light
 * cast no shadow. */
static const double shadow_slack_mm = 1e-3;
struct Caster {
    const Geometry *geometry;
    Bvh *bvh;                     /* of primitives, or NULL */
    const Primitive *primitives;  /* those */
    Primitive *with_ends;         /* owned; they, where the geometry implies some */
    MeshCast *mesh;               /* or NULL */
    PovrayIsosurface *isosurface; /* an implicit model as POV-Ray finds it, or NULL */
    FieldIndex *field;            /* an implicit model by proof, or NULL */
    FieldScratch **scratch;       /* one a worker */
    BlobCast *blob;               /* or NULL */
    BlobScratch **blob_scratch;
    int workers;
    double shadow_from_mm;
};

static Status build_bvh(Caster *caster, Err *err)
{
    const Geometry *geometry = caster->geometry;
    size_t n = geometry->n_primitives;
    caster->primitives = geometry->primitives;
    if (geometry->implied_ends) {
        TRY(geometry_with_ends(geometry, &caster->with_ends, &n, err));
        caster->primitives = caster->with_ends;
    }
    return bvh_build(caster->primitives, n, &caster->bvh, err);
}

Status caster_new(const Geometry *geometry, const CellParams *cells, int workers, Caster **out,
                  Err *err)
{
    Caster *caster = NULL;
    TRY(mem_calloc(&caster, 1, sizeof *caster, "casters", err));
    caster->geometry = geometry;
    caster->workers = workers;
    caster->shadow_from_mm = shadow_slack_mm;
    Status status = STATUS_OK;
    if (model_has(geometry->model, MODEL_BLOB)) {
        TRY_GOTO(blobcast_new(geometry, &caster->blob, err));
        TRY_GOTO(mem_calloc(&caster->blob_scratch, (size_t)workers, sizeof *caster->blob_scratch,
                            "workspaces", err));
        for (int i = 0; i < workers; i++)
            TRY_GOTO(blobscratch_new(geometry->n_segments, &caster->blob_scratch[i], err));
    } else if (model_has(geometry->model, MODEL_PRIMITIVES)) {
        TRY_GOTO(build_bvh(caster, err));
    } else if (model_has(geometry->model, MODEL_TRIANGLES)) {
        TRY_GOTO(meshcast_new(&geometry->mesh, &caster->mesh, err));
    } else if (cells) {
        TRY_GOTO(povray_isosurface_new(geometry, cells, &caster->isosurface, err));
    } else {
        TRY_GOTO(fieldindex_build(geometry, &caster->field, err));
        TRY_GOTO(mem_calloc(&caster->scratch, (size_t)workers, sizeof *caster->scratch,
                            "workspaces", err));
        for (int i = 0; i < workers; i++)
            TRY_GOTO(fieldscratch_new(caster->geometry, caster->field->n_tubes, &caster->scratch[i],
                                      err));
    }
    *out = caster;
    return STATUS_OK;
done:
    caster_free(caster);
    return status;
}

void caster_shadow_from(Caster *caster, double nearest_mm)
{
    caster->shadow_from_mm = nearest_mm;
}

void caster_free(Caster *caster)
{
    if (!caster)
        return;
    for (int i = 0; caster->scratch && i < caster->workers; i++)
        fieldscratch_free(caster->scratch[i]);
    free(caster->scratch);
    for (int i = 0; caster->blob_scratch && i < caster->workers; i++)
        blobscratch_free(caster->blob_scratch[i]);
    free(caster->blob_scratch);
    blobcast_free(caster->blob);
    fieldindex_free(caster->field);
    povray_isosurface_free(caster->isosurface);
    meshcast_free(caster->mesh);
    bvh_free(caster->bvh);
    free(caster->with_ends);
    free(caster);
}

/* The hit, and the index of the primitive or field segment that is hit; of triangles, whose normals
 * are not theirs alone, also whether the ray leaves there. */
static bool find_first(const Caster *caster, int worker, Ray ray, Hit *hit, uint32_t *index,
                       uint32_t *cell, bool *leaves)
{
    if (caster->bvh) {
        size_t primitive = 0;
        bool found = bvh_first_hit(caster->bvh, ray, NEAREST_SEEN_MM, hit, &primitive);
        *index = (uint32_t)primitive;
        return found;
    }
    if (caster->mesh)
        return meshcast_first_hit(caster->mesh, ray, NEAREST_SEEN_MM, hit, index, leaves);
    if (caster->isosurface)
        return povray_isosurface_first_hit(caster->isosurface, ray, NEAREST_SEEN_MM, hit, index,
                                           cell);
    if (caster->blob)
        return blobcast_first_hit(caster->blob, caster->blob_scratch[worker], ray, BLOB_NEAREST_MM,
                                  INFINITY, &hit->t, &hit->normal, index);
    return field_first_hit(caster->field, caster->scratch[worker], ray, NEAREST_SEEN_MM, INFINITY,
                           &hit->t, &hit->normal, index);
}

bool caster_first(Caster *caster, int worker, Ray ray, Surfel *surfel)
{
    const Geometry *geometry = caster->geometry;
    Hit hit;
    uint32_t index, cell = 0;
    bool leaves = false;
    if (!find_first(caster, worker, ray, &hit, &index, &cell, &leaves))
        return false;
    bool inwards = vec3_dot(hit.normal, ray.direction) > 0;
    *surfel = (Surfel){.t = hit.t,
                       .normal = inwards ? vec3_scale(hit.normal, -1) : hit.normal,
                       .segment = caster->bvh ? caster->primitives[index].segment
                                              : geometry->segments[index].segment,
                       .leaves = caster->mesh ? leaves : inwards,
                       .cell = cell};
    return true;
}

double caster_mean(const Caster *caster, const TermMean *mean, const Surfel *surfel,
                   const double *numbers, Vec3 point)
{
    if (!caster || !caster->isosurface)
        return termmean_at(mean, numbers, point);
    return povray_isosurface_mean(caster->isosurface, surfel->cell, caster->geometry->segments,
                                  numbers, point);
}

bool caster_shadow(Caster *caster, int worker, const Ground *ground, Vec3 point, Vec3 towards,
                   double distance)
{
    Ray ray = {point, towards};
    double near = caster->shadow_from_mm, far = distance - shadow_slack_mm, t;
    if (ground_hit(ground, ray, near, far, &t))
        return true;
    if (caster->bvh)
        return bvh_any_hit(caster->bvh, ray, near, far);
    if (caster->mesh)
        return meshcast_any_hit(caster->mesh, ray, near, far);
    if (caster->isosurface)
        return povray_isosurface_any_hit(caster->isosurface, ray, near, far);
    if (caster->blob)
        return blobcast_any_hit(caster->blob, caster->blob_scratch[worker], ray, BLOB_NEAREST_MM,
                                far);
    return field_is_shadowed(caster->field, caster->scratch[worker], ray, near, far);
}
