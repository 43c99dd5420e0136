/* Computes the samples and labels of whole rows of voxels.
 *
 * For each row that the box of a body meets, two tests find the voxels of the body. The line
 * through the middle of the row, intersected with the body widened by half the row's diagonal,
 * gives the voxels that the body may touch. The lines along the four edges of the row give the
 * voxels that lie wholly in the body, because it is convex. A sweep along the row then has the list
 * of bodies of each voxel. Only voxels that are not wholly in one body need cover_fraction. */
#include "voxel/rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void rowworkspace_release(RowWorkspace *workspace)
{
    ARRAY_RELEASE(&workspace->candidates);
    ARRAY_RELEASE(&workspace->touching);
    ARRAY_RELEASE(&workspace->spans);
    ARRAY_RELEASE(&workspace->active);
    cover_release(&workspace->coverage);
    *workspace = (RowWorkspace){0};
}

static int64_t clamped(double x, int64_t low, int64_t high)
{
    return x < (double)low ? low : x > (double)high ? high : (int64_t)x;
}

/* ---- spans ----------------------------------------------------------------------------------- */

/* Finds the voxels of the row that are wholly in the body: where the lines along the four edges of
 * the row are all in it. */
static void find_full(const VoxelGrid *grid, const Body *body, const VoxelCell *cell, Span *span)
{
    double low = -INFINITY, high = INFINITY;
    for (int edge = 0; edge < 4 && low < high; edge++) {
        double from, to;
        Vec3 at = vec3(cell->center.x - cell->half.x,
                       cell->center.y + (edge & 1 ? cell->half.y : -cell->half.y),
                       cell->center.z + (edge & 2 ? cell->half.z : -cell->half.z));
        if (!body_chord(body, at, 0, 0, 0, &from, &to))
            return;
        low = fmax(low, from);
        high = fmin(high, to);
    }
    span->full_first = clamped(ceil(low / grid->step.x), 0, grid->n[0]);
    span->full_end = clamped(floor(high / grid->step.x), 0, grid->n[0]);
}

/* Finds the span of a body in a row. `cell` is the row's first voxel. Returns false if the body
 * does not meet the row. */
static bool find_span(const VoxelGrid *grid, const Body *body, const VoxelCell *cell, Span *span)
{
    double low, high, diagonal = elementary_hypot(cell->half.y, cell->half.z);
    double longer = cell->half.y * fabs(body->axis.y) + cell->half.z * fabs(body->axis.z);
    if (!body_chord(body, cell->center, 0, diagonal, longer, &low, &high))
        return false;
    span->first = clamped(floor(low / grid->step.x + 0.5), 0, grid->n[0]);
    span->end = clamped(floor(high / grid->step.x + 0.5) + 1, 0, grid->n[0]);
    if (body->radius > diagonal)
        find_full(grid, body, cell, span);
    return span->first < span->end;
}

static Status add_row(const RowSource *source, uint32_t number, int64_t row,
                      RowWorkspace *workspace, Err *err)
{
    const VoxelGrid *grid = source->grid;
    VoxelCell cell = grid_cell(grid, 0, row % grid->n[1], row / grid->n[1]);
    Span span = {.row = row, .body = number};
    if (!find_span(grid, &source->bodies->body[number], &cell, &span))
        return STATUS_OK;
    return ARRAY_PUSH(&workspace->spans, "voxels", err, span);
}

/* Adds the spans of a body in the rows that the block and the body's box share. */
static Status add_body(const RowSource *source, const RowBlock *rows, uint32_t number,
                       RowWorkspace *workspace, Err *err)
{
    const VoxelGrid *grid = source->grid;
    Box box = body_box(&source->bodies->body[number]);
    int64_t end = rows->first_row + rows->n_rows, n_y = grid->n[1];
    int64_t low_z = grid_index(grid, 2, box.low.z), high_z = grid_index(grid, 2, box.high.z);
    int64_t low_y = grid_index(grid, 1, box.low.y), high_y = grid_index(grid, 1, box.high.y);
    low_z = low_z > rows->first_row / n_y ? low_z : rows->first_row / n_y;
    high_z = high_z < (end - 1) / n_y ? high_z : (end - 1) / n_y;
    for (int64_t z = low_z; z <= high_z; z++) {
        int64_t from = z * n_y + low_y, to = z * n_y + high_y;
        from = from > rows->first_row ? from : rows->first_row;
        to = to < end - 1 ? to : end - 1;
        for (int64_t row = from; row <= to; row++)
            TRY(add_row(source, number, row, workspace, err));
    }
    return STATUS_OK;
}

static int compare_spans(const void *a, const void *b)
{
    const Span *first = a, *second = b;
    if (first->row != second->row)
        return first->row < second->row ? -1 : 1;
    if (first->first != second->first)
        return first->first < second->first ? -1 : 1;
    return (first->body > second->body) - (first->body < second->body);
}

/* Lists the spans of all bodies in the rows, ordered by row and position. */
static Status find_spans(const RowSource *source, const RowBlock *rows, RowWorkspace *workspace,
                         Err *err)
{
    const VoxelGrid *grid = source->grid;
    int64_t last = rows->first_row + rows->n_rows - 1, n_y = grid->n[1];
    bool one_layer = rows->first_row / n_y == last / n_y;
    VoxelCell low =
        grid_cell(grid, 0, one_layer ? rows->first_row % n_y : 0, rows->first_row / n_y);
    VoxelCell high = grid_cell(grid, grid->n[0] - 1, one_layer ? last % n_y : n_y - 1, last / n_y);
    Box box = box_union(cell_box(&low), cell_box(&high));
    workspace->spans.n = 0;
    TRY(bodies_in(source->bodies, box, &workspace->candidates, err));
    for (size_t i = 0; i < workspace->candidates.n; i++)
        TRY(add_body(source, rows, workspace->candidates.items[i], workspace, err));
    if (workspace->spans.n)
        qsort(workspace->spans.items, workspace->spans.n, sizeof *workspace->spans.items,
              compare_spans);
    return STATUS_OK;
}

/* ---- voxels ---------------------------------------------------------------------------------- */

/* The samples of one row. */
typedef struct Row {
    const RowSource *source;
    RowBlock *rows;
    RowWorkspace *workspace;
    uint8_t *values;
    uint32_t *labels;
    int64_t y, z;
} Row;

/* Returns the integer sample of a voxel whose fraction `part` is filled; at least 1 if a vessel
 * axis passes the voxel. */
static double rounded(const Row *row, double part, const VoxelCell *cell)
{
    const BodyList *touching = &row->workspace->touching;
    double sample = floor(part * sample_full(row->source->type) + 0.5);
    for (size_t i = 0; i < touching->n && sample == 0; i++) {
        double from, to;
        sample = body_axis_in(&row->source->bodies->body[touching->items[i]], cell, &from, &to);
    }
    return sample;
}

/* Stores the sample of a partly filled voxel, and its label. */
static void put_value(const Row *row, int64_t x, double part, const VoxelCell *cell)
{
    SampleType type = row->source->type;
    double sample = type == SAMPLE_FLOAT ? part : rounded(row, part, cell);
    if (type == SAMPLE_8)
        row->values[x] = (uint8_t)sample;
    else if (type == SAMPLE_16)
        ((uint16_t *)(void *)row->values)[x] = (uint16_t)sample;
    else
        ((float *)(void *)row->values)[x] = (float)sample;
    row->rows->covered += part;
    row->rows->written += sample / sample_full(type);
    row->rows->n_nonzero += sample > 0;
    if (row->labels && sample > 0)
        row->labels[x] = row->source->labels[cell_owner(
            row->source->bodies, row->workspace->touching.items, row->workspace->touching.n, cell)];
}

/* Computes and stores the sample of a voxel from the bodies that meet it. */
static void fill_voxel(const Row *row, int64_t x)
{
    const RowSource *source = row->source;
    RowWorkspace *workspace = row->workspace;
    VoxelCell cell = grid_cell(source->grid, x, row->y, row->z);
    double part = cover_fraction(source->bodies->body, workspace->touching.items,
                                 workspace->touching.n, &cell, &workspace->coverage);
    if (part > 0)
        put_value(row, x, part, &cell);
}

/* Stores the samples of full voxels: all bits set, or 1 for floats. */
static void fill_run(const Row *row, int64_t x, int64_t end)
{
    SampleType type = row->source->type;
    if (type != SAMPLE_FLOAT)
        memset(row->values + (size_t)x * sample_size(type), 0xff,
               (size_t)(end - x) * sample_size(type));
    else
        for (int64_t i = x; i < end; i++)
            ((float *)(void *)row->values)[i] = 1;
    row->rows->covered += (double)(end - x);
    row->rows->written += (double)(end - x);
    row->rows->n_nonzero += end - x;
}

/* Returns the end of the run of full voxels that begins at x, or x if voxel x is not full. With
 * labels, a run is one voxel; *owner receives the segment of lowest id that fills it. */
static int64_t full_end(const Row *row, size_t n_active, int64_t x, uint32_t *owner)
{
    const RowWorkspace *workspace = row->workspace;
    const Bodies *bodies = row->source->bodies;
    int64_t end = x;
    *owner = UINT32_MAX;
    for (size_t i = 0; i < n_active; i++) {
        const Span *span = &workspace->spans.items[workspace->active.items[i]];
        uint32_t segment = bodies->body[span->body].segment;
        if (span->full_first > x || span->full_end <= x)
            continue;
        end = span->full_end > end ? span->full_end : end;
        if (*owner == UINT32_MAX || bodies->ids[segment] < bodies->ids[*owner])
            *owner = segment;
    }
    return row->labels && end > x ? x + 1 : end;
}

/* Lists the bodies of the active spans, which meet the current voxel. */
static void list_active(RowWorkspace *workspace, size_t n_active)
{
    workspace->touching.n = 0;
    for (size_t i = 0; i < n_active; i++)
        workspace->touching.items[workspace->touching.n++] =
            workspace->spans.items[workspace->active.items[i]].body;
}

/* Removes the spans that end before voxel x. Returns the number of spans that are left. */
static size_t drop_ended(RowWorkspace *workspace, size_t n_active, int64_t x)
{
    size_t kept = 0;
    for (size_t i = 0; i < n_active; i++)
        if (workspace->spans.items[workspace->active.items[i]].end > x)
            workspace->active.items[kept++] = workspace->active.items[i];
    return kept;
}

/* Computes the voxels of one row. Its spans are those with an index in [from, to). */
static void sweep(const Row *row, size_t from, size_t to)
{
    RowWorkspace *workspace = row->workspace;
    size_t n_active = 0, next = from;
    for (int64_t x = workspace->spans.items[from].first; next < to || n_active;) {
        uint32_t owner;
        if (!n_active && workspace->spans.items[next].first > x)
            x = workspace->spans.items[next].first;
        while (next < to && workspace->spans.items[next].first <= x)
            workspace->active.items[n_active++] = next++;
        n_active = drop_ended(workspace, n_active, x);
        if (!n_active)
            continue;
        int64_t end = full_end(row, n_active, x, &owner);
        if (end > x) {
            fill_run(row, x, end);
            if (row->labels)
                row->labels[x] = row->source->labels[owner];
            x = end;
        } else {
            list_active(workspace, n_active);
            fill_voxel(row, x++);
        }
    }
}

/* ---- centrelines ----------------------------------------------------------------------------- */

/* Marks the voxels of a row that the axis of a body passes. */
static void mark_axis(const RowSource *source, const Body *body, const VoxelCell *first,
                      uint8_t *marks)
{
    const VoxelGrid *grid = source->grid;
    double from, to, half = (double)grid->n[0] * first->half.x;
    VoxelCell row = *first;
    row.center.x += half - row.half.x;
    row.half.x = half;
    if (!body_axis_in(body, &row, &from, &to))
        return;
    int64_t a = grid_index(grid, 0, body->start.x + from * body->axis.x);
    int64_t b = grid_index(grid, 0, body->start.x + to * body->axis.x);
    memset(marks + (a < b ? a : b), 1, (size_t)(a < b ? b - a : a - b) + 1);
}

/* Computes one row, whose spans are those with an index in [from, to): samples, labels and
 * centrelines. */
static Status fill_row(const RowSource *source, RowWorkspace *workspace, RowBlock *rows,
                       size_t from, size_t to, Err *err)
{
    const VoxelGrid *grid = source->grid;
    int64_t number = workspace->spans.items[from].row;
    size_t at = (size_t)(number - rows->first_row) * (size_t)grid->n[0];
    Row row = {.source = source, .rows = rows, .workspace = workspace};
    row.y = number % grid->n[1];
    row.z = number / grid->n[1];
    row.values = rows->values + at * sample_size(source->type);
    row.labels = rows->labels ? rows->labels + at : NULL;
    workspace->touching.n = 0;
    TRY(ARRAY_RESERVE(&workspace->active, to - from, "vessels", err));
    TRY(ARRAY_RESERVE(&workspace->touching, to - from, "vessels", err));
    TRY(cover_reserve(&workspace->coverage, to - from, err));
    sweep(&row, from, to);
    VoxelCell first = grid_cell(grid, 0, row.y, row.z);
    for (size_t i = from; i < to && rows->centreline; i++)
        mark_axis(source, &source->bodies->body[workspace->spans.items[i].body], &first,
                  rows->centreline + at);
    return STATUS_OK;
}

Status rowblock_fill(const RowSource *source, RowWorkspace *workspace, RowBlock *rows, Err *err)
{
    TRY(find_spans(source, rows, workspace, err));
    for (size_t from = 0, to; from < workspace->spans.n; from = to) {
        for (to = from + 1; to < workspace->spans.n &&
                            workspace->spans.items[to].row == workspace->spans.items[from].row;)
            to++;
        TRY(fill_row(source, workspace, rows, from, to, err));
    }
    return STATUS_OK;
}
