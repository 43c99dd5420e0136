/* Casts rays in any kind of geometry: finds the first visible surface point of a ray, and tests for
 * shadow. It adds POV-Ray's limits to the searches of raysearch.h: crossings that are too near do
 * not count.
 *
 *     Caster *caster;
 *     Surfel surfel;
 *     TRY(caster_new(&geometry, NULL, 1, &caster, err));
 *     if (caster_first(caster, 0, ray, &surfel))
 *         ... the ray hits segment surfel.segment after surfel.t mm
 *     caster_free(caster); */
#ifndef CORCAST_RENDER_CAST_CASTER_H
#define CORCAST_RENDER_CAST_CASTER_H

#include "render/cast/raysearch.h"

/* Returns the distance from a ray's origin, mm, below which crossings are not visible in this
 * geometry. */
static inline double caster_nearest_mm(const Geometry *geometry)
{
    return raysearch_for(geometry, false)->nearest_mm;
}

/* Immutable once built, except the workspaces of its threads. */
typedef struct Caster Caster;

/* A visible surface point. */
typedef struct Surfel {
    double t;         /* mm along the ray */
    Vec3 normal;      /* unit, facing the viewer */
    uint32_t segment; /* index of the vessel segment, in Geometry.ids */
    bool from_inside; /* the ray comes from inside the vessel */
    uint32_t cell;    /* index of POV-Ray's cell; 0 if the caster has no cells */
} Surfel;

/* Builds the search structure of a geometry and workspaces for `workers` threads.
 *
 * geometry  borrowed until caster_free.
 * cells     parameters of POV-Ray's cells: an isosurface is found where POV-Ray's root finder finds
 *           it. NULL: an isosurface is found at its proven position.
 * out       receives the caster; release it with caster_free. Set on success only.
 * Errors    STATUS_MEMORY; STATUS_INFEASIBLE if the surface cannot be cut into cells.
 * Cost      O(n log n) for n primitives, triangles or segments. */
MUST_CHECK Status caster_new(const Geometry *geometry, const CellParams *cells, int workers,
                             Caster **out, Err *err);
/* Sets the distance from a lit point, mm, up to which blockers cast no shadow on it. The default is
 * POV-Ray's limit, 0.001 mm. Blobs have a fixed limit instead, 0.01 mm. */
void caster_shadow_from(Caster *caster, double nearest_mm);
/* Frees the caster. NULL is allowed. */
void caster_free(Caster *caster);

/* Finds the first point at which the ray hits a vessel, at caster_nearest_mm or farther. Returns
 * false, *surfel unchanged, if there is none.
 *
 * worker   index of the calling thread, in [0, workers). No other thread may use the same index at
 *          the same time. */
bool caster_first(Caster *caster, int worker, Ray ray, Surfel *surfel);
/* Returns the mean of numbers[segment] at a point of an implicit surface. The weights are the
 * segments' terms at the point.
 *
 * caster   with cells: the mean over the terms of POV-Ray's cell, surfel->cell. Without cells, or
 *          NULL: the result of termmean_at. */
double caster_mean(const Caster *caster, const TermMean *mean, const Surfel *surfel,
                   const double *numbers, Vec3 point);
/* Returns true if a vessel or the ground blocks the path from `point` to the light. Blockers within
 * the limit of caster_shadow_from of the point, or within 0.001 mm of the light, do not count.
 *
 * towards   unit direction to the light.
 * distance  to the light, mm; HUGE_VAL for a light at infinity.
 * worker    index of the calling thread, as in caster_first. */
bool caster_shadow(Caster *caster, int worker, const Ground *ground, Vec3 point, Vec3 towards,
                   double distance);

#endif
