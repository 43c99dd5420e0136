/* A light has a view of its own, a grid of tiles over the scene with lists as the camera's have.
 * A place lies in shadow if the first thing that the light sees on the way to it is something
 * else: so the same kernels find first hits, at places instead of on a grid. The samples of a
 * tile of the picture lie in few tiles of a light and are tested tile by tile. */
#include "render/rastershadow.h"

#include <stdlib.h>
#include <string.h>

/* Blockers nearer than this to the lit place cast no shadow [docs/POVRAY.md section 3]. */
static const double slack_mm = 1e-3;
/* A point light must be as far from the middle of the scene, in radii of the scene: it sees less
 * than 60 degrees to each side then. */
static const double least_radii = 1.16;
enum { LEAST_SIDE = 16, MOST_SIDE = 512, BLOCK_WORDS = 1 << 18 };

/* The lists of a row of tiles, as in RasterRow, and for each of the lists a depth before which
 * nothing of the item is: spares a look at what is behind. */
typedef struct ShadowRow {
    const uint32_t *offsets, *lists;
    const float *nears;
} ShadowRow;

typedef struct Block {
    struct Block *next;
    uint32_t words[];
} Block;

/* Where a worker puts rows: in few large pieces, for each of which threads wait for one another. */
typedef struct Store {
    Block *blocks;
    size_t used, size; /* words of the first block */
    RasterRow row;     /* the one being made */
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

static double scene_radius(const Scene *scene, Vec3 *center)
{
    *center = box_center(scene->bounds);
    return vec3_distance(*center, scene->bounds.high);
}

bool rastershadow_can(const Scene *scene, const Light *light)
{
    Vec3 center;
    double radius = scene_radius(scene, &center);
    return light->parallel || vec3_distance(light->location, center) > least_radii * radius;
}

static Vec3 corner(const Box *box, int number)
{
    return vec3(number & 1 ? box->high.x : box->low.x, number & 2 ? box->high.y : box->low.y,
                number & 4 ? box->high.z : box->low.z);
}

/* Tiles on a side: about as many tiles as primitives. */
static int tiles_for(const Scene *scene)
{
    double side = sqrt((double)scene->n_primitives);
    return side < LEAST_SIDE ? LEAST_SIDE : side > MOST_SIDE ? MOST_SIDE : (int)side;
}

/* The view of a light, just wide enough for the scene. */
static RasterView light_view(const Scene *scene, const Light *light)
{
    RasterView view = {.location = light->location, .perspective = !light->parallel};
    Vec3 center, towards = vec3_sub(light->target, light->location);
    scene_radius(scene, &center);
    if (!light->parallel)
        towards = vec3_sub(center, light->location);
    view.axes[2] = vec3_normalized(towards);
    Vec3 other = fabs(view.axes[2].x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    view.axes[0] = vec3_normalized(vec3_cross(view.axes[2], other));
    view.axes[1] = vec3_cross(view.axes[0], view.axes[2]);
    Box box = box_empty();
    for (int i = 0; i < 8; i++) {
        Vec3 at = vec3_sub(corner(&scene->bounds, i), light->location);
        at = rasterview_to_frame(&view, at);
        if (view.perspective)
            at = vec3(at.x / at.z, at.y / at.z, at.z);
        box = box_with_ball(box, at, 0);
    }
    int tiles = tiles_for(scene);
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
    if (n > store->size - store->used) {
        size_t size = n > BLOCK_WORDS ? n : BLOCK_WORDS;
        Block *block;
        TRY(mem_calloc(&block, 1, sizeof *block + size * sizeof *block->words, "shadows", NULL));
        block->next = store->blocks;
        store->blocks = block;
        store->used = 0;
        store->size = size;
    }
    *out = store->blocks->words + store->used;
    store->used += n;
    return STATUS_OK;
}

static Status store_row(RasterShadow *shadow, Store *store, size_t row)
{
    const RasterBins *bins = shadow->bins;
    TRY(rasterbins_list(bins, row, &store->row, NULL));
    size_t n_offsets = (size_t)bins->tile_columns + 1, n = store->row.offsets[n_offsets - 1];
    uint32_t *words;
    TRY(take_words(store, n_offsets + 2 * n, &words));
    uint32_t *offsets = words, *lists = words + n_offsets;
    float *nears = (float *)(void *)(lists + n);
    memcpy(offsets, store->row.offsets, n_offsets * sizeof *offsets);
    for (size_t i = 0; i < n; i++) {
        lists[i] = store->row.lists[i];
        const RasterItem *item = &bins->items[lists[i]];
        double deep = (double)item->cosine * (double)item->half + (double)item->radius;
        double near = item->z - deep - bins->view.z_middle;
        nears[i] = (float)(near - 1e-6 * fabs(near));
    }
    shadow->rows[row] = (ShadowRow){offsets, lists, nears};
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
    threads_for(n, shadow->workers, list_row, shadow);
    for (int i = 0; i < shadow->workers; i++) {
        rasterrow_release(&shadow->stores[i].row);
        if (shadow->stores[i].status != STATUS_OK)
            return err_set(err, shadow->stores[i].status, "out of memory: no room for shadows");
    }
    return STATUS_OK;
}

static RasterAim aim_of(const Scene *scene, const RasterView *view, const RasterView *camera)
{
    Vec3 center;
    RasterAim aim = {.perspective = view->perspective,
                     .left = view->left - view->step_x / 2,
                     .top = view->top - view->step_y / 2,
                     .per_x = 1 / (TILE_SIDE * view->step_x),
                     .per_y = 1 / (TILE_SIDE * view->step_y),
                     .columns = view->columns / TILE_SIDE,
                     .rows = view->rows / TILE_SIDE,
                     .z_middle = view->z_middle};
    /* Places and depths are rounded to 2^-24 of the scene's size, thrice. */
    aim.slack = slack_mm + 0x3p-23 * scene_radius(scene, &center);
    for (int i = 0; i < 3; i++)
        aim.axes[i] = rasterview_to_frame(camera, view->axes[i]);
    aim.offset = rasterview_to_frame(view, vec3_sub(camera->location, view->location));
    return aim;
}

Status rastershadow_new(const Scene *scene, const Light *light, const RasterView *camera,
                        int threads, RasterShadow **out, Err *err)
{
    RasterShadow *shadow = NULL;
    TRY(mem_calloc(&shadow, 1, sizeof *shadow, "shadows", err));
    RasterView view = light_view(scene, light);
    shadow->aim = aim_of(scene, &view, camera);
    shadow->grid = rastergrid_make(&view, 0.5, 0.5);
    shadow->workers = threads;
    Status status = rasterbins_new(scene, &view, threads, &shadow->bins, err);
    if (status == STATUS_OK)
        status = list_rows(shadow, err);
    if (status != STATUS_OK) {
        rastershadow_free(shadow);
        return status;
    }
    *out = shadow;
    return STATUS_OK;
}

void rastershadow_free(RasterShadow *shadow)
{
    if (!shadow)
        return;
    for (int i = 0; shadow->stores && i < shadow->workers; i++) {
        rasterrow_release(&shadow->stores[i].row);
        for (Block *block = shadow->stores[i].blocks, *next; block; block = next) {
            next = block->next;
            free(block);
        }
    }
    free(shadow->stores);
    free(shadow->rows);
    rasterbins_free(shadow->bins);
    free(shadow);
}

static void test_tile(const RasterShadow *shadow, const RasterKernels *kernels, int number,
                      RasterProbes *probes)
{
    const RasterBins *bins = shadow->bins;
    int row = number / bins->tile_columns, column = number % bins->tile_columns;
    const ShadowRow *lists = &shadow->rows[row];
    uint32_t first = lists->offsets[column], last = lists->offsets[column + 1];
    RasterTile tile =
        rasterbins_tile(bins, column, row, lists->lists + first, last - first, &shadow->grid);
    tile.nears = lists->nears + first;
    kernels->cover(&tile, probes);
}

void rastershadow_test(const RasterShadow *shadow, const RasterKernels *kernels,
                       const RasterPlaces *places, uint64_t wanted, uint8_t shadowed[TILE_SAMPLES])
{
    RasterSpots spots;
    if (wanted)
        kernels->aim(&shadow->aim, places, &spots);
    while (wanted) {
        RasterProbes probes;
        probes.n = 0;
        int own[TILE_SAMPLES], tile = spots.tile[__builtin_ctzll(wanted)];
        for (uint64_t left = wanted; left; left &= left - 1) {
            int sample = __builtin_ctzll(left);
            if (spots.tile[sample] != tile)
                continue;
            wanted &= ~((uint64_t)1 << sample);
            own[probes.n] = sample;
            probes.x[probes.n] = spots.x[sample];
            probes.y[probes.n] = spots.y[sample];
            probes.z[probes.n++] = spots.z[sample];
        }
        test_tile(shadow, kernels, tile, &probes);
        for (int i = 0; i < probes.n; i++)
            shadowed[own[i]] = probes.covered[i];
    }
}
