/* Counts how many points of a light are visible from each shading point: by queries to several
 * light views at once, or by shadow rays. The caller describes its points by a ShadowPoser. */
#ifndef CORCAST_RENDER_LIGHT_SHADOWPASS_H
#define CORCAST_RENDER_LIGHT_SHADOWPASS_H

#include "render/light/shadowqueue.h"

/* Maximum number of points of one call of shadowpass_run. */
enum { SHADOW_RUN = 8192 };

/* The points that query, and the receiver of the results. */
typedef struct ShadowPoser {
    /* Sets points[k] to point first + k for k < n <= TILE_SAMPLES, in the frame for which the light
     * bins were made. Returns as bits the points that query; the others count as dark. */
    uint64_t (*locate)(const void *context, size_t first, size_t n, HitPoints *points);
    /* Receives the number of light views from which point `index` is lit. Calls for different
     * points may come from different threads. */
    void (*store)(const void *context, size_t index, int n_lit);
    const void *context; /* passed to both; borrowed */
} ShadowPoser;

/* The light views, and one shadow queue per light view and worker. */
typedef struct ShadowPass {
    ShadowPoser poser;
    int n_views;
    ShadowQueue **queues; /* n_views for each worker; owned */
    size_t n_queues;
} ShadowPass;

/* Makes the queues to n_views light bins, which are borrowed.
 *
 * hidden   as in shadowqueue_new.
 * pass     release it with shadowpass_release, even after an error.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status shadowpass_init(const Drawing *drawing, LightBins *const *bins, int n_views,
                                  const bool *hidden, ShadowPass *pass, Err *err);
void shadowpass_release(ShadowPass *pass);

/* Counts for each of the points [begin, end), at most SHADOW_RUN, the light views from which the
 * point is lit, and passes the counts to poser.store. Rounding in kernels depends on which points
 * are in one call. Errors: STATUS_MEMORY. */
MUST_CHECK Status shadowpass_run(const ShadowPass *pass, size_t begin, size_t end, int worker,
                                 Err *err);

/* Sample sets: the points of an area light, row by row, in blocks of 2 x 2. A point's set is its
 * position in its block. Pixels of the image have the same sets [arealights.c]. */
enum { SAMPLE_SETS = 4, ALL_SETS = -1 };

/* Returns the sample set at a position in the pattern. */
static inline int sampleset_at(int column, int row)
{
    return (row & 1) * 2 + (column & 1);
}

/* Returns true if point k of a light belongs to the set, or if `set` is ALL_SETS. */
static inline bool sampleset_has(int set, const Light *light, int k)
{
    return set == ALL_SETS || sampleset_at(k % light->samples, k / light->samples) == set;
}

/* Returns the number of points of a light's sample set that are visible from `point` (world
 * coordinates), by shadow rays of the drawing's caster. */
int shadowrays_count(const Drawing *drawing, int worker, const Light *light, int set, Vec3 point);

#endif
