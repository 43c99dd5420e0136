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

/* Maximum number of tiles of the image whose queries are answered together, and maximum number of
 * their points; reason of the value not recorded. */
enum { SHADOW_BATCH = 512, SHADOW_MAX_POINTS = SHADOW_BATCH * TILE_SAMPLES };

/* Kernels may read and write up to POINT_PADDING elements past the last point. */
enum { POINT_PADDING = 15, POINT_CAPACITY = SHADOW_MAX_POINTS + POINT_PADDING };

/* A blocker nearer than this to a point casts no shadow on the point, mm: POV-Ray's limit
 * [docs/POVRAY.md section 3]. */
#define SHADOW_NEAREST_MM 1e-3

/* Value of ShadowPoints.item for a point whose surface is not known. */
#define NO_ITEM UINT32_MAX

/* The answer to a query. */
typedef enum ShadowState {
    SHADOW_LIT,   /* nothing is between the point and the light */
    SHADOW_DARK,  /* an object is between the point and the light */
    SHADOW_UNSURE /* undecided by a kernel, because the result is within its rounding error; an
                   * engine never returns it */
} ShadowState;

/* The points in one tile of a light view, and the answers. Positions are as in ProjectedPoints
 * [tilekernels.h]. */
typedef struct ShadowPoints {
    int n;
    float x[POINT_CAPACITY], y[POINT_CAPACITY]; /* position in the view's plane, relative to the
                                                 * middle of the tile */
    double z[POINT_CAPACITY];                   /* depth limit, minus z_middle: only blockers with a
                                                 * smaller depth count */
    uint32_t query[POINT_CAPACITY];             /* index of the query in the queue */
    uint32_t item[POINT_CAPACITY];              /* item on whose surface the point is, as the engine
                                                 * reports it in its hits, or NO_ITEM. An engine may
                                                 * use it to exclude self-shadowing */
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
    ShadowPoints *points; /* at least one */
} TileQueries;

struct ShadowEngine;

/* The geometry, sorted into the tiles of a light view. It does not change after it is made, and can
 * be queried by several threads. */
typedef struct LightBins {
    const struct ShadowEngine *engine;
    const Geometry *geometry; /* borrowed */
    LightView view;
    LightProjection aim; /* projection from the frame of the querying points to the light view */
    void *lists;         /* the engine's lists of the tiles; owned */
} LightBins;

/* An engine: a table of functions. */
typedef struct ShadowEngine {
    /* Returns true if the engine supports the light view of this light, which is a point light or a
     * parallel light. */
    bool (*supports)(const Geometry *geometry, const View *view, const Light *light);
    /* Returns the number of tiles along a side of a light view. */
    int (*tiles)(const Drawing *drawing);
    /* Returns the distance from a point, mm, below which blockers cast no shadow on it. */
    double (*slack)(const Drawing *drawing);
    /* Sorts the drawing's geometry into the tiles of bins->view, by drawing->params->threads
     * threads, and sets bins->lists. Errors: STATUS_MEMORY. */
    Status (*bin)(const Drawing *drawing, LightBins *bins, Err *err);
    /* Frees the lists. NULL is allowed. */
    void (*release)(void *lists);
    /* Makes the workspace in which one thread answers queries. The caller frees it with `end`, even
     * after an error. `hidden` is as in shadowqueue_new. `begin` and `end` are NULL if no workspace
     * is needed. Errors: STATUS_MEMORY. */
    Status (*begin)(const LightBins *bins, const bool *hidden, void **workspace, Err *err);
    void (*end)(void *workspace);
    /* Answers the queries of a tile: sets points->state. May overwrite the points, reorder them
     * together with their `query`, and remove lit points. Errors: STATUS_MEMORY. */
    Status (*test)(const LightBins *bins, void *workspace, const TileQueries *queries, Err *err);
} ShadowEngine;

/* Returns true if the engine supports light views from all sample points of a light. */
bool shadowengine_supports(const ShadowEngine *engine, const Drawing *drawing, const Light *light);

/* Returns true if the drawing must have a caster: because a light of the view needs shadow rays or,
 * with RENDER_TRACE, because ambient occlusion needs rays. */
bool shadowengine_needs_rays(const ShadowEngine *engine, const Drawing *drawing);

/* Parameters of lightbins_new. All pointers are borrowed. */
typedef struct LightBinsParams {
    const ShadowEngine *engine;
    const Drawing *drawing;
    Viewpoint frame; /* frame in which querying points are given: that of the camera, or any
                      * other */
    const Box *box;  /* bounds of the querying points, world coordinates; NULL: they may be
                      * anywhere */
} LightBinsParams;

/* Makes the bins of n lights that the engine supports, in parallel on the drawing's threads.
 *
 * bins     receives the bins of light i in bins[i]; release each with lightbins_free, even after an
 *          error.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status lightbins_new(const LightBinsParams *params, const Light *lights, size_t n,
                                LightBins **bins, Err *err);

/* Makes the bins of all lights of the view whose hard shadows are computed with a light view:
 * bins[i] for light i. Querying points are given in the frame `eye` and may be anywhere.
 *
 * bins[i] stays unchanged in these cases: light i casts no shadows, is an area light, or is not
 * supported by the engine; or the method is RENDER_TRACE. Ownership and errors are those of
 * lightbins_new. */
MUST_CHECK Status lightbins_new_for_view(const ShadowEngine *engine, const Drawing *drawing,
                                         const Viewpoint *eye, LightBins *bins[VIEW_MAX_LIGHTS],
                                         Err *err);

/* Frees the bins. NULL is allowed. */
void lightbins_free(LightBins *bins);

#endif
