/* A light has a view of its own, a grid of tiles over the scene with lists as the camera's have.
 * A place lies in shadow if the first thing that the light sees on the way to it is something
 * else: so the same kernels find first hits, at places instead of on a grid. The places of many
 * tiles of the picture are asked about together, and tested tile by tile of the light. Lists hold
 * boxes and depths, several of which are compared with those of the places at once: few items are
 * left to be looked at, and memory is asked for them and for the next list ahead. */
#include "render/raster/rastershadow.h"

#include <stdlib.h>
#include <string.h>

/* Blockers nearer than this to the lit place cast no shadow [docs/POVRAY.md section 3]. */
static const double slack_mm = 1e-3;
/* RasterKernels.cover reads up to as many words from a list's end on. */
enum { MOST_LANES = 16 };
/* What is asked of memory ahead of its use: the beginning of the next list. */
enum { LINE_WORDS = 16, MOST_FETCHED = 8 * LINE_WORDS };
enum { LEAST_SIDE = 16, MOST_SIDE = 512, SLAB_WORDS = 1 << 18 };

/* The lists of a row of tiles. That of column i, of n = offsets[i + 1] - offsets[i] items, begins
 * at words[3 offsets[i]]: n items, their boxes, as RasterBox but in this tile, and the floats of
 * their RasterBox.near. */
typedef struct ShadowRow {
    const uint32_t *offsets, *words;
} ShadowRow;

/* Where a worker puts rows: in few large pieces, for each of which threads wait for one another. */
typedef struct Store {
    Slabs slabs;
    uint32_t *taken; /* items that each column of the row being made has */
    Status status;
} Store;

struct RasterShadow {
    RasterBins *bins;
    RasterGrid grid;
    ShadowRow *rows;
    Store *stores; /* one a worker */
    int workers;
    LightAim aim;
};

/* Tiles on a side: about sixteen primitives a tile. */
static int tiles_for(const Geometry *geometry)
{
    double side = sqrt((double)rasterbins_items(geometry)) / 3;
    return side < LEAST_SIDE ? LEAST_SIDE : side > MOST_SIDE ? MOST_SIDE : (int)side;
}

static RasterView view_of(const LightView *light)
{
    return (RasterView){.eye = light->eye,
                        .light = true,
                        .columns = light->tiles * TILE_SIDE,
                        .rows = light->tiles * TILE_SIDE,
                        .listed_columns = light->columns,
                        .listed_rows = light->rows,
                        .stray = 0.5,
                        .step_x = light->step_x,
                        .step_y = light->step_y,
                        .left = light->left,
                        .top = light->top,
                        .z_middle = light->z_middle};
}

static Status take_words(Store *store, size_t n, uint32_t **out)
{
    *out = slabs_take(&store->slabs, n * sizeof **out, SLAB_WORDS * sizeof **out);
    return *out ? STATUS_OK : STATUS_MEMORY;
}

static Status store_row(RasterShadow *shadow, Store *store, size_t row)
{
    const RasterBins *bins = shadow->bins;
    size_t columns = (size_t)bins->tile_columns;
    uint32_t *offsets, *words;
    TRY(take_words(store, columns + 1, &offsets));
    TRY(rasterbins_count(bins, row, offsets, NULL));
    TRY(take_words(store, 3 * (size_t)offsets[columns] + MOST_LANES, &words));
    memset(store->taken, 0, columns * sizeof *store->taken);
    for (size_t i = bins->row_offsets[row]; i < bins->row_offsets[row + 1]; i++) {
        const RasterTiles span = bins->row_columns[i];
        const RasterBox *box = &bins->row_boxes[i];
        for (int column = span.first; column <= span.last; column++) {
            size_t n = offsets[column + 1] - offsets[column];
            uint32_t *place = words + 3 * (size_t)offsets[column] + store->taken[column]++;
            place[0] = bins->row_items[i];
            place[n] = box->box | (column < span.last ? RASTERBOX_HIGH_X : 0) |
                       (column > span.first ? RASTERBOX_LOW_X : 0);
            memcpy(&place[2 * n], &box->near, sizeof box->near);
        }
    }
    shadow->rows[row] = (ShadowRow){offsets, words};
    return STATUS_OK;
}

static void list_row(size_t row, int worker, void *context)
{
    RasterShadow *shadow = context;
    Store *store = &shadow->stores[worker];
    if (store->status == STATUS_OK)
        store->status = store_row(shadow, store, row);
}

static Status list_rows(RasterShadow *shadow, Err *err)
{
    size_t n = (size_t)shadow->bins->tile_rows;
    TRY(mem_calloc(&shadow->rows, n, sizeof *shadow->rows, "rows of tiles", err));
    TRY(mem_calloc(&shadow->stores, (size_t)shadow->workers, sizeof *shadow->stores, "shadows",
                   err));
    for (int i = 0; i < shadow->workers; i++)
        TRY(mem_calloc(&shadow->stores[i].taken, (size_t)shadow->bins->tile_columns,
                       sizeof *shadow->stores[i].taken, "shadows", err));
    threads_for(n, shadow->workers, list_row, shadow);
    rasterbins_forget_rows(shadow->bins);
    for (int i = 0; i < shadow->workers; i++)
        if (shadow->stores[i].status != STATUS_OK)
            return err_set(err, shadow->stores[i].status, "out of memory: no room for shadows");
    return STATUS_OK;
}

/* For places in a box of the world; `asked` NULL: anywhere. */
static Status make_shadow(const Geometry *geometry, const Light *light, const Viewpoint *camera,
                          const Box *asked, int threads, RasterShadow **out, Err *err)
{
    RasterShadow *shadow = NULL;
    TRY(mem_calloc(&shadow, 1, sizeof *shadow, "shadows", err));
    LightView seen = lightview_of(geometry, light, tiles_for(geometry), asked);
    RasterView view = view_of(&seen);
    /* Places and depths are rounded to 2^-24 of the scene's size, thrice. */
    double slack = slack_mm + 0x3p-23 * lightview_radius(geometry);
    shadow->aim = lightview_aim(&seen, camera, slack);
    shadow->grid = rastergrid_make(&view, 0.5, 0.5);
    shadow->workers = threads;
    Status status = rasterbins_new(geometry, &view, threads, &shadow->bins, err);
    if (status == STATUS_OK)
        status = list_rows(shadow, err);
    if (status != STATUS_OK) {
        rastershadow_free(shadow);
        return status;
    }
    *out = shadow;
    return STATUS_OK;
}

typedef struct Making {
    const Geometry *geometry;
    const Viewpoint *camera;
    const Light *light;
    RasterShadow **out;
    Status status;
    Err err;
} Making;

static void make_alone(size_t index, int worker, void *context)
{
    (void)worker;
    Making *making = (Making *)context + index;
    making->status = make_shadow(making->geometry, making->light, making->camera, NULL, 1,
                                 making->out, &making->err);
}

static Status make_shadows(Making *making, size_t n, int threads, Err *err)
{
    /* A thread for each light, but for those lights that would keep some threads waiting. */
    size_t alone = n;
    if (!rasterbins_are_small(making->geometry))
        alone -= n % (size_t)threads;
    threads_for(alone, threads, make_alone, making);
    for (size_t i = 0; i < alone; i++)
        if (making[i].status != STATUS_OK) {
            if (err)
                *err = making[i].err;
            return making[i].status;
        }
    for (size_t i = alone; i < n; i++)
        TRY(make_shadow(making[i].geometry, making[i].light, making[i].camera, NULL, threads,
                        making[i].out, err));
    return STATUS_OK;
}

Status rastershadows_new(const Geometry *geometry, const View *view, const Viewpoint *camera,
                         int threads, RasterShadow **shadows, Err *err)
{
    Making *making = NULL;
    size_t n = 0;
    TRY(mem_calloc(&making, view->n_lights, sizeof *making, "lights", err));
    for (size_t i = 0; i < view->n_lights; i++) {
        const Light *light = &view->lights[i];
        shadows[i] = NULL;
        if (light->casts_shadows && light->samples <= 1 &&
            lightview_sees_all(geometry, view, light))
            making[n++] = (Making){
                .geometry = geometry, .camera = camera, .light = light, .out = &shadows[i]};
    }
    Status status = n > 0 ? make_shadows(making, n, threads, err) : STATUS_OK;
    free(making);
    return status;
}

bool rastershadows_need_rays(const Geometry *geometry, const View *view)
{
    for (size_t i = 0; i < view->n_lights; i++)
        if (view->lights[i].casts_shadows &&
            !lightviews_can(&raster_lights, geometry, view, &view->lights[i]))
            return true;
    return false;
}

void rastershadow_free(RasterShadow *shadow)
{
    if (!shadow)
        return;
    for (int i = 0; shadow->stores && i < shadow->workers; i++) {
        free(shadow->stores[i].taken);
        slabs_release(&shadow->stores[i].slabs);
    }
    free(shadow->stores);
    free(shadow->rows);
    rasterbins_free(shadow->bins);
    free(shadow);
}

/* ---- asking ---------------------------------------------------------------------------------- */

struct RasterQueue {
    const RasterShadow *shadow;
    ShadowQueue *places;
    const uint32_t *items[SHADOW_BATCH]; /* of each call; NULL in all of them: not known */
    uint32_t answer[SHADOW_BATCH];
    const RasterKernels *kernels;
    uint8_t *shadowed;
    ShadowQueries queries;
};

Status rasterqueue_new(const RasterShadow *shadow, RasterQueue **out, Err *err)
{
    TRY(mem_calloc(out, 1, sizeof **out, "shadows", err));
    (*out)->shadow = shadow;
    return shadowqueue_new(&shadow->aim, &(*out)->places, err);
}

void rasterqueue_free(RasterQueue *queue)
{
    if (!queue)
        return;
    shadowqueue_free(queue->places);
    free(queue);
}

void rasterqueue_ask(RasterQueue *queue, const TileKernels *kernels, const SeenPlaces *places,
                     const uint32_t items[TILE_SAMPLES], uint64_t wanted, uint32_t answer)
{
    if (!wanted)
        return;
    int call = shadowqueue_ask(queue->places, kernels, places, wanted);
    queue->items[call] = items;
    queue->answer[call] = answer;
}

/* A tile of the light with its list. */
static RasterTile tile_of(const RasterShadow *shadow, int number)
{
    const RasterBins *bins = shadow->bins;
    int row = number / bins->tile_columns, column = number % bins->tile_columns;
    const uint32_t *offsets = shadow->rows[row].offsets + column;
    const uint32_t *list = shadow->rows[row].words + 3 * (size_t)offsets[0];
    size_t n = offsets[1] - offsets[0];
    RasterTile tile = rasterbins_tile(bins, column, row, list, n, &shadow->grid);
    tile.nears = (const float *)(const void *)(list + 2 * n);
    return tile;
}

static void fetch_list(const RasterShadow *shadow, int number)
{
    RasterTile tile = tile_of(shadow, number);
    for (size_t word = 0; word < 3 * tile.n && word < MOST_FETCHED; word += LINE_WORDS)
        __builtin_prefetch(tile.list + word);
}

static void set_queries(RasterQueue *queue, const TileQueries *request)
{
    ShadowQueries *queries = &queue->queries;
    QueuedPoints *places = request->places;
    queries->x = places->x;
    queries->y = places->y;
    queries->n = request->n;
    for (int i = 0; i < request->n; i++)
        queries->z[i] = (float)places->z[i];
    if (queue->items[0])
        for (int i = 0; i < request->n; i++)
            queries->item[i] =
                queue->items[places->from[i] / TILE_SAMPLES][places->from[i] % TILE_SAMPLES];
    else
        memset(queries->item, 0xff,
               (size_t)request->n * sizeof *queries->item); /* RASTER_NOTHING */
}

static void test_tile(const TileQueries *request, void *context)
{
    RasterQueue *queue = context;
    ShadowQueries *queries = &queue->queries;
    RasterTile tile = tile_of(queue->shadow, request->tile);
    if (request->next >= 0)
        fetch_list(queue->shadow, request->next);
    set_queries(queue, request);
    queue->kernels->cover(&tile, queries);
    uint8_t *shadowed = queue->shadowed;
    for (int i = 0; i < request->n; i++) {
        uint32_t from = request->places->from[i];
        shadowed[queue->answer[from / TILE_SAMPLES] + from % TILE_SAMPLES] = queries->covered[i];
    }
}

void rasterqueue_answer(RasterQueue *queue, const RasterKernels *kernels, uint8_t *shadowed)
{
    queue->kernels = kernels;
    queue->shadowed = shadowed;
    shadowqueue_visit(queue->places, test_tile, queue);
}

/* ---- for those who ask by places alone ------------------------------------------------------- */

static Status look(const Drawing *drawing, const Light *light, const Viewpoint *frame,
                   const Box *asked, void **shadow, Err *err)
{
    RasterShadow *made;
    TRY(make_shadow(drawing->geometry, light, frame, asked, drawing->params->threads, &made, err));
    *shadow = made;
    return STATUS_OK;
}

static void free_shadow(void *shadow)
{
    rastershadow_free(shadow);
}

static Status new_queue(const void *shadow, const bool *hidden, void **queue, Err *err)
{
    (void)hidden; /* surfaces of primitives are the same with and without others */
    RasterQueue *made = NULL;
    Status status = rasterqueue_new(shadow, &made, err);
    *queue = made;
    return status;
}

static void free_queue(void *queue)
{
    rasterqueue_free(queue);
}

static void ask(void *queue, const TileKernels *kernels, const SeenPlaces *places, uint64_t wanted,
                uint32_t answer)
{
    rasterqueue_ask(queue, kernels, places, NULL, wanted, answer);
}

static Status answer(void *queue, RenderKernels kernels, uint8_t *shadowed, Err *err)
{
    (void)err;
    rasterqueue_answer(queue, rasterkernels[kernels_kind(kernels)], shadowed);
    return STATUS_OK;
}

const LightViews raster_lights = {.can = lightview_sees_all,
                                  .look = look,
                                  .free = free_shadow,
                                  .queue_new = new_queue,
                                  .queue_free = free_queue,
                                  .ask = ask,
                                  .answer = answer};
