/* Projects the primitives of a geometry to a view, which makes them items, and sorts the items into
 * tiles.
 *
 * Items are first sorted into the rows of tiles that they may touch. Items are divided into chunks
 * with counters of their own, so that threads fill the rows without waiting for each other, and in
 * the order of the items. Each entry of a row also has the columns of tiles that the item may touch
 * there. The lists of a row's tiles are made from these when the row is drawn.
 *
 * In the view of a camera, items that touch no tile are left out. Each chunk has space for all its
 * items and stores the remaining items at the beginning. The memory behind them is never written,
 * so that the operating system does not provide it. */
#include "render/raster/rasterbins.h"

#include "render/cast/caster.h"
#include <stdlib.h>

/* Minimum number of primitives in a chunk: fewer fit into the cache of one processor, and other
 * threads would fetch them more slowly than this thread processes them. MAX_CHUNKS bounds the
 * memory of the counters, 8 bytes per chunk and row of tiles: at most 4 MB at 65,536 pixels. It is
 * more than the processors of most machines. */
enum { MIN_CHUNK = 1 << 16, MAX_CHUNKS = 64 };
enum { CACHE_LINE = sizeof(RasterItem) };
_Static_assert(CACHE_LINE == 64, "an item fills a line");

/* ---- rows ------------------------------------------------------------------------------------ */

/* Bins while they are made. All arrays are owned. */
typedef struct Build {
    RasterBins *bins;
    RasterSlab *slabs;      /* per row of tiles */
    size_t *counts;         /* per chunk and row: number of items; then the index of the chunk's
                             * first entry */
    size_t *ends;           /* per chunk: index behind its last item */
    uint32_t *joints;       /* per chunk: number of joints; then the index of the first */
    size_t chunk, n_chunks; /* number of items in a chunk, and of chunks */
} Build;

static size_t chunk_end(const Build *build, size_t chunk)
{
    size_t end = (chunk + 1) * build->chunk, n = rasterbins_items(build->bins->geometry);
    return end < n ? end : n;
}

static bool is_joint(const RasterBins *bins, size_t number)
{
    return model_has(bins->geometry->model, MODEL_JOINTS) &&
           bins->geometry->primitives[number].kind == PRIMITIVE_JOINT;
}

static void count_joints(size_t chunk, int worker, void *context)
{
    (void)worker;
    const Build *build = context;
    for (size_t i = chunk * build->chunk; i < chunk_end(build, chunk); i++)
        build->joints[chunk] += is_joint(build->bins, i);
}

/* Allocates the joints (the hulls, in a light view), and finds the first joint of each chunk. */
static Status allocate_joints(Build *build, int threads, Err *err)
{
    RasterBins *bins = build->bins;
    uint32_t n = 0;
    TRY(mem_calloc(&build->joints, build->n_chunks, sizeof *build->joints, "joints", err));
    if (model_has(bins->geometry->model, MODEL_JOINTS))
        threads_for(build->n_chunks, threads, count_joints, build);
    for (size_t chunk = 0; chunk < build->n_chunks; chunk++) {
        uint32_t count = build->joints[chunk];
        build->joints[chunk] = n;
        n += count;
    }
    if (bins->view.light)
        return mem_calloc(&bins->hulls, (size_t)n + 1, sizeof *bins->hulls, "joints", err);
    return mem_calloc(&bins->joints, (size_t)n + 1, sizeof *bins->joints, "joints", err);
}

/* Makes the items of a chunk, and counts them in their rows. */
static void make_chunk(size_t chunk, int worker, void *context)
{
    (void)worker;
    const Build *build = context;
    RasterBins *bins = build->bins;
    size_t *counts = build->counts + chunk * (size_t)bins->tile_rows;
    uint32_t joint = build->joints[chunk];
    size_t to = chunk * build->chunk;
    for (size_t i = to; i < chunk_end(build, chunk); i++) {
        RasterItem *item = &bins->items[to];
        rasteritem_make(bins->geometry, &bins->view, (uint32_t)i, item,
                        bins->joints ? &bins->joints[joint] : NULL,
                        bins->hulls ? &bins->hulls[joint] : NULL);
        item->joint = joint & (MAX_ITEMS - 1);
        joint += is_joint(bins, i);
        if (!bins->view.light)
            item->primitive = (uint32_t)i;
        for (int row = item->rows.first; row <= item->rows.last; row++)
            counts[row]++;
        to += bins->view.light || item->rows.first <= item->rows.last;
    }
    build->ends[chunk] = to;
}

/* Appends an item to its rows. `next_entry` holds the next free entry of each row. */
static void fill_item(const Build *build, size_t *next_entry, size_t number)
{
    RasterBins *bins = build->bins;
    const RasterItem *item = &bins->items[number];
    for (int row = item->rows.first; row <= item->rows.last; row++) {
        size_t entry = next_entry[row]++;
        uint32_t box;
        bins->row_items[entry] = (uint32_t)number;
        bins->row_columns[entry] =
            rastertiles_of(rasterreach_in_row(&bins->view, item, row, &build->slabs[row], &box));
        if (bins->row_boxes)
            bins->row_boxes[entry] = (RasterBox){box, rasterreach_near(&bins->view, item)};
    }
}

static void fill_chunk(size_t chunk, int worker, void *context)
{
    (void)worker;
    const Build *build = context;
    size_t *next_entry = build->counts + chunk * (size_t)build->bins->tile_rows;
    for (size_t i = chunk * build->chunk; i < build->ends[chunk]; i++)
        fill_item(build, next_entry, i);
}

/* Makes all items, and sorts them into the rows by counting: a first pass counts the entries of
 * each chunk and row, a second pass stores them. */
static Status sort_into_rows(Build *build, int threads, Err *err)
{
    RasterBins *bins = build->bins;
    size_t rows = (size_t)bins->tile_rows, total = 0;
    size_t chunks = build->n_chunks;
    TRY(mem_calloc(&build->counts, chunks * rows, sizeof *build->counts, "rows of tiles", err));
    TRY(mem_calloc(&build->ends, chunks, sizeof *build->ends, "rows of tiles", err));
    threads_for(chunks, threads, make_chunk, build);
    for (size_t row = 0; row < rows; row++) {
        bins->row_offsets[row] = total;
        for (size_t chunk = 0; chunk < chunks; chunk++) {
            size_t count = build->counts[chunk * rows + row];
            build->counts[chunk * rows + row] = total;
            total += count;
        }
    }
    bins->row_offsets[rows] = total;
    TRY(mem_calloc(&bins->row_items, total, sizeof *bins->row_items, "rows of tiles", err));
    TRY(mem_calloc(&bins->row_columns, total, sizeof *bins->row_columns, "rows of tiles", err));
    if (bins->view.light)
        TRY(mem_calloc(&bins->row_boxes, total, sizeof *bins->row_boxes, "rows of tiles", err));
    TRY(mem_calloc(&build->slabs, rows, sizeof *build->slabs, "rows of tiles", err));
    for (size_t row = 0; row < rows; row++)
        build->slabs[row] = rasterslab_of(&bins->view, row);
    threads_for(chunks, threads, fill_chunk, build);
    return STATUS_OK;
}

/* Returns true if the geometry is so small that one thread makes its items. */
static bool are_small(const Geometry *geometry)
{
    return rasterbins_items(geometry) / MIN_CHUNK < 2;
}

/* Returns the number of chunks: a multiple of the number of threads, so that no thread waits for
 * another at the end. */
static size_t chunks_for(const Geometry *geometry, size_t threads)
{
    size_t chunks = rasterbins_items(geometry) / MIN_CHUNK;
    if (are_small(geometry))
        return 1;
    chunks = chunks < MAX_CHUNKS ? chunks : MAX_CHUNKS;
    threads = threads < chunks ? threads : chunks;
    return (chunks + threads - 1) / threads * threads;
}

bool rasterbins_supports(const Geometry *geometry, int width, int height)
{
    const int most = UINT16_MAX * TILE_SIDE;
    return rasterbins_items(geometry) <= MAX_ITEMS && width <= most && height <= most;
}

static Status make_bins(RasterBins *bins, int threads, Err *err)
{
    size_t n = rasterbins_items(bins->geometry),
           chunks = chunks_for(bins->geometry, (size_t)threads);
    if (n > MAX_ITEMS)
        return err_set(err, STATUS_MEMORY, "too many primitives for `method` raster");
    if (bins->tile_columns > UINT16_MAX || bins->tile_rows > UINT16_MAX)
        return err_set(err, STATUS_USAGE,
                       "`method` raster draws pictures of up to %d pixels a side, `method` trace "
                       "larger ones",
                       UINT16_MAX * TILE_SIDE);
    TRY(mem_calloc(&bins->item_memory, n + 1, sizeof *bins->items, "items", err));
    bins->items =
        (RasterItem *)(((uintptr_t)bins->item_memory + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE);
    TRY(mem_calloc(&bins->row_offsets, (size_t)bins->tile_rows + 1, sizeof *bins->row_offsets,
                   "rows of tiles", err));
    size_t chunk = n / chunks + 1;
    Build build = {.bins = bins, .chunk = chunk, .n_chunks = (n + chunk - 1) / chunk};
    Status status = allocate_joints(&build, threads, err);
    if (status == STATUS_OK)
        status = sort_into_rows(&build, threads, err);
    free(build.slabs);
    free(build.joints);
    free(build.counts);
    free(build.ends);
    return status;
}

Status rasterbins_new(const Geometry *geometry, const RasterView *view, int threads,
                      RasterBins **out, Err *err)
{
    RasterBins *bins = NULL;
    TRY(mem_calloc(&bins, 1, sizeof *bins, "tiles", err));
    bins->geometry = geometry;
    bins->view = *view;
    bins->view.per_x = 1 / view->step_x;
    bins->view.per_y = 1 / view->step_y;
    bins->view.many = !are_small(geometry);
    bins->tile_columns = (view->columns + TILE_SIDE - 1) / TILE_SIDE;
    bins->tile_rows = (view->rows + TILE_SIDE - 1) / TILE_SIDE;
    if (!view->light) {
        bins->view.listed_columns = (TileSpan){0, bins->tile_columns - 1};
        bins->view.listed_rows = (TileSpan){0, bins->tile_rows - 1};
    }
    Status status = make_bins(bins, threads, err);
    if (status != STATUS_OK) {
        rasterbins_free(bins);
        return status;
    }
    *out = bins;
    return STATUS_OK;
}

void rasterbins_free(RasterBins *bins)
{
    if (!bins)
        return;
    free(bins->item_memory);
    free(bins->joints);
    free(bins->hulls);
    free(bins->row_offsets);
    rasterbins_free_rows(bins);
    free(bins);
}

void rasterbins_free_rows(RasterBins *bins)
{
    free(bins->row_items);
    free(bins->row_columns);
    free(bins->row_boxes);
    bins->row_items = NULL;
    bins->row_columns = NULL;
    bins->row_boxes = NULL;
}

/* ---- tiles ----------------------------------------------------------------------------------- */

Status rasterbins_count(const RasterBins *bins, size_t number, uint32_t *offsets, Err *err)
{
    size_t columns = (size_t)bins->tile_columns, total = 0;
    for (size_t i = 0; i <= columns; i++)
        offsets[i] = 0;
    for (size_t i = bins->row_offsets[number]; i < bins->row_offsets[number + 1]; i++)
        for (int column = bins->row_columns[i].first; column <= bins->row_columns[i].last; column++)
            offsets[column]++;
    for (size_t i = 0; i <= columns; i++) {
        size_t count = offsets[i];
        offsets[i] = (uint32_t)total;
        total += count;
        if (total > UINT32_MAX)
            return err_set(err, STATUS_MEMORY, "too many primitives in one row of the picture");
    }
    return STATUS_OK;
}

Status rasterbins_list(const RasterBins *bins, size_t number, IndexLists *tiles, Err *err)
{
    const size_t first = bins->row_offsets[number], end = bins->row_offsets[number + 1];
    TRY(indexlists_begin(tiles, (size_t)bins->tile_columns, "tiles", err));
    for (size_t i = first; i < end; i++)
        for (int column = bins->row_columns[i].first; column <= bins->row_columns[i].last; column++)
            indexlists_count(tiles, (size_t)column);
    TRY(indexlists_allot(tiles, "tiles", err));
    for (size_t i = first; i < end; i++)
        for (int column = bins->row_columns[i].first; column <= bins->row_columns[i].last; column++)
            indexlists_put(tiles, (size_t)column, bins->row_items[i]);
    return STATUS_OK;
}

RasterTile rasterbins_tile(const RasterBins *bins, int column, int row, const uint32_t *list,
                           size_t n, const RasterGrid *grid)
{
    const RasterView *view = &bins->view;
    const double middle = (TILE_SIDE - 1) / 2.0;
    return (RasterTile){.bins = bins,
                        .items = bins->items,
                        .joints = bins->joints,
                        .list = list,
                        .n = n,
                        .grid = grid,
                        .perspective = view->eye.perspective,
                        .x = view->left + (column * TILE_SIDE + middle) * view->step_x,
                        .y = view->top + (row * TILE_SIDE + middle) * view->step_y,
                        .z_middle = view->z_middle};
}

/* ---- items in double precision --------------------------------------------------------------- */

void raster_joint(const RasterBins *bins, uint32_t number, RasterJoint *joint)
{
    const RasterItem *about = &bins->items[number];
    *joint = rasterjoint_make(&bins->view, &bins->geometry->primitives[number],
                              vec3(about->x, about->y, about->z));
}

double raster_intersect(const RasterBins *bins, uint32_t number, double x, double y, Vec3 *normal)
{
    const Primitive *primitive = &bins->geometry->primitives[number];
    Ray ray = rasterview_ray(&bins->view, x, y);
    Hit hits[6];
    double nearest = HUGE_VAL;
    PrimitiveFrame frame = primitive_frame(primitive);
    int n = primitive_hits(primitive, &frame, ray, hits);
    if (primitive->round_a)
        n += hit_sphere(ray, primitive->a, primitive->radius_mm, &hits[n]);
    if (primitive->round_b)
        n += hit_sphere(ray, primitive->b, primitive->radius_mm, &hits[n]);
    for (int i = 0; i < n; i++)
        if (hits[i].t >= NEAREST_VISIBLE_MM && hits[i].t < nearest) {
            nearest = hits[i].t;
            if (normal)
                *normal = viewpoint_frame_direction(&bins->view.eye, hits[i].normal);
        }
    return nearest * vec3_dot(ray.direction, bins->view.eye.axes[2]);
}
