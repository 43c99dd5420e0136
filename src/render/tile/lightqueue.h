/* Places of many tiles of a picture, sorted into the tiles of a light's view. */
#ifndef CORCAST_RENDER_LIGHTQUEUE_H
#define CORCAST_RENDER_LIGHTQUEUE_H

#include "render/tile/tilekernels.h"

/* Tiles of the picture whose places a light is asked about together. */
enum { LIGHT_BATCH = 512, LIGHT_MOST_PLACES = LIGHT_BATCH * TILE_SAMPLES };

/* Questions to one light, for the places of up to LIGHT_BATCH tiles of the picture. Not
 * thread-safe: each worker has a queue of its own for each light. */
typedef struct LightQueue LightQueue;

/* Makes an empty queue for a light's view. *out is the caller's even when this fails.
 * STATUS_MEMORY. */
MUST_CHECK Status lightqueue_new(const LightAim *aim, LightQueue **out, Err *err);
void lightqueue_free(LightQueue *queue);

/* Adds a question for each place i whose bit is set in `wanted`, and returns the number that this
 * call has among those since the last lightqueue_visit; at most LIGHT_BATCH. */
int lightqueue_ask(LightQueue *queue, const TileKernels *kernels, const SeenPlaces *places,
                   uint64_t wanted);

/* A place as the light sees it, as AimedPlaces have it, and which of whose call it is. */
typedef struct AskedPlace {
    double x, y, z;
    uint32_t call, sample; /* calls are counted since the last lightqueue_visit */
} AskedPlace;

/* What one tile of the light is asked: places[n]. `next` is the tile that comes after it, or -1. */
typedef struct LightRequest {
    int tile, next; /* row by row */
    const AskedPlace *places;
    int n;
} LightRequest;

/* Shows what is asked of each tile of the light to `visit`, in the order in which tiles were first
 * asked, and empties the queue. */
typedef void LightVisitor(const LightRequest *request, void *context);
void lightqueue_visit(LightQueue *queue, LightVisitor *visit, void *context);

#endif
