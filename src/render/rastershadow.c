/* A light has a view of its own, a grid of tiles over the scene with lists as the camera's have.
 * A place lies in shadow if the first thing that the light sees on the way to it is something
 * else: so the same kernels find first hits, at places instead of on a grid. The samples of a
 * tile of the picture lie in few tiles of a light and are tested tile by tile. */
#include "render/rastershadow.h"

#include <stdlib.h>

/* Blockers nearer than this to the lit place cast no shadow [docs/POVRAY.md section 3]. */
static const double slack_mm = 1e-3;
/* A point light must be as far from the middle of the scene, in radii of the scene: it sees less
 * than 60 degrees to each side then. */
static const double least_radii = 1.16;
enum { LEAST_SIDE = 16, MOST_SIDE = 512 };

struct RasterShadow {
    RasterBins *bins;
    RasterGrid grid;
    RasterRow *rows;
    float **nears; /* row by row, one for each of the lists: spares a look at what is behind */
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

typedef struct Lister {
    RasterShadow *shadow;
    Status *status; /* one a row */
} Lister;

static Status find_nears(RasterShadow *shadow, size_t row)
{
    const RasterRow *lists = &shadow->rows[row];
    size_t n = lists->offsets[shadow->bins->tile_columns];
    TRY(mem_calloc(&shadow->nears[row], n, sizeof **shadow->nears, "shadows", NULL));
    for (size_t i = 0; i < n; i++) {
        const RasterItem *item = &shadow->bins->items[lists->lists[i]];
        double deep = (double)item->cosine * (double)item->half + (double)item->radius;
        double near = item->z - deep - shadow->bins->view.z_middle;
        shadow->nears[row][i] = (float)(near - 1e-6 * fabs(near));
    }
    return STATUS_OK;
}

static void list_row(size_t row, int worker, void *context)
{
    (void)worker;
    const Lister *lister = context;
    RasterShadow *shadow = lister->shadow;
    lister->status[row] = rasterbins_list(shadow->bins, row, &shadow->rows[row], NULL);
    free(shadow->rows[row].spans);
    shadow->rows[row].spans = NULL;
    if (lister->status[row] == STATUS_OK)
        lister->status[row] = find_nears(shadow, row);
}

static Status list_rows(RasterShadow *shadow, int threads, Err *err)
{
    size_t n = (size_t)shadow->bins->tile_rows;
    Lister lister = {.shadow = shadow};
    TRY(mem_calloc(&shadow->rows, n, sizeof *shadow->rows, "rows of tiles", err));
    TRY(mem_calloc(&shadow->nears, n, sizeof *shadow->nears, "rows of tiles", err));
    TRY(mem_calloc(&lister.status, n, sizeof *lister.status, "rows of tiles", err));
    threads_for(n, threads, list_row, &lister);
    Status status = STATUS_OK;
    for (size_t i = 0; i < n && status == STATUS_OK; i++)
        status = lister.status[i];
    free(lister.status);
    return status == STATUS_OK ? status
                               : err_set(err, status, "out of memory: no room for shadows");
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
    Status status = rasterbins_new(scene, &view, threads, &shadow->bins, err);
    if (status == STATUS_OK)
        status = list_rows(shadow, threads, err);
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
    for (int i = 0; shadow->rows && i < shadow->bins->tile_rows; i++)
        rasterrow_release(&shadow->rows[i]);
    for (int i = 0; shadow->nears && i < shadow->bins->tile_rows; i++)
        free(shadow->nears[i]);
    free(shadow->rows);
    free(shadow->nears);
    rasterbins_free(shadow->bins);
    free(shadow);
}

static void test_tile(const RasterShadow *shadow, const RasterKernels *kernels, int number,
                      RasterProbes *probes)
{
    const RasterBins *bins = shadow->bins;
    int row = number / bins->tile_columns, column = number % bins->tile_columns;
    const RasterRow *lists = &shadow->rows[row];
    uint32_t first = lists->offsets[column], last = lists->offsets[column + 1];
    RasterTile tile =
        rasterbins_tile(bins, column, row, lists->lists + first, last - first, &shadow->grid);
    tile.nears = shadow->nears[row] + first;
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
