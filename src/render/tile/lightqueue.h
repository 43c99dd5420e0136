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

/* Kernels may read and write so many places more than there are. */
enum { PLACES_BEHIND = 15, PLACES_ROOM = LIGHT_MOST_PLACES + PLACES_BEHIND };

/* Places as the light sees them [AimedPlaces], and which of whose call each is: TILE_SAMPLES call +
 * i, calls counted since the last lightqueue_visit. */
typedef struct AskedPlaces {
    float x[PLACES_ROOM], y[PLACES_ROOM];
    double z[PLACES_ROOM];
    uint32_t from[PLACES_ROOM];
} AskedPlaces;

/* What one tile of the light is asked: n places, which may be overwritten. `next` is the tile that
 * comes after it, or -1. */
typedef struct LightRequest {
    int tile, next; /* row by row */
    AskedPlaces *places;
    int n;
} LightRequest;

/* Shows what is asked of each tile of the light to `visit`, in the order in which tiles were first
 * asked, and empties the queue. */
typedef void LightVisitor(const LightRequest *request, void *context);
void lightqueue_visit(LightQueue *queue, LightVisitor *visit, void *context);

#endif
