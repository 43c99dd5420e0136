/* Counts from how many points of a light each shading point is lit. A ShadowPass does this with
 * several light views at once; shadowrays_count does it for one point with shadow rays.
 *
 * A light view is the projection of the vessels from a light [shadowengine.h]. The caller of a
 * ShadowPass makes one set of light bins per light view, describes its shading points by a
 * ShadowClient, and calls shadowpass_init, shadowpass_run for ranges of points, and
 * shadowpass_release. */
#ifndef CORCAST_RENDER_LIGHT_SHADOWPASS_H
#define CORCAST_RENDER_LIGHT_SHADOWPASS_H

#include "render/light/shadowqueue.h"

/* Maximum number of points of one call of shadowpass_run. The arrays of 8192 points take 25 KB of
 * stack, and the queries of a run stay in the cache. */
enum { SHADOW_RUN = 8192 };

/* The source of the shading points, and the receiver of the results. */
typedef struct ShadowClient {
    /* Sets points[k] to shading point first + k for 0 <= k < n <= TILE_SAMPLES, in the frame for
     * which the light bins were made. Returns a bit mask: bit k is set if the point needs a query.
     * A point without a query counts as not lit. */
    uint64_t (*locate)(const void *context, size_t first, size_t n, HitPoints *points);
    /* Receives the number of light views from which shading point `index` is lit. Calls for
     * different points may come from different threads. */
    void (*store)(const void *context, size_t index, int n_lit);
    const void *context; /* passed to both functions; borrowed */
} ShadowClient;

/* The light views, and one shadow queue per light view and worker. */
typedef struct ShadowPass {
    ShadowClient client;
    int n_views;
    ShadowQueue **queues; /* queue of light view v and worker w: queues[w * n_views + v]; owned */
    size_t n_queues;      /* n_views times the number of workers */
} ShadowPass;

/* Makes the queues for n_views light bins, which are borrowed.
 *
 * hidden   as in shadowqueue_new.
 * pass     receives the pass. The caller has set pass->client. Release it with shadowpass_release,
 *          even after an error.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status shadowpass_init(const Drawing *drawing, LightBins *const *bins, int n_views,
                                  const bool *hidden, ShadowPass *pass, Err *err);
void shadowpass_release(ShadowPass *pass);

/* Counts, for each of the shading points [begin, end), the light views from which the point is lit,
 * and passes the counts to client.store. end - begin is at most SHADOW_RUN. A point at the very
 * edge of a shadow may count differently if other points are in the same call, because kernels then
 * round differently. Errors: STATUS_MEMORY. */
MUST_CHECK Status shadowpass_run(const ShadowPass *pass, size_t begin, size_t end, int worker,
                                 Err *err);

/* Sample sets. The sample points of an area light form a grid; each block of 2 x 2 of them has one
 * point of each of the four sets. Each pixel has one of the sets, by its position in its block of
 * 2 x 2 pixels, and queries only the points of this set: a quarter of the light's points
 * [arealights.c]. ALL_SETS stands for all points. */
enum { SAMPLE_SETS = 4, ALL_SETS = -1 };

/* Returns the sample set, 0 to 3, at a position in the pattern. */
static inline int sampleset_at(int column, int row)
{
    return (row & 1) * 2 + (column & 1);
}

/* Returns true if point k of a light belongs to the set, or if `set` is ALL_SETS. */
static inline bool sampleset_has(int set, const Light *light, int k)
{
    return set == ALL_SETS || sampleset_at(k % light->samples, k / light->samples) == set;
}

/* Returns the number of points of a light's sample set that are visible from the shading point
 * `point` (world coordinates, mm). Traces one shadow ray per point with the drawing's caster. */
int shadowrays_count(const Drawing *drawing, int worker, const Light *light, int set, Vec3 point);

#endif
