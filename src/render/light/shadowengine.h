/* How an engine answers shadow queries: "Is anything between this point and the light?"
 *
 * The engine sorts the geometry into the tiles of a light view, once per light [LightBins]. It then
 * answers the queries of many points that lie in one tile together. ShadowQueue [shadowqueue.h]
 * sorts queries into tiles and calls the engine. */
#ifndef CORCAST_RENDER_LIGHT_SHADOWENGINE_H
#define CORCAST_RENDER_LIGHT_SHADOWENGINE_H

#include "render/job.h"
#include "render/light/lightview.h"

/* Tiles of the image whose queries are answered together, and the number of their points. */
enum { SHADOW_BATCH = 512, SHADOW_MAX_POINTS = SHADOW_BATCH * TILE_SAMPLES };

/* Kernels may read and write up to POINT_PADDING elements past the last point. */
enum { POINT_PADDING = 15, POINT_CAPACITY = SHADOW_MAX_POINTS + POINT_PADDING };

/* Blockers nearer than this to a point cast no shadow on it [docs/POVRAY.md section 3]. */
#define SHADOW_NEAREST_MM 1e-3

/* Value of ShadowPoints.item for a point whose surface is not known. */
#define NO_ITEM UINT32_MAX

typedef enum ShadowState {
    SHADOW_LIT, /* nothing is between the point and the light */
    SHADOW_DARK,
    SHADOW_UNSURE /* within the margin of a kernel's arithmetic; never the engine's answer */
} ShadowState;

/* Points in one tile of a light view, and the answers. Positions are those of ProjectedPoints. */
typedef struct ShadowPoints {
    int n;
    float x[POINT_CAPACITY],
        y[POINT_CAPACITY];    /* in the plane of the view, relative to the tile's middle */
    double z[POINT_CAPACITY]; /* depth limit, minus z_middle: only blockers nearer to the light
                                 count */
    uint32_t query[POINT_CAPACITY]; /* the queue's index of the query */
    uint32_t item[POINT_CAPACITY];  /* item of the engine on whose surface the point lies, as the
                                     * engine reports it in its hits, or NO_ITEM; an engine may use
                                     * it to exclude self-shadowing */
    uint8_t state[POINT_CAPACITY];  /* ShadowState: the answer */
} ShadowPoints;

/* Copies the query of point `i` and its answer to point `at` of `to`. */
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
    int tile, next; /* indices of the tile and of the tile that will come next, row by row; -1:
                     * there is no next tile */
    RenderKernels kernels;
    ShadowPoints *points; /* at least one */
} TileQueries;

struct ShadowEngine;

/* The geometry in the tiles of a light view. Immutable once made, for queries of several threads.
 */
typedef struct LightBins {
    const struct ShadowEngine *engine;
    const Geometry *geometry; /* borrowed */
    LightView view;
    LightProjection aim; /* projection from the frame of the querying points to the light view */
    void *lists;         /* the engine's lists of the tiles; owned */
} LightBins;

typedef struct ShadowEngine {
    /* Returns true if the engine supports light views of this light, which is a point or
     * parallel. */
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
    /* Makes the workspace in which one thread answers queries. The caller ends it, even after an
     * error. `hidden` is ShadowQueueParams.hidden. NULL functions: no workspace is needed. Errors:
     * STATUS_MEMORY. */
    Status (*begin)(const LightBins *bins, const bool *hidden, void **workspace, Err *err);
    void (*end)(void *workspace);
    /* Answers the queries of a tile: sets points->state. May overwrite the points, reorder them
     * with their `query`, and remove lit points. Errors: STATUS_MEMORY. */
    Status (*test)(const LightBins *bins, void *workspace, const TileQueries *queries, Err *err);
} ShadowEngine;

/* Returns true if the engine supports light views from all points of a light. */
bool shadowengine_supports(const ShadowEngine *engine, const Drawing *drawing, const Light *light);

/* Returns true if some light of the view needs shadow rays or, with RENDER_TRACE, ambient occlusion
 * does: the drawing must have a caster then. */
bool shadowengine_needs_rays(const ShadowEngine *engine, const Drawing *drawing);

/* The parameters of lightbins_new. All pointers are borrowed. */
typedef struct LightBinsParams {
    const ShadowEngine *engine;
    const Drawing *drawing;
    Viewpoint frame; /* frame of the querying points: the camera's, or any other */
    const Box *box;  /* bounds of the points, world coordinates; NULL: they may be anywhere */
} LightBinsParams;

/* Makes the bins of n lights that the engine supports, side by side on the drawing's threads.
 *
 * bins     receives one for each light; release them with lightbins_free, even after an error.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status lightbins_new(const LightBinsParams *params, const Light *lights, size_t n,
                                LightBins **bins, Err *err);

/* Makes the bins of all lights of the view whose hard shadows come from a light view: bins[i] for
 * light i. bins[i] stays as it is for a light that casts no shadows, for an area light, for
 * RENDER_TRACE and for a light that the engine does not support. For points anywhere in the frame
 * `eye`. Ownership and errors as lightbins_new. */
MUST_CHECK Status lightbins_new_hard(const ShadowEngine *engine, const Drawing *drawing,
                                     const Viewpoint *eye, LightBins *bins[VIEW_MAX_LIGHTS],
                                     Err *err);

/* Frees the bins. NULL is allowed. */
void lightbins_free(LightBins *bins);

#endif
