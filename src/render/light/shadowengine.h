/* The interface of engines that answer shadow queries. A query asks whether an object is between a
 * point and a light.
 *
 * For each light, the engine sorts the geometry into the tiles of a light view [LightBins]. It then
 * answers the queries of many points in one tile together. ShadowQueue [shadowqueue.h] sorts
 * queries into tiles and calls the engine. */
#ifndef CORCAST_RENDER_LIGHT_SHADOWENGINE_H
#define CORCAST_RENDER_LIGHT_SHADOWENGINE_H

#include "render/job.h"
#include "render/light/lightview.h"

/* SHADOW_BATCH is the maximum number of tiles of the image whose queries are answered together; 512
 * need about 2 MB per light and thread. More tiles put more queries into one tile of a light view,
 * and need more memory. SHADOW_MAX_POINTS is the number of samples in these tiles. */
enum { SHADOW_BATCH = 512, SHADOW_MAX_POINTS = SHADOW_BATCH * TILE_SAMPLES };

/* Kernels may read and write up to POINT_PADDING elements past the last point: one less than the
 * maximum number of lanes. */
enum { POINT_PADDING = 15, POINT_CAPACITY = SHADOW_MAX_POINTS + POINT_PADDING };

/* A blocker nearer than this to a point casts no shadow on the point, mm: POV-Ray's limit
 * [docs/POVRAY.md section 3]. An engine may use a larger limit [ShadowEngine.slack]. */
#define SHADOW_NEAREST_MM 1e-3

/* Value of ShadowPoints.item for a point whose surface is not known. */
#define NO_ITEM UINT32_MAX

/* The answer to a query. */
typedef enum ShadowState {
    SHADOW_LIT,   /* nothing is between the point and the light */
    SHADOW_DARK,  /* an object is between the point and the light */
    SHADOW_UNSURE /* inside an engine only: a kernel could not decide within its rounding error, so
                   * the engine must test the point exactly */
} ShadowState;

/* The query points in one tile of a light view, and the answers. Positions and depths are as in
 * ProjectedPoints [tilekernels.h]. */
typedef struct ShadowPoints {
    int n;
    float x[POINT_CAPACITY], y[POINT_CAPACITY]; /* position in the light view's plane, relative to
                                                 * the middle of the tile */
    double z[POINT_CAPACITY];                   /* depth limit along the view axis, minus
                                                 * LightView.z_middle: only a blocker nearer to
                                                 * the light than this shadows the point */
    uint32_t query[POINT_CAPACITY];             /* index of the query in the queue */
    uint32_t item[POINT_CAPACITY];              /* index, as in the renderer's hits, of the item on
                                                 * whose surface the point is; or NO_ITEM. An
                                                 * engine may use it to exclude self-shadowing */
    uint8_t state[POINT_CAPACITY];              /* ShadowState: the answer */
} ShadowPoints;

/* Copies point `i` of `from` to point `at` of `to`. */
static inline void shadowpoints_copy(const ShadowPoints *from, int i, ShadowPoints *to, int at)
{
    to->x[at] = from->x[i];
    to->y[at] = from->y[i];
    to->z[at] = from->z[i];
    to->query[at] = from->query[i];
    to->item[at] = from->item[i];
    to->state[at] = from->state[i];
}

/* The queries for one tile of a light view. */
typedef struct TileQueries {
    int tile, next; /* indices, row by row, of this tile and of the tile that is processed next; -1:
                     * no next tile */
    RenderKernels kernels;
    ShadowPoints *points; /* the queries in this tile; points->n >= 1 */
} TileQueries;

struct ShadowEngine;

/* The geometry, sorted into the tiles of a light view. It does not change after it is made, and can
 * be queried by several threads. */
typedef struct LightBins {
    const struct ShadowEngine *engine;
    const Geometry *geometry; /* borrowed */
    LightView view;
    LightProjection aim; /* projection from the frame of the query points to the light view */
    void *lists;         /* the engine's lists of the tiles; owned */
} LightBins;

/* An engine: a table of functions. */
typedef struct ShadowEngine {
    /* Returns true if the engine supports the light view of this light, which is a point light or a
     * parallel light. */
    bool (*supports)(const Geometry *geometry, const View *view, const Light *light);
    /* Returns the number of tiles along a side of a light view. */
    int (*tiles)(const Drawing *drawing);
    /* Returns the distance from a point, mm, below which blockers cast no shadow on the point:
     * SHADOW_NEAREST_MM, or more if the engine's rounding errors require it. */
    double (*slack)(const Drawing *drawing);
    /* Sorts the drawing's geometry into the tiles of bins->view, by drawing->params->threads
     * threads, and sets bins->lists. Errors: STATUS_MEMORY. */
    Status (*bin)(const Drawing *drawing, LightBins *bins, Err *err);
    /* Frees the lists. NULL is allowed. */
    void (*release)(void *lists);
    /* Makes the workspace in which one thread answers queries. The caller frees it with `end`, even
     * after an error. `hidden` is the parameter of shadowqueue_new [shadowqueue.h]. `begin` and
     * `end` are NULL if no workspace is needed. Errors: STATUS_MEMORY. */
    Status (*begin)(const LightBins *bins, const bool *hidden, void **workspace, Err *err);
    void (*end)(void *workspace);
    /* Answers the queries of a tile: sets points->state. May overwrite the points, reorder them
     * together with their `query`, and remove points, which then count as lit. Errors:
     * STATUS_MEMORY. */
    Status (*test)(const LightBins *bins, void *workspace, const TileQueries *queries, Err *err);
} ShadowEngine;

/* Returns true if the engine supports light views from all sample points of a light. */
bool shadowengine_supports(const ShadowEngine *engine, const Drawing *drawing, const Light *light);

/* Returns true if the drawing needs a Caster [render/cast/caster.h], which traces rays. There are
 * two reasons. A light that casts shadows needs shadow rays, because the method is RENDER_TRACE or
 * the engine does not support the light. Or the method is RENDER_TRACE and ambient occlusion is
 * on. */
bool shadowengine_needs_rays(const ShadowEngine *engine, const Drawing *drawing);

/* Parameters of lightbins_new. All pointers are borrowed. */
typedef struct LightBinsParams {
    const ShadowEngine *engine;
    const Drawing *drawing;
    Viewpoint frame; /* frame of the coordinates of the query points: the camera's frame, or any
                      * other */
    const Box *box;  /* bounds of the query points, world coordinates; NULL: the points may be
                      * anywhere */
} LightBinsParams;

/* Makes the bins of n lights that the engine supports, in parallel on the drawing's threads.
 *
 * bins     receives the bins of light i in bins[i]; release each with lightbins_free, even after an
 *          error. Old values of bins[i] are overwritten. After an error some bins[i] are NULL.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status lightbins_new(const LightBinsParams *params, const Light *lights, size_t n,
                                LightBins **bins, Err *err);

/* Makes the bins of the lights of drawing->view that need them: point lights and parallel lights
 * that cast shadows and that the engine supports, unless the method is RENDER_TRACE. The
 * coordinates of query points are in the frame `eye`; the points may be anywhere.
 *
 * bins     the caller sets all elements to NULL before. bins[i] receives the bins of light i, or
 *          stays NULL if light i needs none. Release each with lightbins_free, even after an error.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status lightbins_new_for_view(const ShadowEngine *engine, const Drawing *drawing,
                                         const Viewpoint *eye, LightBins *bins[VIEW_MAX_LIGHTS],
                                         Err *err);

/* Frees the bins. NULL is allowed. */
void lightbins_free(LightBins *bins);

#endif
