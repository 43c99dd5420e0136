/* The shadow engine of primitives: answers shadow queries for points in a tile of a light view.
 *
 * A point is in shadow if the line from the light to it enters a primitive before it reaches the
 * point. The functions that find the first hits of samples on a grid therefore also answer shadow
 * queries, at arbitrary points.
 *
 * The list of a tile holds the indices of the primitives, their boxes in the tile, and their
 * depths. Several boxes are compared with the points at once, so that few primitives remain to be
 * tested. Memory is prefetched for these primitives and for the list of the next tile. */
#include "render/raster/rasterbins.h"
#include "render/raster/rasterkernels.h"
#include <stdlib.h>
#include <string.h>

/* RasterKernels.cover reads up to this many words past the end of a list. */
enum { MAX_LANES = 16 };
/* Words of a cache line, and maximum number of words of the next list that are prefetched: 8 lines
 * hold a list of 42 primitives, more than twice the usual number [tiles_for_primitives]. */
enum { LINE_WORDS = 16, MAX_PREFETCHED = 8 * LINE_WORDS };
/* Minimum and maximum number of tiles along a side of a light view. MAX_SIDE bounds the memory of
 * the lists; with more than 2.4 million primitives, lists therefore become longer. MIN_SIDE keeps
 * lists short in scenes of few primitives. */
enum { MIN_SIDE = 16, MAX_SIDE = 512 };
/* Words of a slab of memory: 1 MB, so that threads seldom need a new one. */
enum { SLAB_WORDS = 1 << 18 };

/* The lists of a row of tiles. The list of column i has n = offsets[i + 1] - offsets[i] items. It
 * begins at words[3 offsets[i]]: n items, their n boxes as RasterBox.box but for this tile, and the
 * n floats RasterBox.near. */
typedef struct ListedRow {
    const uint32_t *offsets, *words;
} ListedRow;

/* Where a worker stores rows: few large slabs, because threads wait for one another to get one. */
typedef struct RowStore {
    Slabs slabs;
    uint32_t *taken; /* per column: number of items stored in the row being made; owned */
} RowStore;

/* The primitives in the tiles of a light view. All arrays are owned. */
typedef struct RasterLists {
    RasterBins *bins;
    RasterGrid grid;
    ListedRow *rows;
    RowStore *stores; /* one per worker */
    int workers;
} RasterLists;

/* ---- making lists ---------------------------------------------------------------------------- */

/* Returns the view of a light, whose queries may lie anywhere in a pixel. */
static RasterView view_of(const LightView *light)
{
    return (RasterView){.eye = light->eye,
                        .light = true,
                        .columns = light->tiles * TILE_SIDE,
                        .rows = light->tiles * TILE_SIDE,
                        .listed_columns = light->columns,
                        .listed_rows = light->rows,
                        .max_offset = 0.5,
                        .step_x = light->step_x,
                        .step_y = light->step_y,
                        .left = light->left,
                        .top = light->top,
                        .z_middle = light->z_middle};
}

static Status take_words(RowStore *store, size_t n, uint32_t **out, Err *err)
{
    *out = slabs_alloc(&store->slabs, n * sizeof **out, SLAB_WORDS * sizeof **out);
    return *out ? STATUS_OK : mem_out_of("for", "shadows", err);
}

/* Makes the lists of a row of tiles. */
static Status list_boxes_of_row(size_t row, int worker, void *context, Err *err)
{
    RasterLists *lists = context;
    RowStore *store = &lists->stores[worker];
    const RasterBins *bins = lists->bins;
    size_t columns = (size_t)bins->tile_columns;
    uint32_t *offsets, *words;
    TRY(take_words(store, columns + 1, &offsets, err));
    TRY(rasterbins_count(bins, row, offsets, err));
    TRY(take_words(store, 3 * (size_t)offsets[columns] + MAX_LANES, &words, err));
    memset(store->taken, 0, columns * sizeof *store->taken);
    for (size_t i = bins->row_offsets[row]; i < bins->row_offsets[row + 1]; i++) {
        const RasterTiles span = bins->row_columns[i];
        const RasterBox *box = &bins->row_boxes[i];
        for (int column = span.first; column <= span.last; column++) {
            size_t n = offsets[column + 1] - offsets[column];
            uint32_t *entry = words + 3 * (size_t)offsets[column] + store->taken[column]++;
            entry[0] = bins->row_items[i];
            entry[n] = box->box | (column < span.last ? RASTERBOX_X_MAX_BITS : 0) |
                       (column > span.first ? RASTERBOX_X_MIN_BITS : 0);
            memcpy(&entry[2 * n], &box->near, sizeof box->near);
        }
    }
    lists->rows[row] = (ListedRow){offsets, words};
    return STATUS_OK;
}

static Status list_boxes(RasterLists *lists, Err *err)
{
    size_t n = (size_t)lists->bins->tile_rows, columns = (size_t)lists->bins->tile_columns;
    TRY(mem_calloc(&lists->rows, n, sizeof *lists->rows, "rows of tiles", err));
    TRY(mem_calloc(&lists->stores, (size_t)lists->workers, sizeof *lists->stores, "shadows", err));
    for (int i = 0; i < lists->workers; i++)
        TRY(mem_calloc(&lists->stores[i].taken, columns, sizeof *lists->stores[i].taken, "shadows",
                       err));
    TRY(threads_try(n, lists->workers, list_boxes_of_row, lists, err));
    rasterbins_free_rows(lists->bins);
    return STATUS_OK;
}

/* ShadowEngine.tiles: aims for sixteen primitives per tile, counting a primitive in each tile that
 * it touches. There are nine primitives for each tile. */
static int tiles_for_primitives(const Drawing *drawing)
{
    double side = sqrt((double)rasterbins_items(drawing->geometry)) / 3;
    return side < MIN_SIDE ? MIN_SIDE : side > MAX_SIDE ? MAX_SIDE : (int)side;
}

/* ShadowEngine.slack: POV-Ray's distance, and the rounding of positions and depths to 2^-24 of the
 * scene's size, its diameter, three times. */
static double slack_of_rounding(const Drawing *drawing)
{
    return SHADOW_NEAREST_MM + 0x3p-23 * lightview_radius(drawing->geometry);
}

static void release_raster_lists(void *of)
{
    RasterLists *lists = of;
    if (!lists)
        return;
    for (int i = 0; lists->stores && i < lists->workers; i++) {
        free(lists->stores[i].taken);
        slabs_release(&lists->stores[i].slabs);
    }
    free(lists->stores);
    free(lists->rows);
    rasterbins_free(lists->bins);
    free(lists);
}

static Status bin_primitives(const Drawing *drawing, LightBins *light, Err *err)
{
    const int threads = drawing->params->threads;
    const RasterView view = view_of(&light->view);
    RasterLists *lists;
    TRY(mem_calloc(&lists, 1, sizeof *lists, "shadows", err));
    light->lists = lists;
    lists->grid = rastergrid_make(&view, 0.5, 0.5);
    lists->workers = threads;
    TRY(rasterbins_new(drawing->geometry, &view, threads, &lists->bins, err));
    return list_boxes(lists, err);
}

/* ---- queries --------------------------------------------------------------------------------- */

/* Returns a tile of the light view with its list. */
static RasterTile tile_with_list(const RasterLists *lists, int number)
{
    const RasterBins *bins = lists->bins;
    int row = number / bins->tile_columns, column = number % bins->tile_columns;
    const uint32_t *offsets = lists->rows[row].offsets + column;
    const uint32_t *list = lists->rows[row].words + 3 * (size_t)offsets[0];
    size_t n = offsets[1] - offsets[0];
    RasterTile tile = rasterbins_tile(bins, column, row, list, n, &lists->grid);
    tile.nears = (const float *)(const void *)(list + 2 * n);
    return tile;
}

static void prefetch_list(const RasterLists *lists, int number)
{
    RasterTile tile = tile_with_list(lists, number);
    for (size_t word = 0; word < 3 * tile.n && word < MAX_PREFETCHED; word += LINE_WORDS)
        __builtin_prefetch(tile.list + word);
}

/* ShadowEngine.test. */
static Status test_by_cover(const LightBins *light, void *workspace, const TileQueries *queries,
                            Err *err)
{
    (void)workspace;
    (void)err;
    RasterTile tile = tile_with_list(light->lists, queries->tile);
    if (queries->next >= 0)
        prefetch_list(light->lists, queries->next);
    rasterkernels[kernels_kind(queries->kernels)]->cover(&tile, queries->points);
    return STATUS_OK;
}

const ShadowEngine raster_shadows = {.supports = lightview_sees_all,
                                     .tiles = tiles_for_primitives,
                                     .slack = slack_of_rounding,
                                     .bin = bin_primitives,
                                     .release = release_raster_lists,
                                     .test = test_by_cover};
