/* Items are counted into the rows of tiles that a capsule about them touches; chunks of items
 * have counters of their own, so that threads fill the rows without waiting and in the order of
 * the items. The list of a row's tiles is made when the row is drawn, from the part of each
 * capsule that is within reach of the row's slab. */
#include "render/rasterview.h"

#include "render/rasteritem.h"
#include <stdlib.h>

enum { LEAST_CHUNK = 4096, MOST_CHUNKS = 64 };

static const double slack_pixels = 1e-3; /* covers rounding where tiles are told apart */

RasterView rasterview_of_camera(const Scene *scene, int first, int rows, int antialias)
{
    const Camera *camera = &scene->camera;
    double width = vec3_length(camera->right), height = vec3_length(camera->up);
    double near, far;
    scene_depth_range(scene, &near, &far);
    return (RasterView){.location = camera->location,
                        .axes = {vec3_normalized(camera->right), vec3_normalized(camera->up),
                                 vec3_normalized(camera->direction)},
                        .perspective = camera->projection == PROJECTION_PERSPECTIVE,
                        .left = (0.5 / camera->width - 0.5) * width,
                        .top = (0.5 - 0.5 / camera->height) * height,
                        .step_x = width / camera->width,
                        .step_y = -height / camera->height,
                        .columns = camera->width,
                        .rows = rows,
                        .first = first,
                        .stray = antialias > 1 ? 0.5 : 0,
                        .z_middle = (near + far) / 2};
}

Ray rasterview_ray(const RasterView *view, double x, double y)
{
    Vec3 across = vec3_add_scaled(vec3_scale(view->axes[0], x), view->axes[1], y);
    if (view->perspective)
        return (Ray){view->location, vec3_normalized(vec3_add(view->axes[2], across))};
    return (Ray){vec3_add(view->location, across), view->axes[2]};
}

Vec3 rasterview_to_frame(const RasterView *view, Vec3 v)
{
    return vec3(vec3_dot(v, view->axes[0]), vec3_dot(v, view->axes[1]), vec3_dot(v, view->axes[2]));
}

Vec3 rasterview_to_world(const RasterView *view, Vec3 v)
{
    Vec3 world = vec3_add_scaled(vec3_scale(view->axes[0], v.x), view->axes[1], v.y);
    return vec3_add_scaled(world, view->axes[2], v.z);
}

/* ---- where items are seen -------------------------------------------------------------------- */

typedef struct Range {
    double low, high;
} Range;

typedef struct Span {
    int first, last;
} Span;

static const Span nowhere = {1, 0};

static double min_of(double a, double b)
{
    return a < b ? a : b;
}

static double max_of(double a, double b)
{
    return a > b ? a : b;
}

/* Of `count` pixels from pixel `least` on, the tiles within a range; pixel 0 is at `first`, and
 * `per` pixels follow in a unit. */
static Span tiles_within(Range range, double first, double per, double stray, int least, int count)
{
    double from = (range.low - first) * per, to = (range.high - first) * per;
    double low = max_of(min_of(from, to) - stray - slack_pixels, least);
    double high = min_of(max_of(from, to) + stray + slack_pixels, least + count - 1);
    if (!(low <= high))
        return nowhere;
    int first_pixel = (int)low - least, last_pixel = (int)high - least;
    first_pixel += first_pixel + least < low;
    return first_pixel <= last_pixel ? (Span){first_pixel / TILE_SIDE, last_pixel / TILE_SIDE}
                                     : nowhere;
}

/* What a ball at coordinate c in one direction of a perspective view's plane, and at depth z >
 * radius, covers there. */
static Range ball_shadow(double c, double z, double radius)
{
    double half = radius * sqrt(max_of(c * c + z * z - radius * radius, 0));
    double per = 1 / ((z - radius) * (z + radius));
    return (Range){(c * z - half) * per, (c * z + half) * per};
}

static Vec3 item_axis(const RasterItem *item)
{
    double sine = (double)item->sine;
    return vec3(sine * (double)item->ex, sine * (double)item->ey, (double)item->cosine);
}

static Vec3 item_point(const RasterItem *item, double along)
{
    return vec3_add_scaled(vec3(item->x, item->y, item->z), item_axis(item), along);
}

static Range capsule_shadow(double c0, double z0, double c1, double z1, double radius)
{
    Range one = ball_shadow(c0, z0, radius), other = ball_shadow(c1, z1, radius);
    return (Range){min_of(one.low, other.low), max_of(one.high, other.high)};
}

static bool may_be_anywhere(const RasterView *view, const RasterItem *item)
{
    return view->perspective && item_is_close(item);
}

static Span rows_of(const RasterView *view, const RasterItem *item)
{
    double half = (double)item->half, radius = (double)item->radius;
    if (item->z + (double)item->cosine * half + radius < 0)
        return nowhere;
    if (may_be_anywhere(view, item))
        return (Span){0, (view->rows - 1) / TILE_SIDE};
    double reach = fabs((double)item->ey) * (double)item->sine * half + radius;
    Range range = {item->y - reach, item->y + reach};
    if (view->perspective) {
        Vec3 a = item_point(item, -half), b = item_point(item, half);
        range = capsule_shadow(a.y, a.z, b.y, b.z, radius);
    }
    return tiles_within(range, view->top, view->per_y, view->stray, view->first, view->rows);
}

/* The slab that the lines of sight of a row of tiles fill. */
typedef struct Slab {
    double y[2], per_length[2]; /* lowest and highest */
} Slab;

static Slab slab_of(const RasterView *view, size_t row)
{
    int first = view->first + (int)row * TILE_SIDE, last = first + TILE_SIDE - 1;
    Slab slab;
    slab.y[0] = view->top + (last + view->stray + slack_pixels) * view->step_y;
    slab.y[1] = view->top + (first - view->stray - slack_pixels) * view->step_y;
    for (int i = 0; i < 2; i++)
        slab.per_length[i] = 1 / sqrt(1 + slab.y[i] * slab.y[i]);
    return slab;
}

/* The part [*from, *to] of the way where something that is at_a at its beginning and at_b at its
 * end is not below 0. */
static void clip_part(double at_a, double at_b, double *from, double *to)
{
    if (at_a < 0)
        *from = at_b < 0 ? HUGE_VAL : max_of(*from, at_a / (at_a - at_b));
    else if (at_b < 0)
        *to = min_of(*to, at_a / (at_a - at_b));
}

/* What the part of the capsule within reach of the slab covers of a row; empty: nothing. */
static Range parallel_range(const RasterItem *item, const Slab *slab)
{
    double radius = (double)item->radius, ex = (double)item->ex, ey = (double)item->ey;
    double half = (double)item->sine * (double)item->half, low = -half, high = half;
    double below = slab->y[0] - radius - item->y, over = slab->y[1] + radius - item->y;
    double rise = fabs(ey) * half;
    if (-rise > over || rise < below)
        return (Range){1, 0};
    if (-rise < below || rise > over) {
        double per = 1 / ey, one = below * per, other = over * per;
        low = max_of(low, min_of(one, other));
        high = min_of(high, max_of(one, other));
    }
    double from = ex * low, to = ex * high;
    return (Range){item->x + min_of(from, to) - radius, item->x + max_of(from, to) + radius};
}

static Range perspective_range(const RasterItem *item, const Slab *slab)
{
    double half = (double)item->half, radius = (double)item->radius, from = 0, to = 1;
    Vec3 a = item_point(item, -half), span = vec3_scale(item_axis(item), 2 * half);
    Vec3 b = vec3_add(a, span);
    for (int plane = 0; plane < 2; plane++) {
        double sign = plane ? -slab->per_length[plane] : slab->per_length[plane];
        double y = slab->y[plane];
        clip_part(sign * (a.y - y * a.z) + radius, sign * (b.y - y * b.z) + radius, &from, &to);
    }
    if (from > to)
        return (Range){1, 0};
    Vec3 first = vec3_add_scaled(a, span, from), last = vec3_add_scaled(a, span, to);
    return capsule_shadow(first.x, first.z, last.x, last.z, radius);
}

/* The tiles of a row that the part of the capsule within reach of its slab may touch. */
static Span columns_of(const RasterView *view, const RasterItem *item, const Slab *slab)
{
    if (may_be_anywhere(view, item))
        return (Span){0, (view->columns - 1) / TILE_SIDE};
    Range range = view->perspective ? perspective_range(item, slab) : parallel_range(item, slab);
    if (range.low > range.high)
        return nowhere;
    return tiles_within(range, view->left, view->per_x, view->stray, 0, view->columns);
}

/* ---- rows ------------------------------------------------------------------------------------ */

typedef struct Build {
    RasterBins *bins;
    Span *rows;             /* one an item */
    size_t *counts;         /* chunk by chunk, of each row; then where the chunk's items go */
    uint32_t *joints;       /* chunk by chunk: their number; then that of the first */
    size_t chunk, n_chunks; /* items in a chunk; chunks */
} Build;

static size_t chunk_end(const Build *build, size_t chunk)
{
    size_t end = (chunk + 1) * build->chunk, n = build->bins->scene->n_primitives;
    return end < n ? end : n;
}

static bool is_joint(const RasterBins *bins, size_t number)
{
    return bins->scene->model == SCENE_JOINED &&
           bins->scene->primitives[number].kind == PRIMITIVE_JOINT;
}

static void count_joints(size_t chunk, int worker, void *context)
{
    (void)worker;
    const Build *build = context;
    for (size_t i = chunk * build->chunk; i < chunk_end(build, chunk); i++)
        build->joints[chunk] += is_joint(build->bins, i);
}

static Status make_room_for_joints(Build *build, int threads, Err *err)
{
    RasterBins *bins = build->bins;
    uint32_t n = 0;
    TRY(mem_calloc(&build->joints, build->n_chunks, sizeof *build->joints, "joints", err));
    if (bins->scene->model == SCENE_JOINED)
        threads_for(build->n_chunks, threads, count_joints, build);
    for (size_t chunk = 0; chunk < build->n_chunks; chunk++) {
        uint32_t count = build->joints[chunk];
        build->joints[chunk] = n;
        n += count;
    }
    return mem_calloc(&bins->joints, (size_t)n + 1, sizeof *bins->joints, "joints", err);
}

static void make_chunk(size_t chunk, int worker, void *context)
{
    (void)worker;
    const Build *build = context;
    RasterBins *bins = build->bins;
    size_t *counts = build->counts + chunk * (size_t)bins->tile_rows;
    uint32_t joint = build->joints[chunk];
    for (size_t i = chunk * build->chunk; i < chunk_end(build, chunk); i++) {
        bins->items[i] =
            rasteritem_make(bins->scene, &bins->view, (uint32_t)i, joint, bins->joints);
        joint += is_joint(bins, i);
        build->rows[i] = rows_of(&bins->view, &bins->items[i]);
        for (int row = build->rows[i].first; row <= build->rows[i].last; row++)
            counts[row]++;
    }
}

static void fill_chunk(size_t chunk, int worker, void *context)
{
    (void)worker;
    const Build *build = context;
    size_t *places = build->counts + chunk * (size_t)build->bins->tile_rows;
    for (size_t i = chunk * build->chunk; i < chunk_end(build, chunk); i++)
        for (int row = build->rows[i].first; row <= build->rows[i].last; row++)
            build->bins->row_items[places[row]++] = (uint32_t)i;
}

static Status sort_into_rows(Build *build, int threads, Err *err)
{
    RasterBins *bins = build->bins;
    size_t n = bins->scene->n_primitives, rows = (size_t)bins->tile_rows, total = 0;
    size_t chunks = build->n_chunks;
    TRY(mem_calloc(&build->rows, n, sizeof *build->rows, "items", err));
    TRY(mem_calloc(&build->counts, chunks * rows, sizeof *build->counts, "rows of tiles", err));
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
    threads_for(chunks, threads, fill_chunk, build);
    return STATUS_OK;
}

static Status make_bins(RasterBins *bins, int threads, Err *err)
{
    const Scene *scene = bins->scene;
    if (scene->n_primitives >= RASTER_NUMBER)
        return err_set(err, STATUS_MEMORY, "too many primitives for --method raster");
    TRY(mem_calloc(&bins->items, scene->n_primitives, sizeof *bins->items, "items", err));
    TRY(mem_calloc(&bins->row_offsets, (size_t)bins->tile_rows + 1, sizeof *bins->row_offsets,
                   "rows of tiles", err));
    size_t n = scene->n_primitives, chunk = n / MOST_CHUNKS + 1;
    chunk = chunk > LEAST_CHUNK ? chunk : LEAST_CHUNK;
    Build build = {.bins = bins, .chunk = chunk, .n_chunks = (n + chunk - 1) / chunk};
    Status status = make_room_for_joints(&build, threads, err);
    if (status == STATUS_OK)
        status = sort_into_rows(&build, threads, err);
    free(build.rows);
    free(build.joints);
    free(build.counts);
    return status;
}

Status rasterbins_new(const Scene *scene, const RasterView *view, int threads, RasterBins **out,
                      Err *err)
{
    RasterBins *bins = NULL;
    TRY(mem_calloc(&bins, 1, sizeof *bins, "tiles", err));
    bins->scene = scene;
    bins->view = *view;
    bins->view.per_x = 1 / view->step_x;
    bins->view.per_y = 1 / view->step_y;
    bins->tile_columns = (view->columns + TILE_SIDE - 1) / TILE_SIDE;
    bins->tile_rows = (view->rows + TILE_SIDE - 1) / TILE_SIDE;
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
    free(bins->items);
    free(bins->joints);
    free(bins->row_offsets);
    free(bins->row_items);
    free(bins);
}

/* ---- tiles ----------------------------------------------------------------------------------- */

Status rasterbins_list(const RasterBins *bins, size_t number, RasterRow *row, Err *err)
{
    const uint32_t *items = bins->row_items + bins->row_offsets[number];
    size_t n = bins->row_offsets[number + 1] - bins->row_offsets[number], total = 0;
    size_t columns = (size_t)bins->tile_columns;
    if (!row->offsets)
        TRY(mem_calloc(&row->offsets, columns + 1, sizeof *row->offsets, "tiles", err));
    TRY(mem_reserve(&row->spans, &row->spans_capacity, 2 * n, sizeof *row->spans, "tiles", err));
    uint32_t *offsets = row->offsets;
    for (size_t i = 0; i <= columns; i++)
        offsets[i] = 0;
    const Slab slab = slab_of(&bins->view, number);
    for (size_t i = 0; i < n; i++) {
        Span span = columns_of(&bins->view, &bins->items[items[i]], &slab);
        row->spans[2 * i] = span.first;
        row->spans[2 * i + 1] = span.last;
        for (int column = span.first; column <= span.last; column++)
            offsets[column]++;
    }
    for (size_t i = 0; i <= columns; i++) {
        total += offsets[i];
        if (total > UINT32_MAX)
            return err_set(err, STATUS_MEMORY, "too many primitives in one row of the picture");
        offsets[i] = (uint32_t)total;
    }
    TRY(mem_reserve(&row->lists, &row->lists_capacity, total, sizeof *row->lists, "tiles", err));
    for (size_t i = n; i-- > 0;)
        for (int column = row->spans[2 * i]; column <= row->spans[2 * i + 1]; column++)
            row->lists[--offsets[column]] = items[i];
    return STATUS_OK;
}

void rasterrow_release(RasterRow *row)
{
    free(row->offsets);
    free(row->lists);
    free(row->spans);
    *row = (RasterRow){0};
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
                        .perspective = view->perspective,
                        .x = view->left + (column * TILE_SIDE + middle) * view->step_x,
                        .y = view->top + (view->first + row * TILE_SIDE + middle) * view->step_y,
                        .z_middle = view->z_middle};
}

static void set_blocks(const RasterGrid *grid, int size, float *x, float *y, float half[2])
{
    for (int block = 0; block < TILE_SAMPLES / size; block++) {
        int first = block * size, last = first + size - 1;
        x[block] = (grid->x[first] + grid->x[last]) / 2;
        y[block] = (grid->y[first] + grid->y[last]) / 2;
    }
    half[0] = (grid->x[size - 1] - grid->x[0]) / 2;
    half[1] = (grid->y[0] - grid->y[size - 1]) / 2;
}

RasterGrid rastergrid_make(const RasterView *view, double x, double y)
{
    const double middle = (TILE_SIDE - 1) / 2.0;
    RasterGrid grid;
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        grid.x[sample] = (float)((tile_sample_x(sample) - middle + x) * view->step_x);
        grid.y[sample] = (float)((tile_sample_y(sample) - middle + y) * view->step_y);
    }
    grid.reach =
        (float)((middle + fabs(x)) * view->step_x - (middle + fabs(y)) * view->step_y) * 1.0001f;
    set_blocks(&grid, 8, grid.block8_x, grid.block8_y, grid.block8_half);
    set_blocks(&grid, 4, grid.block4_x, grid.block4_y, grid.block4_half);
    return grid;
}
