/* The tile engine of primitives (cylinders, balls and joints): finds the first hits of the samples
 * of a tile, by the kernels. Shifted passes of antialiasing use the lists of the tiles of the
 * centre samples. The bins therefore hold every item that any sample of a pixel may hit. */
#include "render/engine.h"
#include "render/light/resample.h"
#include "render/raster/rasterbins.h"
#include "render/raster/rasterkernels.h"
#include "render/tile/tilerender.h"
#include <stdlib.h>

/* The primitives in the tiles of an image. All pointers are owned, except `kernels`. */
typedef struct RasterScene {
    RasterBins *bins;
    const RasterKernels *kernels;
    RasterGrid center;
    RasterGrid *shifted; /* n x n, row by row */
    IndexLists *rows;    /* per worker: the items of each tile of a row */
    int workers;
} RasterScene;

/* BatchTile.own */
typedef struct RasterOwn {
    RasterTile tile;
    RasterHits hits;
} RasterOwn;

static void release_raster(void *bins)
{
    RasterScene *scene = bins;
    if (!scene)
        return;
    for (int i = 0; scene->rows && i < scene->workers; i++)
        indexlists_release(&scene->rows[i]);
    free(scene->rows);
    free(scene->shifted);
    rasterbins_free(scene->bins);
    free(scene);
}

/* Sets the positions of the samples: one grid of pixel centres, and one for each shift of the
 * further samples. */
static Status make_grids(const RenderParams *params, const RasterView *view, RasterScene *scene,
                         Err *err)
{
    const Resampling more = resampling_for(params->antialias);
    size_t n = (size_t)more.side;
    scene->center = rastergrid_make(view, 0, 0);
    TRY(mem_calloc(&scene->shifted, n * n, sizeof *scene->shifted, "samples", err));
    for (size_t i = 0; i < n * n; i++)
        scene->shifted[i] = rastergrid_make(view, more.offsets[i % n], more.offsets[i / n]);
    return STATUS_OK;
}

/* Sorts the primitives into the tiles of the picture [TileEngine.bin]. */
static Status bin_raster(const Drawing *drawing, const SampleGrid *grid, void **bins, Err *err)
{
    (void)grid; /* the grid of the centre samples: shifted passes use its tiles */
    Status status;
    const RenderParams *params = drawing->params;
    RasterView view =
        rasterview_of_camera(&drawing->view->camera, drawing->geometry->bounds, params->antialias);
    RasterScene *scene;
    view.hidden = drawing->hidden;
    TRY(mem_calloc(&scene, 1, sizeof *scene, "tiles", err));
    scene->kernels = rasterkernels[kernels_kind(params->kernels)];
    scene->workers = params->threads;
    TRY_GOTO(mem_calloc(&scene->rows, (size_t)scene->workers, sizeof *scene->rows, "tiles", err));
    TRY_GOTO(make_grids(params, &view, scene, err));
    TRY_GOTO(rasterbins_new(drawing->geometry, &view, params->threads, &scene->bins, err));
    *bins = scene;
    return STATUS_OK;
done:
    release_raster(scene);
    return status;
}

/* Lists the primitives of each tile of a row [TileEngine.list]. */
static Status list_raster(void *bins, int row, int worker, Err *err)
{
    RasterScene *scene = bins;
    return rasterbins_list(scene->bins, (size_t)row, &scene->rows[worker], err);
}

static bool is_raster_listed(const void *bins, int column, int worker)
{
    const RasterScene *scene = bins;
    return indexlists_length(&scene->rows[worker], (size_t)column) > 0;
}

/* Sets the position of a tile of the image and its list of items. */
static void place_tile(const RasterScene *scene, int worker, BatchTile *tile)
{
    RasterOwn *own = tile->own;
    const IndexLists *lists = &scene->rows[worker];
    const int column = tile->traced.column / TILE_SIDE, row = tile->traced.row / TILE_SIDE;
    const uint32_t first = lists->first[column];
    own->tile = rasterbins_tile(scene->bins, column, row, lists->items + first,
                                lists->first[column + 1] - first, &scene->center);
    tile->traced.middle_x = own->tile.x;
    tile->traced.middle_y = own->tile.y;
    tile->depth_base = own->tile.z_middle;
}

/* Finds the nearest primitive at each sample of a tile, then depths and normals of these hits
 * [TileEngine.trace]. `shift` is the index of the grid of further samples; negative: the centres.
 * */
static Status trace_raster(void *bins, int worker, int shift, BatchTile *tile, Err *err)
{
    (void)err;
    const RasterScene *scene = bins;
    RasterOwn *own = tile->own;
    place_tile(scene, worker, tile);
    if (shift >= 0)
        own->tile.grid = &scene->shifted[shift];
    tile->traced.x = own->tile.grid->x;
    tile->traced.y = own->tile.grid->y;
    tile->traced.hits = NULL;
    tile->items = own->hits.item;
    if (!scene->kernels->trace(&own->tile, &own->hits, &tile->hits))
        return STATUS_OK;
    scene->kernels->resolve(&own->tile, &own->hits, &tile->hits);
    tile->traced.hits = &tile->hits;
    return STATUS_OK;
}

/* A batch of 64 tiles: its shadow queries fill the vectors of the kernels, and its hits stay in the
 * cache. Results do not depend on it, unlike those of implicit surfaces. */
static const TileEngine raster_tiles = {.either_side = true,
                                        .single_depths = true,
                                        .batch_tiles = 64,
                                        .rows_at_once = 1,
                                        .tile_bytes = sizeof(RasterOwn),
                                        .shadows = &raster_shadows,
                                        .bin = bin_raster,
                                        .release = release_raster,
                                        .list = list_raster,
                                        .is_listed = is_raster_listed,
                                        .trace = trace_raster};

static bool can_draw_raster(const Drawing *drawing)
{
    const Camera *camera = &drawing->view->camera;
    const RenderMethod method = drawing->params->method;
    return drawing->geometry->n_primitives > 0 &&
           (method == RENDER_RASTER ||
            (method == RENDER_FASTEST &&
             rasterbins_supports(drawing->geometry, camera->width, camera->height)));
}

const Engine raster_engine = {.name = "raster",
                              .tiles = &raster_tiles,
                              .supports = can_draw_raster,
                              .prepare = tilerender_prepare,
                              .rows = tilerender_rows,
                              .free = tilerender_free};
