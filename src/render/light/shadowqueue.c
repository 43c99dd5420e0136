/* Collects shadow queries, sorts them by the tiles of a light view, and lets the engine answer them
 * tile by tile.
 *
 * Neighbours in the image are usually neighbours in the light view. The points of one call of
 * shadowqueue_add therefore lie in few tiles of the light view. The points of one call in one tile
 * are consecutive in memory, a run. The runs of a tile form a linked list, from the last run
 * backwards. Only the projected points are stored, so that all queries between two calls of
 * shadowqueue_answer (a batch) fit into the cache. */
#include "render/light/shadowqueue.h"

#include <stdlib.h>
#include <string.h>

/* Points of one call that lie in one tile of the light view. */
typedef struct QueuedRun {
    int first, n; /* the points queued[first] to queued[first + n - 1] */
    int before;   /* index of the previous run of the tile, or -1 */
} QueuedRun;

struct ShadowQueue {
    const LightBins *bins;
    void *workspace; /* of the engine; NULL: none */
    RenderKernels kernels;
    bool has_items; /* the calls of the batch passed the items on which their points lie */
    int n_calls, n_runs, n_tiles;
    uint32_t
        first_answer[SHADOW_BATCH]; /* per call: index in `shadowed` of the answer for point 0 */
    QueuedRun runs[SHADOW_MAX_POINTS];
    int tiles[SHADOW_MAX_POINTS]; /* tiles of the light view that have runs, in the order of their
                                   * first runs */
    ShadowPoints queued, current; /* all points, and those of the tile being answered */
    int *last;                    /* per tile of the light view: its last run, or -1; owned */
};

Status shadowqueue_new(const LightBins *bins, RenderKernels kernels, const bool *hidden,
                       ShadowQueue **out, Err *err)
{
    ShadowQueue *queue;
    size_t n = (size_t)bins->view.tiles * (size_t)bins->view.tiles;
    TRY(mem_alloc(&queue, 1, sizeof *queue, "shadows", err));
    *out = queue;
    queue->bins = bins;
    queue->kernels = kernels;
    queue->n_calls = queue->n_runs = queue->n_tiles = queue->queued.n = 0;
    queue->workspace = NULL;
    queue->last = NULL;
    TRY(mem_calloc(&queue->last, n, sizeof *queue->last, "shadows", err));
    memset(queue->last, -1, n * sizeof *queue->last);
    return bins->engine->begin ? bins->engine->begin(bins, hidden, &queue->workspace, err)
                               : STATUS_OK;
}

void shadowqueue_free(ShadowQueue *queue)
{
    if (!queue)
        return;
    if (queue->bins->engine->end)
        queue->bins->engine->end(queue->workspace);
    free(queue->last);
    free(queue);
}

/* Appends the points whose bits are set, and returns their number. */
static int append_points(ShadowQueue *queue, const ProjectedPoints *projected,
                         const uint32_t *items, uint64_t which)
{
    ShadowPoints *queued = &queue->queued;
    const uint32_t call = (uint32_t)queue->n_calls;
    int first = queued->n, n = first;
    for (; which; which &= which - 1, n++) {
        uint32_t sample = (uint32_t)__builtin_ctzll(which);
        queued->x[n] = projected->x[sample];
        queued->y[n] = projected->y[sample];
        queued->z[n] = projected->z[sample];
        queued->query[n] = TILE_SAMPLES * call + sample;
        if (items)
            queued->item[n] = items[sample];
    }
    queued->n = n;
    return n - first;
}

void shadowqueue_add(ShadowQueue *queue, const HitPoints *points,
                     const uint32_t items[TILE_SAMPLES], uint64_t wanted, uint32_t first_answer)
{
    const TileKernels *kernels = tilekernels[kernels_kind(queue->kernels)];
    ProjectedPoints projected;
    if (!wanted)
        return;
    kernels->project(&queue->bins->aim, points, &projected);
    while (wanted) {
        int tile = projected.tile[__builtin_ctzll(wanted)], n = queue->n_runs++;
        uint64_t within = wanted & kernels->within(&projected, tile);
        if (queue->last[tile] < 0)
            queue->tiles[queue->n_tiles++] = tile;
        QueuedRun *run = &queue->runs[n];
        *run = (QueuedRun){.first = queue->queued.n, .before = queue->last[tile]};
        run->n = append_points(queue, &projected, items, within);
        queue->last[tile] = n;
        wanted &= ~within;
    }
    queue->has_items = items != NULL;
    queue->first_answer[queue->n_calls++] = first_answer;
}

/* Appends n points to `to`. Copies blocks of a fixed size, so up to POINT_PADDING points too many:
 * runs are short, and compilers copy a fixed size without a call. */
static void copy_points(const ShadowPoints *from, int first, int n, bool has_items,
                        ShadowPoints *to)
{
    enum { BLOCK = POINT_PADDING + 1 };
    const int at = to->n;
    for (int i = 0; i < n; i += BLOCK) {
        memcpy(&to->x[at + i], &from->x[first + i], BLOCK * sizeof *to->x);
        memcpy(&to->y[at + i], &from->y[first + i], BLOCK * sizeof *to->y);
        memcpy(&to->z[at + i], &from->z[first + i], BLOCK * sizeof *to->z);
        memcpy(&to->query[at + i], &from->query[first + i], BLOCK * sizeof *to->query);
        if (has_items)
            memcpy(&to->item[at + i], &from->item[first + i], BLOCK * sizeof *to->item);
    }
    to->n = at + n;
}

/* Copies the queued points of a tile to queue->current, and empties the tile's list of runs. */
static void collect_points(ShadowQueue *queue, int tile)
{
    ShadowPoints *current = &queue->current;
    current->n = 0;
    for (int i = queue->last[tile]; i >= 0; i = queue->runs[i].before)
        copy_points(&queue->queued, queue->runs[i].first, queue->runs[i].n, queue->has_items,
                    current);
    if (!queue->has_items)
        memset(current->item, 0xff, (size_t)current->n * sizeof *current->item); /* NO_ITEM */
    queue->last[tile] = -1;
}

Status shadowqueue_answer(ShadowQueue *queue, uint8_t *shadowed, Err *err)
{
    const ShadowPoints *points = &queue->current;
    Status status = STATUS_OK;
    for (int i = 0; i < queue->n_tiles; i++) {
        const TileQueries queries = {.tile = queue->tiles[i],
                                     .next = i + 1 < queue->n_tiles ? queue->tiles[i + 1] : -1,
                                     .kernels = queue->kernels,
                                     .points = &queue->current};
        collect_points(queue, queries.tile); /* also after an error, to empty the tile's list */
        if (status == STATUS_OK)
            status = queue->bins->engine->test(queue->bins, queue->workspace, &queries, err);
        for (int k = 0; k < points->n && status == STATUS_OK; k++)
            shadowed[queue->first_answer[points->query[k] / TILE_SAMPLES] +
                     points->query[k] % TILE_SAMPLES] = points->state[k];
    }
    queue->n_calls = queue->n_runs = queue->n_tiles = queue->queued.n = 0;
    return status;
}
