/* Writes voxel volumes: the filled fractions, the labels and the centrelines of a tree's vessels.
 *
 * A volume is made in chunks of whole rows. Threads fill and pack the chunks, then one thread
 * writes them in order. Only a few chunks per thread exist at a time, so memory does not grow with
 * the volume. Where chunks end depends on the volume alone, so every byte does, too. */
#include "voxel/voxel.h"

#include "voxel/claims.h"
#include "voxel/rows.h"

#include <stdlib.h>

/* Number of voxels per chunk, number of chunks per thread at a time, and number of kinds of
 * volumes. A chunk of 2^18 voxels is 256 kB to 1 MB of samples, 8 to 32 windows of deflate, so
 * ending a chunk costs little compression. Larger chunks take more memory. With fewer chunks per
 * thread, threads wait for the slowest one more often. Changing CHUNK_VOXELS changes the bytes of
 * files. */
enum { CHUNK_VOXELS = 1 << 18, CHUNKS_PER_THREAD = 4, VOLUMES = 3 };

typedef struct VoxelChunk {
    RowBlock rows;
    VolumeChunk parts[VOLUMES];
} VoxelChunk;

typedef struct VoxelWork {
    const VoxelParams *params;
    VolumeStream *streams[VOLUMES];
    RowSource source;
    Claims claims;
    RowWorkspace *workspaces;
    VoxelChunk *chunks;
    size_t n_chunks; /* at a time */
    int64_t first_row, rows_per_chunk, n_rows;
    int threads;
} VoxelWork;

static size_t sample_bytes(const VoxelParams *params)
{
    size_t bytes = sample_size(params->fraction->type);
    bytes += params->label ? sizeof(uint32_t) : 0;
    return bytes + (params->centreline ? 1 : 0);
}

static int64_t rows_per_chunk(const VoxelGrid *grid)
{
    return grid->n[0] < CHUNK_VOXELS ? CHUNK_VOXELS / grid->n[0] : 1;
}

/* ---- how much work it is --------------------------------------------------------------------- */

/* Measured: seconds per partly filled voxel, per voxel, and per body; and the size of a sample
 * after compression, as a fraction of its size, in empty space and in partly filled voxels. */
static const double seconds_per_partial = 1e-6, seconds_per_voxel = 2.2e-9, seconds_per_body = 6e-5,
                    deflated_zeros = 1.0 / 220, deflated_partial = 1.1;
/* Measured, in bytes: memory of the program itself, and per body of the tree, the geometry, the
 * bodies and the boxes over them while these are built; 346 MB for 820,000 bodies. */
static const double program_bytes = 8e6, bytes_per_body = 420;

/* Estimates the number of partly filled voxels. A tube of radius r and length l, in units of the
 * voxels' width h, has an area of 2 pi r l. A surface in a random direction meets 1.5 voxels per
 * h^2, so the tube has about 9 r l partly filled voxels. 0.6 is added to r for tubes thinner than a
 * voxel, and r to l for the ends. */
static double wall_voxels(const Geometry *geometry, Vec3 step)
{
    double h = elementary_cbrt(step.x * step.y * step.z), walls = 0;
    for (size_t i = 0; i < geometry->n_primitives; i++) {
        const Primitive *primitive = &geometry->primitives[i];
        double r = primitive->radius_mm / h, l = vec3_distance(primitive->a, primitive->b) / h;
        walls += 9 * (r + 0.6) * (l + r);
    }
    return walls;
}

VoxelEstimate voxels_estimate(const Geometry *geometry, const VoxelParams *params)
{
    const VoxelGrid *grid = &params->grid;
    VolumeStream *const streams[VOLUMES] = {params->fraction, params->label, params->centreline};
    int threads = params->threads > 0 ? params->threads : threads_available();
    double voxels = (double)grid->n[0] * (double)grid->n[1] * (double)grid->n[2];
    double chunk = (double)(rows_per_chunk(grid) * grid->n[0]);
    VoxelEstimate estimate = {.voxels = voxels};
    estimate.partial_voxels = fmin(voxels, wall_voxels(geometry, grid->step));
    for (int i = 0; i < VOLUMES; i++)
        if (streams[i])
            estimate.bytes +=
                (double)sample_size(streams[i]->type) *
                (streams[i]->format->deflated
                     ? voxels * deflated_zeros + estimate.partial_voxels * deflated_partial
                     : voxels);
    estimate.memory = program_bytes + (double)geometry->n_primitives * bytes_per_body +
                      threads * CHUNKS_PER_THREAD * chunk * 2 * (double)sample_bytes(params);
    estimate.seconds = (estimate.partial_voxels * seconds_per_partial + voxels * seconds_per_voxel +
                        (double)geometry->n_primitives * seconds_per_body) /
                       threads;
    return estimate;
}

/* ---- chunks ---------------------------------------------------------------------------------- */

/* Raises a sample that was rounded to 0 to the smallest value above 0. */
static void raise_sample(RowBlock *rows, size_t at, SampleType type)
{
    uint16_t *wide = (uint16_t *)(void *)rows->values;
    if (type == SAMPLE_FLOAT || (type == SAMPLE_8 ? rows->values[at] : wide[at]))
        return;
    if (type == SAMPLE_8)
        rows->values[at] = 1;
    else
        wide[at] = 1;
    rows->written += 1 / sample_full(type);
    rows->n_nonzero++;
}

/* Writes the labels of claimed voxels, and raises their samples above 0. */
static void put_claims(const VoxelWork *work, RowBlock *rows)
{
    const VoxelGrid *grid = work->source.grid;
    const Claims *claims = &work->claims;
    int64_t first = rows->first_row * grid->n[0], end = first + rows->n_rows * grid->n[0];
    for (size_t i = claims_first_at(claims, first); i < claims->n && claims->claim[i].voxel < end;
         i++) {
        size_t at = (size_t)(claims->claim[i].voxel - first);
        rows->labels[at] = claims->claim[i].label;
        raise_sample(rows, at, work->source.type);
    }
}

/* Compresses the wanted samples of a chunk. */
static Status pack_chunk(const VoxelWork *work, VoxelChunk *chunk, Err *err)
{
    const RowBlock *rows = &chunk->rows;
    size_t n = (size_t)(rows->n_rows * work->source.grid->n[0]);
    uint8_t *samples[VOLUMES] = {rows->values, (uint8_t *)rows->labels, rows->centreline};
    if (rows->labels)
        volume_labels(work->streams[1]->type, rows->labels, n);
    for (int i = 0; i < VOLUMES; i++)
        if (work->streams[i])
            TRY(volume_pack(work->streams[i], samples[i], n * sample_size(work->streams[i]->type),
                            &chunk->parts[i], err));
    return STATUS_OK;
}

static Status reserve_chunk(const VoxelWork *work, RowBlock *rows, Err *err)
{
    size_t n = (size_t)(rows->n_rows * work->source.grid->n[0]);
    TRY(mem_calloc(&rows->values, n, sample_size(work->source.type), "voxels", err));
    if (work->params->label)
        TRY(mem_calloc(&rows->labels, n, sizeof *rows->labels, "labels", err));
    if (work->params->centreline)
        TRY(mem_calloc(&rows->centreline, n, 1, "voxels", err));
    return STATUS_OK;
}

static Status make_chunk(const VoxelWork *work, int64_t first, RowWorkspace *workspace,
                         VoxelChunk *chunk, Err *err)
{
    int64_t left = work->n_rows - first;
    chunk->rows = (RowBlock){.first_row = first};
    chunk->rows.n_rows = work->rows_per_chunk < left ? work->rows_per_chunk : left;
    TRY(reserve_chunk(work, &chunk->rows, err));
    TRY(rowblock_fill(&work->source, workspace, &chunk->rows, err));
    if (chunk->rows.labels)
        put_claims(work, &chunk->rows);
    return pack_chunk(work, chunk, err);
}

static void release_chunk(VoxelChunk *chunk)
{
    free(chunk->rows.values);
    free(chunk->rows.labels);
    free(chunk->rows.centreline);
    for (int i = 0; i < VOLUMES; i++)
        free(chunk->parts[i].bytes);
    *chunk = (VoxelChunk){0};
}

/* Fills and packs a chunk, as the body of a parallel loop. */
static Status work_on_chunk(size_t index, int worker, void *context, Err *err)
{
    const VoxelWork *work = context;
    int64_t first = work->first_row + (int64_t)index * work->rows_per_chunk;
    return make_chunk(work, first, &work->workspaces[worker], &work->chunks[index], err);
}

/* Writes a chunk and adds its sums to the report. */
static Status put_chunk(const VoxelWork *work, const VoxelChunk *chunk, VoxelReport *report,
                        Err *err)
{
    Vec3 step = work->source.grid->step;
    double voxel_mm3 = step.x * step.y * step.z;
    for (int i = 0; i < VOLUMES; i++)
        if (work->streams[i])
            TRY(volume_put(work->streams[i], &chunk->parts[i], err));
    report->union_mm3 += chunk->rows.covered * voxel_mm3;
    report->volume_mm3 += chunk->rows.written * voxel_mm3;
    report->filled += chunk->rows.n_nonzero;
    return STATUS_OK;
}

/* Makes all chunks, a batch at a time, and writes each batch in order. */
static Status make_chunks(VoxelWork *work, VoxelReport *report, Err *err)
{
    const VoxelParams *params = work->params;
    int64_t step = work->rows_per_chunk * (int64_t)work->n_chunks;
    for (; work->first_row < work->n_rows; work->first_row += step) {
        int64_t left = (work->n_rows - work->first_row - 1) / work->rows_per_chunk + 1;
        size_t n = left < (int64_t)work->n_chunks ? (size_t)left : work->n_chunks;
        TRY(threads_try(n, work->threads, work_on_chunk, work, err));
        for (size_t i = 0; i < n; i++) {
            TRY(put_chunk(work, &work->chunks[i], report, err));
            release_chunk(&work->chunks[i]);
        }
        const double done = fmin(1, (double)(work->first_row + step) / (double)work->n_rows);
        if (params->progress && !params->progress(done, params->context))
            return err_cancelled(err);
    }
    return STATUS_OK;
}

static Status prepare(VoxelWork *work, Err *err)
{
    const VoxelGrid *grid = &work->params->grid;
    work->threads = work->params->threads > 0 ? work->params->threads : threads_available();
    work->rows_per_chunk = rows_per_chunk(grid);
    work->n_rows = grid->n[1] * grid->n[2];
    work->n_chunks = (size_t)work->threads * CHUNKS_PER_THREAD;
    TRY(mem_calloc(&work->chunks, work->n_chunks, sizeof *work->chunks, "voxels", err));
    return mem_calloc(&work->workspaces, (size_t)work->threads, sizeof *work->workspaces, "threads",
                      err);
}

static void release_work(VoxelWork *work)
{
    for (int i = 0; work->workspaces && i < work->threads; i++)
        rowworkspace_release(&work->workspaces[i]);
    for (size_t i = 0; work->chunks && i < work->n_chunks; i++)
        release_chunk(&work->chunks[i]);
    free(work->workspaces);
    free(work->chunks);
    claims_release(&work->claims);
}

Status voxels_write(const Geometry *geometry, const VoxelParams *params, VoxelReport *report,
                    Err *err)
{
    Bodies bodies = {0};
    VoxelWork work = {.params = params,
                      .streams = {params->fraction, params->label, params->centreline}};
    VoxelReport made = {0};
    Status status;
    TRY_GOTO(bodies_make(geometry, &bodies, err));
    work.source = (RowSource){.bodies = &bodies,
                              .grid = &params->grid,
                              .type = params->fraction->type,
                              .labels = params->label ? params->labels : NULL};
    TRY_GOTO(prepare(&work, err));
    if (params->label)
        TRY_GOTO(claims_make(&work.source, geometry, &work.claims, err));
    made.n_reserved_labels = work.claims.n_taken;
    TRY_GOTO(make_chunks(&work, &made, err));
    for (int i = 0; i < VOLUMES; i++)
        if (work.streams[i])
            volume_end(work.streams[i]);
    *report = made;
done:
    release_work(&work);
    bodies_release(&bodies);
    return status;
}
