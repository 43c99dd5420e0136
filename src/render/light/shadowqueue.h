/* Places of many tiles of a picture, sorted into the tiles of a light's view. */
#ifndef CORCAST_RENDER_SHADOWQUEUE_H
#define CORCAST_RENDER_SHADOWQUEUE_H

#include "render/tile/tilekernels.h"

/* Tiles of the picture whose places a light is asked about together. */
enum { SHADOW_BATCH = 512, SHADOW_MAX_POINTS = SHADOW_BATCH * TILE_SAMPLES };

/* Questions to one light, for the places of up to SHADOW_BATCH tiles of the picture. Not
 * thread-safe: each worker has a queue of its own for each light. */
typedef struct ShadowQueue ShadowQueue;

/* Makes an empty queue for a light's view. *out is the caller's even when this fails.
 * STATUS_MEMORY. */
MUST_CHECK Status shadowqueue_new(const LightAim *aim, ShadowQueue **out, Err *err);
void shadowqueue_free(ShadowQueue *queue);

/* Adds a question for each place i whose bit is set in `wanted`, and returns the number that this
 * call has among those since the last shadowqueue_visit; at most SHADOW_BATCH. */
int shadowqueue_ask(ShadowQueue *queue, const TileKernels *kernels, const SeenPlaces *places,
                    uint64_t wanted);

/* Kernels may read and write so many places more than there are. */
enum { POINT_PADDING = 15, POINT_CAPACITY = SHADOW_MAX_POINTS + POINT_PADDING };

/* Places as the light sees them [AimedPlaces], and which of whose call each is: TILE_SAMPLES call +
 * i, calls counted since the last shadowqueue_visit. */
typedef struct QueuedPoints {
    float x[POINT_CAPACITY], y[POINT_CAPACITY];
    double z[POINT_CAPACITY];
    uint32_t from[POINT_CAPACITY];
} QueuedPoints;

/* What one tile of the light is asked: n places, which may be overwritten. `next` is the tile that
 * comes after it, or -1. */
typedef struct TileQueries {
    int tile, next; /* row by row */
    QueuedPoints *places;
    int n;
} TileQueries;

/* Shows what is asked of each tile of the light to `visit`, in the order in which tiles were first
 * asked, and empties the queue. */
typedef void LightVisitor(const TileQueries *request, void *context);
void shadowqueue_visit(ShadowQueue *queue, LightVisitor *visit, void *context);

#endif
