/* Each tile of the light has a chain of requests, each for those places of one tile of the picture
 * that lie in it: few, as neighbours in the picture mostly are neighbours in the light's view. The
 * places of a request lie side by side in memory, and nothing else is kept of the picture's tile:
 * a batch stays in the cache. */
#include "render/light/shadowqueue.h"

#include <stdlib.h>
#include <string.h>

/* Places of one tile of the picture that lie in one tile of the light. */
typedef struct Request {
    int first, n; /* of those asked */
    int before;   /* the request before it in the tile of the light, or -1 */
} Request;

struct ShadowQueue {
    LightAim aim;
    int n_calls, n_requests, n_tiles, n_asked;
    Request requests[SHADOW_MAX_POINTS];
    int tiles[SHADOW_MAX_POINTS]; /* of the light, that are asked, in the order of their first
                                   * request */
    QueuedPoints asked;
    QueuedPoints taken; /* of the tile that is shown */
    int *last;          /* of each tile of the light, the last request there, or -1 */
};

Status shadowqueue_new(const LightAim *aim, ShadowQueue **out, Err *err)
{
    ShadowQueue *queue;
    size_t n = (size_t)aim->columns * (size_t)aim->rows;
    TRY(mem_alloc(&queue, 1, sizeof *queue, "shadows", err));
    *out = queue;
    queue->aim = *aim;
    queue->n_calls = queue->n_requests = queue->n_tiles = queue->n_asked = 0;
    queue->last = NULL;
    TRY(mem_calloc(&queue->last, n, sizeof *queue->last, "shadows", err));
    memset(queue->last, -1, n * sizeof *queue->last);
    return STATUS_OK;
}

void shadowqueue_free(ShadowQueue *queue)
{
    if (!queue)
        return;
    free(queue->last);
    free(queue);
}

/* Asks about the places whose bits are set, and returns how many they are. */
static int append_places(ShadowQueue *queue, const AimedPlaces *aimed, int call, uint64_t places)
{
    QueuedPoints *asked = &queue->asked;
    int first = queue->n_asked, n = first;
    for (; places; places &= places - 1, n++) {
        int sample = __builtin_ctzll(places);
        asked->x[n] = aimed->x[sample];
        asked->y[n] = aimed->y[sample];
        asked->z[n] = aimed->z[sample];
        asked->from[n] = (uint32_t)(TILE_SAMPLES * call + sample);
    }
    queue->n_asked = n;
    return n - first;
}

int shadowqueue_ask(ShadowQueue *queue, const TileKernels *kernels, const SeenPlaces *places,
                    uint64_t wanted)
{
    int call = queue->n_calls++;
    AimedPlaces aimed;
    kernels->aim(&queue->aim, places, &aimed);
    while (wanted) {
        int tile = aimed.tile[__builtin_ctzll(wanted)], n = queue->n_requests++;
        uint64_t within = wanted & kernels->within(&aimed, tile);
        if (queue->last[tile] < 0)
            queue->tiles[queue->n_tiles++] = tile;
        Request *request = &queue->requests[n];
        *request = (Request){.first = queue->n_asked, .before = queue->last[tile]};
        request->n = append_places(queue, &aimed, call, within);
        queue->last[tile] = n;
        wanted &= ~within;
    }
    return call;
}

/* Copies n places, and up to POINT_PADDING more: in blocks of one size, which compilers copy
 * without a call, as requests are small. */
static void copy_places(const QueuedPoints *from, int first, int n, QueuedPoints *to, int at)
{
    enum { BLOCK = POINT_PADDING + 1 };
    for (int i = 0; i < n; i += BLOCK) {
        memcpy(&to->x[at + i], &from->x[first + i], BLOCK * sizeof *to->x);
        memcpy(&to->y[at + i], &from->y[first + i], BLOCK * sizeof *to->y);
        memcpy(&to->z[at + i], &from->z[first + i], BLOCK * sizeof *to->z);
        memcpy(&to->from[at + i], &from->from[first + i], BLOCK * sizeof *to->from);
    }
}

/* Collects what a tile is asked, and forgets it. */
static int take_places(ShadowQueue *queue, int tile)
{
    int n = 0;
    for (int i = queue->last[tile]; i >= 0; i = queue->requests[i].before) {
        const Request *request = &queue->requests[i];
        copy_places(&queue->asked, request->first, request->n, &queue->taken, n);
        n += request->n;
    }
    queue->last[tile] = -1;
    return n;
}

void shadowqueue_visit(ShadowQueue *queue, LightVisitor *visit, void *context)
{
    for (int i = 0; i < queue->n_tiles; i++) {
        TileQueries request = {.tile = queue->tiles[i],
                               .next = i + 1 < queue->n_tiles ? queue->tiles[i + 1] : -1,
                               .places = &queue->taken,
                               .n = take_places(queue, queue->tiles[i])};
        visit(&request, context);
    }
    queue->n_calls = queue->n_requests = queue->n_tiles = queue->n_asked = 0;
}
