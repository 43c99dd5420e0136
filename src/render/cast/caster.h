/* What a ray meets first, and whether anything is in its way, for every kind of geometry. */
#ifndef CORCAST_RENDER_CASTER_H
#define CORCAST_RENDER_CASTER_H

#include "render/cast/raysearch.h"

/* Returns how near to the start of a ray crossings are not seen in this geometry. */
static inline double caster_nearest_mm(const Geometry *geometry)
{
    return raysearch_for(geometry, false)->nearest_mm;
}

/* Constant once built, but for the workspaces of its threads. */
typedef struct Caster Caster;

/* A visible point. */
typedef struct Surfel {
    double t;         /* mm along the ray */
    Vec3 normal;      /* unit, facing the viewer */
    uint32_t segment; /* number of the segment */
    bool leaves;      /* seen from inside the vessel */
    uint32_t cell;    /* number of POV-Ray's cell; undefined where there are none */
} Surfel;

/* Builds the search structure of the geometry, which is borrowed until caster_free, with workspaces
 * for `workers` threads. With `cells`, an isosurface is found where POV-Ray's root finder finds it
 * in them; NULL: where it is, by proof. O(n log n) of n primitives or segments. STATUS_MEMORY;
 * STATUS_INFEASIBLE when the surface cannot be cut into cells. */
MUST_CHECK Status caster_new(const Geometry *geometry, const CellParams *cells, int workers,
                             Caster **out, Err *err);
/* From now on nothing that is nearer to a lit place than this, mm, casts a shadow on it. At first
 * that is POV-Ray's limit, 0.001 mm. A blob keeps a limit of its own, 0.01 mm. */
void caster_shadow_from(Caster *caster, double nearest_mm);
void caster_free(Caster *caster);

/* The first point at which the ray meets a vessel, NEAREST_SEEN_MM or more along it (0.01 mm of a
 * blob): true and *surfel, or false. `worker`, in [0, workers), is the calling thread's number,
 * which no other thread may use at the same time; so it is below. */
bool caster_first(Caster *caster, int worker, Ray ray, Surfel *surfel);
/* The mean of numbers[segment] at a point of an implicit surface that the surfel is of, weighted by
 * the segments' terms: of POV-Ray's cell where there are cells, else by `mean` [termmean_at]. The
 * caster may be NULL: there are no cells. */
double caster_mean(const Caster *caster, const TermMean *mean, const Surfel *surfel,
                   const double *numbers, Vec3 point);
/* Whether a vessel or the ground is in the way from `point` for `distance` mm (or HUGE_VAL) along
 * `towards` (unit). What is nearer to the point than the limit of caster_shadow_from, or nearer to
 * the other end than 0.001 mm, is not. */
bool caster_shadow(Caster *caster, int worker, const Ground *ground, Vec3 point, Vec3 towards,
                   double distance);

#endif
