/* Casts rays in any kind of geometry: finds the first visible surface point of a ray, and tests
 * whether a point is in shadow. A caster applies POV-Ray's distance limits to the searches of
 * raysearch.h: crossings nearer than the limit are ignored.
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

/* Returns the minimum visible distance in this geometry, mm: caster_first ignores crossings nearer
 * to the ray's origin. */
static inline double caster_nearest_mm(const Geometry *geometry)
{
    return raysearch_for(geometry, false)->nearest_mm;
}

/* A caster. It does not change after it is built, except for the workspaces of its threads. */
typedef struct Caster Caster;

/* A visible surface point. */
typedef struct Surfel {
    double t;         /* distance along the ray, mm */
    Vec3 normal;      /* unit, facing the viewer */
    uint32_t segment; /* segment index [scene/geometry.h] */
    bool from_inside; /* true: the ray comes from inside the vessel */
    uint32_t cell;    /* index of POV-Ray's cell; 0 if the caster has no cells */
} Surfel;

/* Builds the search structure of a geometry, and workspaces for `workers` threads.
 *
 * geometry  borrowed until caster_free.
 * cells     if not NULL, isosurfaces are divided into bounding cells as in the POV-Ray scene, and
 *           intersected by POV-Ray's approximate root finder, to reproduce POV-Ray's picture. NULL:
 *           intersections are exact to a proven tolerance [raysearch.h].
 * out       receives the caster; release it with caster_free. Set on success only.
 * Errors    STATUS_MEMORY; STATUS_INFEASIBLE if the surface cannot be divided into cells.
 * Cost      O(n log n) for n primitives, triangles or segments. */
MUST_CHECK Status caster_new(const Geometry *geometry, const CellParams *cells, int workers,
                             Caster **out, Err *err);
/* Sets the minimum distance of blockers, mm: blockers nearer to a shading point cast no shadow on
 * it. The default is POV-Ray's limit, 0.001 mm. For blobs the limit is always BLOB_NEAREST_MM. */
void caster_set_shadow_nearest(Caster *caster, double nearest_mm);
/* Frees the caster. NULL is allowed. */
void caster_free(Caster *caster);

/* Finds the first point at which the ray, whose direction is a unit vector, hits a vessel, at the
 * distance caster_nearest_mm or more. Returns false if there is none; *surfel is then unchanged.
 *
 * worker   index of the calling thread, in [0, workers). No other thread may use the same index at
 *          the same time. */
bool caster_first(Caster *caster, int worker, Ray ray, Surfel *surfel);
/* Returns the weighted mean of values[segment] at a point of an implicit surface. The weight of a
 * segment is the value of its term (its contribution to the field) at the point.
 *
 * caster   if it was built with cells, only the terms of POV-Ray's cell surfel->cell count. If it
 *          has none or is NULL, all terms count, as in termmean_at [field.h].
 * values   one value per segment index. */
double caster_mean(const Caster *caster, const TermMean *mean, const Surfel *surfel,
                   const double *values, Vec3 point);
/* Returns true if a vessel or the ground is between `point` and the light. Blockers within the
 * limit of caster_set_shadow_nearest of the point, or within 0.001 mm of the light, POV-Ray's
 * limit, are ignored.
 *
 * towards   unit direction to the light.
 * distance  distance to the light, mm; HUGE_VAL for a light at infinity.
 * worker    index of the calling thread, as in caster_first. */
bool caster_shadow(Caster *caster, int worker, const Ground *ground, Vec3 point, Vec3 towards,
                   double distance);

#endif
