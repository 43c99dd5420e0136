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
/* A point light must be as far from the middle of the scene, in radii of the scene: it sees less
 * than 60 degrees to each side then. */
static const double least_radii = 1.16;
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
    RasterAim aim;
};

static double geometry_radius(const Geometry *geometry, Vec3 *center)
{
    *center = box_center(geometry->bounds);
    return vec3_distance(*center, geometry->bounds.high);
}

static bool sees_all(const Geometry *geometry, const Light *light)
{
    Vec3 center;
    double radius = geometry_radius(geometry, &center);
    return light->parallel || vec3_distance(light->location, center) > least_radii * radius;
}

static Vec3 corner(const Box *box, int number)
{
    return vec3(number & 1 ? box->high.x : box->low.x, number & 2 ? box->high.y : box->low.y,
                number & 4 ? box->high.z : box->low.z);
}

/* Tiles on a side: about sixteen primitives a tile. */
static int tiles_for(const Geometry *geometry)
{
    double side = sqrt((double)rasterbins_items(geometry)) / 3;
    return side < LEAST_SIDE ? LEAST_SIDE : side > MOST_SIDE ? MOST_SIDE : (int)side;
}

/* The view of a light, just wide enough for the scene. */
static RasterView light_view(const Geometry *geometry, const Light *light)
{
    RasterView view = {.eye = {.location = light->location, .perspective = !light->parallel},
                       .light = true};
    Vec3 center, towards = vec3_sub(light->target, light->location);
    geometry_radius(geometry, &center);
    if (!light->parallel)
        towards = vec3_sub(center, light->location);
    view.eye.axes[2] = vec3_normalized(towards);
    Vec3 other = fabs(view.eye.axes[2].x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    view.eye.axes[0] = vec3_normalized(vec3_cross(view.eye.axes[2], other));
    view.eye.axes[1] = vec3_cross(view.eye.axes[0], view.eye.axes[2]);
    Box box = box_empty();
    for (int i = 0; i < 8; i++) {
        Vec3 at = vec3_sub(corner(&geometry->bounds, i), light->location);
        at = viewpoint_to_frame(&view.eye, at);
        if (view.eye.perspective)
            at = vec3(at.x / at.z, at.y / at.z, at.z);
        box = box_with_ball(box, at, 0);
    }
    int tiles = tiles_for(geometry);
    view.columns = view.rows = tiles * TILE_SIDE;
    view.stray = 0.5;
    view.step_x = (box.high.x - box.low.x) * 1.0001 / view.columns;
    view.step_y = -(box.high.y - box.low.y) * 1.0001 / view.rows;
    view.left = (box.low.x + box.high.x) / 2 - (view.columns - 1) / 2.0 * view.step_x;
    view.top = (box.low.y + box.high.y) / 2 - (view.rows - 1) / 2.0 * view.step_y;
    view.z_middle = (box.low.z + box.high.z) / 2;
    return view;
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

static RasterAim aim_of(const Geometry *geometry, const RasterView *view, const RasterView *camera)
{
    Vec3 center;
    RasterAim aim = {.perspective = view->eye.perspective,
                     .left = view->left - view->step_x / 2,
                     .top = view->top - view->step_y / 2,
                     .per_x = 1 / (TILE_SIDE * view->step_x),
                     .per_y = 1 / (TILE_SIDE * view->step_y),
                     .columns = view->columns / TILE_SIDE,
                     .rows = view->rows / TILE_SIDE,
                     .z_middle = view->z_middle};
    /* Places and depths are rounded to 2^-24 of the scene's size, thrice. */
    aim.slack = slack_mm + 0x3p-23 * geometry_radius(geometry, &center);
    for (int i = 0; i < 3; i++)
        aim.axes[i] = viewpoint_to_frame(&camera->eye, view->eye.axes[i]);
    aim.offset = viewpoint_place(&view->eye, camera->eye.location);
    return aim;
}

static Status make_shadow(const Geometry *geometry, const Light *light, const RasterView *camera,
                          int threads, RasterShadow **out, Err *err)
{
    RasterShadow *shadow = NULL;
    TRY(mem_calloc(&shadow, 1, sizeof *shadow, "shadows", err));
    RasterView view = light_view(geometry, light);
    shadow->aim = aim_of(geometry, &view, camera);
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
    const RasterView *camera;
    const Light *light;
    RasterShadow **out;
    Status status;
    Err err;
} Making;

static void make_alone(size_t index, int worker, void *context)
{
    (void)worker;
    Making *making = (Making *)context + index;
    making->status =
        make_shadow(making->geometry, making->light, making->camera, 1, making->out, &making->err);
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
        TRY(make_shadow(making[i].geometry, making[i].light, making[i].camera, threads,
                        making[i].out, err));
    return STATUS_OK;
}

Status rastershadows_new(const Geometry *geometry, const View *view, const RasterView *camera,
                         int threads, RasterShadow **shadows, Err *err)
{
    Making *making = NULL;
    size_t n = 0;
    TRY(mem_calloc(&making, view->n_lights, sizeof *making, "lights", err));
    for (size_t i = 0; i < view->n_lights; i++) {
        const Light *light = &view->lights[i];
        shadows[i] = NULL;
        if (light->casts_shadows && light->samples <= 1 && sees_all(geometry, light))
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
            (view->lights[i].samples > 1 || !sees_all(geometry, &view->lights[i])))
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

/* Places of one tile of the picture that lie in one tile of the light. */
typedef struct Request {
    uint64_t places; /* as bits */
    int tile;        /* of the picture: its number in the queue */
    int before;      /* the request before it in the tile of the light, or -1 */
} Request;

struct RasterQueue {
    const RasterShadow *shadow;
    int n; /* tiles of the picture */
    AimedPlaces aimed[RASTER_BATCH];
    const uint32_t *items[RASTER_BATCH];
    uint32_t answer[RASTER_BATCH];
    Request requests[MOST_QUERIES];
    int n_requests, n_tiles;
    int tiles[MOST_QUERIES]; /* of the light, that are asked, in the order of their first request */
    int *last;               /* of each tile of the light, the last request there, or -1 */
    ShadowQueries queries;
};

Status rasterqueue_new(const RasterShadow *shadow, RasterQueue **out, Err *err)
{
    RasterQueue *queue;
    size_t n = (size_t)shadow->bins->tile_columns * (size_t)shadow->bins->tile_rows;
    TRY(mem_calloc(&queue, 1, sizeof *queue, "shadows", err));
    *out = queue;
    queue->shadow = shadow;
    queue->queries.aimed = queue->aimed;
    TRY(mem_calloc(&queue->last, n, sizeof *queue->last, "shadows", err));
    memset(queue->last, -1, n * sizeof *queue->last);
    return STATUS_OK;
}

void rasterqueue_free(RasterQueue *queue)
{
    if (!queue)
        return;
    free(queue->last);
    free(queue);
}

void rasterqueue_ask(RasterQueue *queue, const RasterKernels *kernels, const RasterPlaces *places,
                     const uint32_t items[TILE_SAMPLES], uint64_t wanted, uint32_t answer)
{
    if (!wanted)
        return;
    int number = queue->n++;
    AimedPlaces *aimed = &queue->aimed[number];
    kernels->aim(&queue->shadow->aim, places, aimed);
    queue->items[number] = items;
    queue->answer[number] = answer;
    while (wanted) {
        int tile = aimed->tile[__builtin_ctzll(wanted)], n = queue->n_requests++;
        uint64_t within = wanted & kernels->within(aimed, tile);
        if (queue->last[tile] < 0)
            queue->tiles[queue->n_tiles++] = tile;
        queue->requests[n] = (Request){within, number, queue->last[tile]};
        queue->last[tile] = n;
        wanted &= ~within;
    }
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
    for (size_t word = 0; word < 3 * n && word < MOST_FETCHED; word += LINE_WORDS)
        __builtin_prefetch(list + word);
    return tile;
}

static void add_queries(RasterQueue *queue, const RasterTile *tile, const Request *request)
{
    ShadowQueries *queries = &queue->queries;
    const AimedPlaces *aimed = &queue->aimed[request->tile];
    const uint32_t *items = queue->items[request->tile];
    for (uint64_t places = request->places; places; places &= places - 1) {
        int place = __builtin_ctzll(places), n = queries->n++;
        queries->place[n] = (uint32_t)(request->tile * TILE_SAMPLES + place);
        queries->x[n] = (float)(aimed->x[place] - tile->x);
        queries->y[n] = (float)(aimed->y[place] - tile->y);
        queries->z[n] = aimed->z[place];
        queries->item[n] = items[place];
    }
}

static void test_tile(RasterQueue *queue, const RasterKernels *kernels, const RasterTile *tile,
                      int last, uint8_t *shadowed)
{
    ShadowQueries *queries = &queue->queries;
    queries->n = 0;
    for (int i = last; i >= 0; i = queue->requests[i].before)
        add_queries(queue, tile, &queue->requests[i]);
    kernels->cover(tile, queries);
    for (int i = 0; i < queries->n; i++) {
        uint32_t place = queries->place[i];
        shadowed[queue->answer[place / TILE_SAMPLES] + place % TILE_SAMPLES] = queries->covered[i];
    }
}

void rasterqueue_answer(RasterQueue *queue, const RasterKernels *kernels, uint8_t *shadowed)
{
    RasterTile next = {0};
    if (queue->n_tiles > 0)
        next = tile_of(queue->shadow, queue->tiles[0]);
    for (int i = 0; i < queue->n_tiles; i++) {
        RasterTile tile = next;
        int *last = &queue->last[queue->tiles[i]];
        if (i + 1 < queue->n_tiles)
            next = tile_of(queue->shadow, queue->tiles[i + 1]);
        test_tile(queue, kernels, &tile, *last, shadowed);
        *last = -1;
    }
    queue->n = queue->n_requests = queue->n_tiles = 0;
}
