/* Measures the distance of tissue from its vessels, and the territory of each outlet, on a grid of
 * voxels.
 *
 * Blocks of 16 voxels a side are measured by several threads, a layer of blocks at a time. Sums of
 * a block are added in the order of blocks, so that rounding does not depend on the threads; counts
 * are integers, which workers may add in any order. */
#include "coverage/farthest.h"
#include "coverage/sites.h"

/* Voxels along a side of a block, voxels of a block, and samples that are compressed together.
 * Memory is needed for one layer of blocks. With 16 voxels, a layer of a large volume fits into
 * memory, and a search for near vessels serves 4096 voxels. */
enum { BLOCK = 16, BLOCK_VOXELS = BLOCK * BLOCK * BLOCK, CHUNK_VOXELS = 1 << 18 };

Status coveragegrid_make(const Domain *domain, double mm, VoxelGrid *out, Err *err)
{
    VoxelGrid grid = {.step = {mm, mm, mm}};
    double first[3];
    for (int axis = 0; axis < 3; axis++) {
        double low = ceil(vec3_component(domain->bounds.low, axis) / mm - 0.5);
        double high = floor(vec3_component(domain->bounds.high, axis) / mm + 0.5);
        if (!(high - low < INT32_MAX))
            return err_set(err, STATUS_INFEASIBLE,
                           "`voxel`: %g mm would make %.3g voxels along an axis; the maximum is "
                           "2^31",
                           mm, high - low);
        grid.n[axis] = (int64_t)box_max(high - low, 0) + 1;
        first[axis] = low * mm;
    }
    grid.first = vec3(first[0], first[1], first[2]);
    *out = grid;
    return STATUS_OK;
}

/* ---- the state of a measurement -------------------------------------------------------------- */

/* The workspace of a thread, and the counts of its blocks. */
typedef struct Worker {
    SiteLists lists;
    bool inside[BLOCK_VOXELS];
    Nearest nearest[BLOCK_VOXELS];
    int64_t *bin, *beyond, *territory; /* owned */
    int64_t tissue, vessel;
} Worker;

/* The sums of a block, and its tissue voxel that is farthest from any vessel. */
typedef struct BlockSums {
    double sum_mm;
    FarthestPoint farthest;
} BlockSums;

typedef struct Coverage {
    const CoverageParams *params;
    Sites walls, outlets;
    const Sites *owners; /* the sites that decide territories; NULL: no territories */
    int64_t n_blocks[3]; /* along each axis */
    double *nearest_mm;  /* per block: sites_nearest of its centre, walls */
    double bin_mm;
    Worker *workers;
    BlockSums *sums;     /* per block of the layer */
    float *distance;     /* per voxel of the layer; NULL: not wanted */
    uint32_t *label;     /* per voxel of the layer; NULL: not wanted */
    VolumeChunk *chunks; /* of the layer, for the stream `packing` */
    VolumeStream *packing;
    uint8_t *samples; /* of the layer, for the stream `packing` */
    int64_t layer;    /* index of the layer */
    int threads;
} Coverage;

static int64_t layer_voxels(const VoxelGrid *grid)
{
    return grid->n[0] * grid->n[1] * (grid->n[2] < BLOCK ? grid->n[2] : BLOCK);
}

static int64_t blocks_along(const VoxelGrid *grid, int axis)
{
    return (grid->n[axis] + BLOCK - 1) / BLOCK;
}

double coverage_memory(const CoverageParams *params)
{
    const VoxelGrid *grid = &params->grid;
    double voxels = (double)layer_voxels(grid), blocks = 1;
    double threads = params->threads > 0 ? params->threads : threads_available();
    double sites = (double)params->n_tubes + (double)params->n_outlets;
    double a_voxel = (params->distances ? 8 : 0) + (params->territories ? 8 : 0);
    for (int axis = 0; axis < 3; axis++)
        blocks *= (double)blocks_along(grid, axis);
    /* 8 MB for the program, and 400 bytes per site for its boxes, its data and those of its tube.
     */
    return 8e6 + voxels * a_voxel + blocks * sizeof(double) + sites * (400 + 8 * threads) +
           threads * (sizeof(Worker) + COVERAGE_BINS * sizeof(int64_t));
}

/* Returns block `index` of a layer. */
static VoxelBlock block_at(const Coverage *coverage, size_t index, int64_t layer)
{
    const int64_t nx = coverage->n_blocks[0],
                  at[3] = {(int64_t)index % nx, (int64_t)index / nx, layer};
    VoxelBlock block;
    for (int axis = 0; axis < 3; axis++) {
        int64_t n = coverage->params->grid.n[axis], high = (at[axis] + 1) * BLOCK;
        block.low[axis] = at[axis] * BLOCK;
        block.high[axis] = high < n ? high : n;
    }
    return block;
}

static size_t blocks_a_layer(const Coverage *coverage)
{
    return (size_t)(coverage->n_blocks[0] * coverage->n_blocks[1]);
}

/* ---- which voxels are in the domain ---------------------------------------------------------- */

static Vec3 voxel_centre(const VoxelGrid *grid, int64_t x, int64_t y, int64_t z)
{
    return vec3(grid->first.x + grid->step.x * (double)x, grid->first.y + grid->step.y * (double)y,
                grid->first.z + grid->step.z * (double)z);
}

/* Tests a row of voxels. In a domain that is not convex, a test of the segment along the row is
 * cheaper than one test per voxel. */
static void test_row(const CoverageParams *params, const VoxelBlock *block, int64_t y, int64_t z,
                     bool *inside)
{
    const Domain *domain = params->domain;
    Vec3 first = voxel_centre(&params->grid, block->low[0], y, z);
    Vec3 last = voxel_centre(&params->grid, block->high[0] - 1, y, z);
    bool is_whole = domain_inside(domain, first, 0) && domain_inside(domain, last, 0) &&
                    (domain_is_convex(domain) || domain_holds_segment(domain, first, last));
    for (int64_t x = block->low[0]; x < block->high[0]; x++)
        inside[x - block->low[0]] =
            is_whole || domain_inside(domain, voxel_centre(&params->grid, x, y, z), 0);
}

/* Tests which voxels of a block are in the domain. */
static void test_block(const CoverageParams *params, const VoxelBlock *block, bool *inside)
{
    for (int64_t z = block->low[2]; z < block->high[2]; z++)
        for (int64_t y = block->low[1]; y < block->high[1]; y++) {
            test_row(params, block, y, z, inside);
            inside += block->high[0] - block->low[0];
        }
}

/* ---- a block --------------------------------------------------------------------------------- */

/* Counts a voxel of the tissue. */
static void count_tissue(const Coverage *coverage, Worker *worker, double distance, Vec3 centre,
                         BlockSums *sums)
{
    const CoverageParams *params = coverage->params;
    size_t bin = (size_t)(distance / coverage->bin_mm);
    worker->tissue++;
    worker->bin[bin < COVERAGE_BINS ? bin : COVERAGE_BINS - 1]++;
    for (size_t k = 0; k < params->n_beyond; k++)
        worker->beyond[k] += distance > params->beyond[k];
    sums->sum_mm += distance;
    if (distance > sums->farthest.distance_mm)
        sums->farthest = (FarthestPoint){distance, centre};
}

/* A loop over the voxels of a block: `from` is a voxel's position in the arrays of the block, `to`
 * in the arrays of the layer. */
#define FOR_VOXELS(grid, block, x, y, z, from, to)                                                 \
    for (int64_t from = 0, z = (block)->low[2]; z < (block)->high[2]; z++)                         \
        for (int64_t y = (block)->low[1]; y < (block)->high[1]; y++)                               \
            for (int64_t x = (block)->low[0],                                                      \
                         to = x + (grid)->n[0] * (y + (grid)->n[1] * (z - (block)->low[2]));       \
                 x < (block)->high[0]; x++, from++, to++)

/* Takes the distances of a block: stores them, and counts each voxel as tissue or as vessel. */
static void take_distances(const Coverage *coverage, Worker *worker, const VoxelBlock *block,
                           BlockSums *sums)
{
    const VoxelGrid *grid = &coverage->params->grid;
    FOR_VOXELS(grid, block, x, y, z, from, to)
    {
        double distance = worker->nearest[from].distance_mm;
        if (!worker->inside[from]) {
            if (coverage->distance)
                coverage->distance[to] = NAN;
            continue;
        }
        if (coverage->distance)
            coverage->distance[to] = (float)box_max(distance, 0);
        if (distance > 0)
            count_tissue(coverage, worker, distance, voxel_centre(grid, x, y, z), sums);
        else
            worker->vessel++;
    }
}

/* Takes the nearest sites as owners. The volume of vessels belongs to no territory. */
static void take_territories(const Coverage *coverage, Worker *worker, const VoxelBlock *block,
                             const bool *is_tissue)
{
    const CoverageParams *params = coverage->params;
    FOR_VOXELS(&params->grid, block, x, y, z, from, to)
    {
        uint32_t site = worker->nearest[from].site;
        if (coverage->label)
            coverage->label[to] = worker->inside[from] ? params->labels[site] : 0;
        if (is_tissue[from])
            worker->territory[site]++;
    }
}

/* Measures a block, as the body of a parallel loop: distances first, then territories, which may
 * need a second search for the nearest outlets. */
static Status measure_block(size_t index, int worker_index, void *context, Err *err)
{
    Coverage *coverage = context;
    Worker *worker = &coverage->workers[worker_index];
    const VoxelGrid *grid = &coverage->params->grid;
    const VoxelBlock block = block_at(coverage, index, coverage->layer);
    bool is_tissue[BLOCK_VOXELS];
    size_t at = index + (size_t)coverage->layer * blocks_a_layer(coverage);
    SiteSearch search = {.sites = &coverage->walls,
                         .lists = &worker->lists,
                         .grid = grid,
                         .block = &block,
                         .wanted = worker->inside,
                         .nearest = worker->nearest};
    coverage->sums[index] = (BlockSums){0};
    test_block(coverage->params, &block, worker->inside);
    TRY(sites_search(&search, coverage->nearest_mm[at], err));
    take_distances(coverage, worker, &block, &coverage->sums[index]);
    if (!coverage->owners)
        return STATUS_OK;
    for (size_t i = 0; i < BLOCK_VOXELS; i++)
        is_tissue[i] = worker->inside[i] && worker->nearest[i].distance_mm > 0;
    search.sites = coverage->owners;
    if (search.sites != &coverage->walls)
        TRY(sites_search(&search,
                         sites_nearest(search.sites, block_centre(grid, &block), -INFINITY), err));
    take_territories(coverage, worker, &block, is_tissue);
    return STATUS_OK;
}

/* ---- a layer of blocks ----------------------------------------------------------------------- */

/* Returns the number of voxels of the present layer. */
static size_t voxels_now(const Coverage *coverage)
{
    const VoxelGrid *grid = &coverage->params->grid;
    int64_t left = grid->n[2] - coverage->layer * BLOCK;
    return (size_t)(grid->n[0] * grid->n[1] * (left < BLOCK ? left : BLOCK));
}

static Status pack_chunk(size_t index, int worker, void *context, Err *err)
{
    Coverage *coverage = context;
    (void)worker;
    size_t first = index * CHUNK_VOXELS, left = voxels_now(coverage) - first;
    size_t size = sample_size(coverage->packing->type);
    return volume_pack(coverage->packing, coverage->samples + first * size,
                       (left < CHUNK_VOXELS ? left : CHUNK_VOXELS) * size, &coverage->chunks[index],
                       err);
}

/* Writes the samples of the layer to a stream. */
static Status put_samples(Coverage *coverage, VolumeStream *stream, void *samples, Err *err)
{
    size_t n = (voxels_now(coverage) + CHUNK_VOXELS - 1) / CHUNK_VOXELS;
    Status status;
    if (!stream)
        return STATUS_OK;
    coverage->packing = stream;
    coverage->samples = samples;
    TRY_GOTO(mem_calloc(&coverage->chunks, n, sizeof *coverage->chunks, "voxels", err));
    TRY_GOTO(threads_try(n, coverage->threads, pack_chunk, coverage, err));
    for (size_t i = 0; i < n; i++)
        TRY_GOTO(volume_put(stream, &coverage->chunks[i], err));
done:
    for (size_t i = 0; coverage->chunks && i < n; i++)
        free(coverage->chunks[i].bytes);
    free(coverage->chunks);
    coverage->chunks = NULL;
    return status;
}

/* Measures the blocks of the present layer, adds their sums in order, and writes the layer's
 * samples. */
static Status measure_layer(Coverage *coverage, BlockSums *total, Err *err)
{
    const CoverageParams *params = coverage->params;
    size_t n = blocks_a_layer(coverage);
    TRY(threads_try(n, coverage->threads, measure_block, coverage, err));
    for (size_t i = 0; i < n; i++) {
        total->sum_mm += coverage->sums[i].sum_mm;
        if (coverage->sums[i].farthest.distance_mm > total->farthest.distance_mm)
            total->farthest = coverage->sums[i].farthest;
    }
    TRY(put_samples(coverage, params->distances, coverage->distance, err));
    if (params->territories)
        volume_labels(params->territories->type, coverage->label, voxels_now(coverage));
    TRY(put_samples(coverage, params->territories, coverage->label, err));
    double done = (double)(coverage->layer + 1) / (double)coverage->n_blocks[2];
    return params->progress && !params->progress(done, params->context) ? err_cancelled(err)
                                                                        : STATUS_OK;
}

/* ---- the whole ------------------------------------------------------------------------------- */

static void find_nearest(size_t index, int worker, void *context)
{
    Coverage *coverage = context;
    (void)worker;
    size_t n = blocks_a_layer(coverage);
    const VoxelBlock block = block_at(coverage, index % n, (int64_t)(index / n));
    coverage->nearest_mm[index] =
        sites_nearest(&coverage->walls, block_centre(&coverage->params->grid, &block), -INFINITY);
}

static Status reserve_workers(Coverage *coverage, Err *err)
{
    const CoverageParams *params = coverage->params;
    TRY(mem_calloc(&coverage->workers, (size_t)coverage->threads, sizeof *coverage->workers,
                   "threads", err));
    for (int i = 0; i < coverage->threads; i++) {
        Worker *worker = &coverage->workers[i];
        TRY(mem_calloc(&worker->bin, COVERAGE_BINS, sizeof *worker->bin, "bins", err));
        TRY(mem_calloc(&worker->beyond, params->n_beyond, sizeof *worker->beyond, "bins", err));
        if (coverage->owners)
            TRY(mem_calloc(&worker->territory, coverage->owners->n, sizeof *worker->territory,
                           "territories", err));
    }
    return STATUS_OK;
}

static Status reserve(Coverage *coverage, size_t *n_blocks, Err *err)
{
    const CoverageParams *params = coverage->params;
    size_t voxels = (size_t)layer_voxels(&params->grid);
    for (int axis = 0; axis < 3; axis++)
        coverage->n_blocks[axis] = blocks_along(&params->grid, axis);
    *n_blocks = blocks_a_layer(coverage) * (size_t)coverage->n_blocks[2];
    TRY(mem_alloc(&coverage->nearest_mm, *n_blocks, sizeof *coverage->nearest_mm, "blocks", err));
    TRY(mem_alloc(&coverage->sums, blocks_a_layer(coverage), sizeof *coverage->sums, "blocks",
                  err));
    if (params->distances)
        TRY(mem_alloc(&coverage->distance, voxels, sizeof *coverage->distance, "voxels", err));
    if (params->territories)
        TRY(mem_alloc(&coverage->label, voxels, sizeof *coverage->label, "voxels", err));
    return reserve_workers(coverage, err);
}

/* Builds the sites and chooses the bins of the histogram. No distance in a block is above that of
 * its centre by more than the block's half diagonal. */
static Status prepare(Coverage *coverage, Err *err)
{
    const CoverageParams *params = coverage->params;
    double most = 0;
    size_t n;
    TRY(sites_make(params->tubes, params->n_tubes, &coverage->walls, err));
    if (params->outlets)
        TRY(sites_make(params->outlets, params->n_outlets, &coverage->outlets, err));
    if (params->labels)
        coverage->owners = params->outlets ? &coverage->outlets : &coverage->walls;
    TRY(reserve(coverage, &n, err));
    threads_for(n, coverage->threads, find_nearest, coverage);
    for (size_t i = 0; i < n; i++)
        most = box_max(most, coverage->nearest_mm[i]);
    coverage->bin_mm = (most + BLOCK * vec3_length(params->grid.step)) / COVERAGE_BINS;
    return STATUS_OK;
}

/* Adds up the counts of all threads. */
static Status add_counts(const Coverage *coverage, CoverageReport *report, Err *err)
{
    const CoverageParams *params = coverage->params;
    const size_t n_sites = coverage->owners ? coverage->owners->n : 0;
    int64_t vessel = 0;
    TRY(mem_calloc(&report->bin, COVERAGE_BINS, sizeof *report->bin, "bins", err));
    TRY(mem_calloc(&report->beyond, params->n_beyond, sizeof *report->beyond, "bins", err));
    if (n_sites)
        TRY(mem_calloc(&report->territory, n_sites, sizeof *report->territory, "territories", err));
    for (int i = 0; i < coverage->threads; i++) {
        const Worker *worker = &coverage->workers[i];
        report->tissue_voxels += worker->tissue;
        vessel += worker->vessel;
        for (size_t k = 0; k < COVERAGE_BINS; k++)
            report->bin[k] += worker->bin[k];
        for (size_t k = 0; k < params->n_beyond; k++)
            report->beyond[k] += worker->beyond[k];
        for (size_t k = 0; k < n_sites; k++)
            report->territory[k] += worker->territory[k];
    }
    report->tissue_volume = (double)report->tissue_voxels * report->voxel_volume;
    report->vessel_volume = (double)vessel * report->voxel_volume;
    report->bin_mm = coverage->bin_mm;
    return STATUS_OK;
}

/* Finds the largest distance of any point of the tissue. The search starts with the largest
 * distance of a voxel centre. It accepts an error of 2 % of a voxel, or of 1 um if that is smaller.
 */
static Status find_farthest(const Coverage *coverage, FarthestPoint start, CoverageReport *report,
                            Err *err)
{
    const CoverageParams *params = coverage->params;
    const VoxelGrid *grid = &params->grid;
    FarthestSearch search = {.domain = params->domain,
                             .sites = &coverage->walls,
                             .accepted_mm = box_min(1e-3, 0.02 * grid->step.x),
                             .best = start};
    size_t a_layer = blocks_a_layer(coverage);
    Status status = STATUS_OK;
    for (size_t i = 0; i < a_layer * (size_t)coverage->n_blocks[2]; i++) {
        const VoxelBlock block = block_at(coverage, i % a_layer, (int64_t)(i / a_layer));
        double half[3];
        for (int axis = 0; axis < 3; axis++)
            half[axis] = 0.5 * (double)(block.high[axis] - block.low[axis]) * grid->step.x;
        half[2] = params->domain->dimension == 2 ? 0 : half[2];
        TRY_GOTO(farthest_search(&search, block_centre(grid, &block),
                                 vec3(half[0], half[1], half[2]), coverage->nearest_mm[i], err));
    }
    report->largest_mm = search.best.distance_mm;
    report->largest_at = search.best.at;
    report->largest_error_mm =
        box_max(search.accepted_mm, search.undecided_mm - search.best.distance_mm);
done:
    ARRAY_RELEASE(&search.boxes);
    return status;
}

/* Measures all layers, and then the largest distance. */
static Status run(Coverage *coverage, CoverageReport *report, Err *err)
{
    const CoverageParams *params = coverage->params;
    double side = params->grid.step.x;
    BlockSums total = {0};
    report->voxel_volume = params->domain->dimension == 2 ? side * side : side * side * side;
    TRY(prepare(coverage, err));
    for (; coverage->layer < coverage->n_blocks[2]; coverage->layer++)
        TRY(measure_layer(coverage, &total, err));
    TRY(add_counts(coverage, report, err));
    report->mean_mm = report->largest_mm = NAN;
    if (report->tissue_voxels > 0) {
        report->mean_mm = total.sum_mm / (double)report->tissue_voxels;
        TRY(find_farthest(coverage, total.farthest, report, err));
    }
    if (params->distances)
        volume_end(params->distances);
    if (params->territories)
        volume_end(params->territories);
    return STATUS_OK;
}

static void release(Coverage *coverage)
{
    for (int i = 0; coverage->workers && i < coverage->threads; i++) {
        sitelists_release(&coverage->workers[i].lists);
        free(coverage->workers[i].bin);
        free(coverage->workers[i].beyond);
        free(coverage->workers[i].territory);
    }
    free(coverage->workers);
    free(coverage->nearest_mm);
    free(coverage->sums);
    free(coverage->distance);
    free(coverage->label);
    sites_release(&coverage->walls);
    sites_release(&coverage->outlets);
}

Status coverage_measure(const CoverageParams *params, CoverageReport *report, Err *err)
{
    Coverage coverage = {.params = params,
                         .threads = params->threads > 0 ? params->threads : threads_available()};
    CoverageReport made = {0};
    Status status = run(&coverage, &made, err);
    release(&coverage);
    if (status != STATUS_OK) {
        coveragereport_release(&made);
        return status;
    }
    *report = made;
    return STATUS_OK;
}

void coveragereport_release(CoverageReport *report)
{
    free(report->beyond);
    free(report->bin);
    free(report->territory);
    *report = (CoverageReport){0};
}

double coverage_quantile(const CoverageReport *report, double part)
{
    double wanted = part * (double)report->tissue_voxels, before = 0;
    if (report->tissue_voxels == 0)
        return (double)NAN;
    for (size_t k = 0; k < COVERAGE_BINS; k++) {
        double here = (double)report->bin[k];
        if (here > 0 && before + here >= wanted)
            return report->bin_mm * ((double)k + (wanted - before) / here);
        before += here;
    }
    return report->bin_mm * COVERAGE_BINS;
}
