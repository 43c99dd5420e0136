/* Casts rays at a geometry of any kind: a common interface to the five searches [raysearch.h]. It
 * adds what they share: POV-Ray's minimum distances of hits and of blockers of light, workspaces of
 * threads, and normals that face the viewer. */
#include "render/cast/caster.h"

#include <stdlib.h>

/* POV-Ray's limit [docs/POVRAY.md section 3]: blockers within it of the lit point or of the light
 * cast no shadow. */
static const double shadow_slack_mm = 1e-3;

struct Caster {
    Geometry geometry;    /* shallow copy, with the primitives that the original implies */
    Primitive *with_ends; /* all primitives, if the original implies some; NULL otherwise; owned */
    const RaySearch *search;
    RayIndex index;    /* index of the copy */
    void **workspaces; /* per worker; owned */
    int workers;
    double shadow_from_mm; /* blockers nearer to the lit point cast no shadow */
};

/* Adds the primitives that the geometry implies to the caster's copy. */
static Status add_ends(Caster *caster, Err *err)
{
    Geometry *geometry = &caster->geometry;
    if (!geometry->implied_ends)
        return STATUS_OK;
    TRY(geometry_with_ends(geometry, &caster->with_ends, &geometry->n_primitives, err));
    geometry->primitives = caster->with_ends;
    return STATUS_OK;
}

static Status make_workspaces(Caster *caster, Err *err)
{
    const RaySearch *search = caster->search;
    TRY(mem_calloc(&caster->workspaces, (size_t)caster->workers, sizeof *caster->workspaces,
                   "workspaces", err));
    for (int i = 0; i < caster->workers && search->workspace_new; i++)
        TRY(search->workspace_new(&caster->geometry, caster->geometry.n_segments,
                                  &caster->workspaces[i], err));
    return STATUS_OK;
}

Status caster_new(const Geometry *geometry, const CellParams *cells, int workers, Caster **out,
                  Err *err)
{
    Caster *caster = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&caster, 1, sizeof *caster, "casters", err));
    caster->geometry = *geometry;
    caster->workers = workers;
    caster->shadow_from_mm = shadow_slack_mm;
    caster->search = raysearch_for(geometry, cells != NULL);
    caster->index.geometry = &caster->geometry;
    TRY_GOTO(add_ends(caster, err));
    TRY_GOTO(caster->search->build(&caster->index, cells, err));
    TRY_GOTO(make_workspaces(caster, err));
    *out = caster;
    caster = NULL;
done:
    caster_free(caster);
    return status;
}

void caster_set_shadow_nearest(Caster *caster, double nearest_mm)
{
    caster->shadow_from_mm = nearest_mm;
}

void caster_free(Caster *caster)
{
    if (!caster)
        return;
    for (int i = 0; caster->workspaces && i < caster->workers; i++)
        if (caster->search->workspace_free)
            caster->search->workspace_free(caster->workspaces[i]);
    free(caster->workspaces);
    rayindex_release(&caster->index);
    free(caster->with_ends);
    free(caster);
}

bool caster_first(Caster *caster, int worker, Ray ray, Surfel *surfel)
{
    const RayPart part = {ray, caster->search->nearest_mm, INFINITY};
    RayHit hit = {.cell = 0};
    if (!caster->search->first(&caster->index, caster->workspaces[worker], &part, &hit))
        return false;
    bool inwards = vec3_dot(hit.normal, ray.direction) > 0;
    *surfel = (Surfel){.t = hit.t,
                       .normal = inwards ? vec3_scale(hit.normal, -1) : hit.normal,
                       .segment = geometry_segment(&caster->geometry, hit.index),
                       .from_inside = caster->index.planes ? hit.from_inside : inwards,
                       .cell = hit.cell};
    return true;
}

double caster_mean(const Caster *caster, const TermMean *mean, const Surfel *surfel,
                   const double *numbers, Vec3 point)
{
    if (!caster || caster->search != &cell_search)
        return termmean_at(mean, numbers, point);
    const CellTree *cells = &caster->index.cells;
    return cell_mean(cells, &cells->cells[surfel->cell], caster->geometry.segments, numbers, point);
}

bool caster_shadow(Caster *caster, int worker, const Ground *ground, Vec3 point, Vec3 towards,
                   double distance)
{
    const RaySearch *search = caster->search;
    const Ray ray = {point, towards};
    double near = caster->shadow_from_mm, far = distance - shadow_slack_mm, t;
    if (ground_hit(ground, ray, near, far, &t))
        return true;
    const RayPart part = {ray, search->shadow_from_mm > 0 ? search->shadow_from_mm : near, far};
    return search->any(&caster->index, caster->workspaces[worker], &part);
}
