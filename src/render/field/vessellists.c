/* Lists, for each tile of a view, the segments of an implicit surface that its rays may meet.
 *
 * Segments are transformed to the frame of the camera or light once, in double precision, and
 * sorted into the rows of tiles that their support touches. The support of a segment is the capsule
 * outside of which its term is negligible: all points within its reach. The lists of a row are made
 * when the row is drawn: each segment is clipped to the slab of space that the row's rays fill,
 * which gives the columns of tiles that it touches there. Segments ascend in each list, for any
 * number of threads. */
#include "render/field/vessellists.h"

#include "field/field.h"
#include <stdlib.h>
#include <string.h>

/* Lists, for each of `n_lists` tiles or rows of tiles, the items whose spans hold it. The items are
 * those of `items`, or 0 .. n - 1 if that is NULL; they ascend in each list. */
static Status list_spans(const TileSpan *spans, const uint32_t *items, size_t n, int n_lists,
                         IndexLists *lists, Err *err)
{
    TRY(indexlists_begin(lists, (size_t)n_lists, "tiles", err));
    for (size_t i = 0; i < n; i++)
        for (int at = spans[i].first; at <= spans[i].last; at++)
            indexlists_count(lists, (size_t)at);
    TRY(indexlists_allot(lists, "tiles", err));
    for (size_t i = 0; i < n; i++)
        for (int at = spans[i].first; at <= spans[i].last; at++)
            indexlists_put(lists, (size_t)at, items ? items[i] : (uint32_t)i);
    return STATUS_OK;
}

/* ---- rows ------------------------------------------------------------------------------------ */

/* Returns 1 if the support is in front of the camera or the view is orthographic, -1 if it is
 * behind the camera, 0 if it is beside the camera. */
static int side_of_camera(const VesselLists *lists, const FrameSegment *segment)
{
    if (!lists->eye.perspective)
        return 1;
    double near = min_of(segment->a.z, segment->b.z), far = max_of(segment->a.z, segment->b.z);
    return near > segment->reach * (1 + 1e-9) ? 1 : far < -segment->reach ? -1 : 0;
}

static TileSpan rows_of(const VesselLists *lists, const FrameSegment *segment)
{
    int side = side_of_camera(lists, segment);
    if (side < 0)
        return NO_TILES;
    Interval range = {-HUGE_VAL, HUGE_VAL};
    if (side > 0)
        range = capsule_extent(lists->eye.perspective, segment->a.y, segment->a.z, segment->b.y,
                               segment->b.z, segment->reach);
    TileSpan rows = tilespan_of_samples(interval_in_samples(range, lists->y[0], lists->per_y),
                                        lists->max_offset, lists->n_rows);
    return tilespan_intersection(rows, lists->listed_rows);
}

/* Segments that a thread transforms at a time: so many that taking a chunk costs nothing. The
 * result does not depend on it. */
enum { CHUNK = 2048 };

/* Returns the distance from the segment within which its term counts, mm; 0: nowhere. The peak of a
 * term of the potential, erf(x), is at most 1 and at most 2 x / sqrt(pi). */
static double reach_of(const Geometry *geometry, const FieldSegment *segment)
{
    if (model_has(geometry->model, MODEL_BLOB))
        return blob_reach(&blob_shape) * segment->radius_mm;
    double k = potential_k(segment->radius_mm);
    double peak = min_of(1, 0.56418958354775628695 * k * vec3_distance(segment->a, segment->b));
    return peak > TILE_TERM_CUTOFF ? sqrt(elementary_log(peak / TILE_TERM_CUTOFF)) / k : 0;
}

/* The arguments of the threads that transform segments. */
typedef struct SegmentsJob {
    const Geometry *geometry;
    VesselLists *lists;
} SegmentsJob;

/* Transforms the segments of a chunk, and finds their rows of tiles. */
static void prepare_chunk(size_t chunk, int worker, void *context)
{
    (void)worker;
    const SegmentsJob *job = context;
    VesselLists *lists = job->lists;
    size_t end = (chunk + 1) * CHUNK < lists->n_segments ? (chunk + 1) * CHUNK : lists->n_segments;
    for (size_t i = chunk * CHUNK; i < end; i++) {
        const FieldSegment *segment = &job->geometry->segments[i];
        Vec3 span = vec3_sub(segment->b, segment->a);
        FrameSegment *out = &lists->segments[i];
        *out = (FrameSegment){.a = viewpoint_frame_point(&lists->eye, segment->a),
                              .b = viewpoint_frame_point(&lists->eye, segment->b),
                              .length = vec3_length(span),
                              .k = potential_k(segment->radius_mm)};
        out->axis = vec3_scale(viewpoint_frame_direction(&lists->eye, span), 1 / out->length);
        out->sine = sqrt(out->axis.x * out->axis.x + out->axis.y * out->axis.y);
        out->per_sine = out->sine > 0 ? 1 / out->sine : 0;
        out->reach = reach_of(job->geometry, segment);
        const bool hidden = lists->hidden && lists->hidden[i];
        lists->segment_rows[i] = out->reach > 0 && !hidden ? rows_of(lists, out) : NO_TILES;
    }
}

/* Sorts the segments into rows. All other fields of the lists, including the sample positions, must
 * be set. */
static Status fill_lists(const Geometry *geometry, int threads, VesselLists *lists, Err *err)
{
    size_t n = lists->n_segments = geometry->n_segments;
    SegmentsJob job = {geometry, lists};
    TRY(mem_calloc(&lists->segments, n, sizeof *lists->segments, "segments", err));
    TRY(mem_calloc(&lists->segment_rows, n, sizeof *lists->segment_rows, "segments", err));
    threads_for((n + CHUNK - 1) / CHUNK, threads, prepare_chunk, &job);
    TRY(list_spans(lists->segment_rows, NULL, n, lists->tile_rows, &lists->rows, err));
    for (int row = 0; row < lists->tile_rows; row++) {
        size_t length = indexlists_length(&lists->rows, (size_t)row);
        lists->longest = length > lists->longest ? length : lists->longest;
    }
    return STATUS_OK;
}

/* Allocates the positions of a view's samples. */
static Status begin_lists(const Viewpoint *eye, int n_columns, int n_rows, VesselLists *lists,
                          Err *err)
{
    lists->eye = *eye;
    lists->n_columns = n_columns;
    lists->n_rows = n_rows;
    lists->tile_columns = (n_columns + TILE_SIDE - 1) / TILE_SIDE;
    lists->tile_rows = (n_rows + TILE_SIDE - 1) / TILE_SIDE;
    lists->listed_columns = (TileSpan){0, lists->tile_columns - 1};
    lists->listed_rows = (TileSpan){0, lists->tile_rows - 1};
    TRY(mem_calloc(&lists->x, (size_t)n_columns, sizeof *lists->x, "columns", err));
    return mem_calloc(&lists->y, (size_t)n_rows, sizeof *lists->y, "rows", err);
}

Status vessellists_make(const Geometry *geometry, const Camera *camera, const SampleGrid *grid,
                        int threads, VesselLists *lists, Err *err)
{
    const Viewpoint eye = viewpoint_of_camera(camera);
    const double spacing = 1.0 / grid->side;
    double width = vec3_length(camera->right), height = vec3_length(camera->up);
    TRY(begin_lists(&eye, grid->n_columns, grid->n_rows, lists, err));
    for (int i = 0; i < grid->n_columns; i++)
        lists->x[i] = ((samplegrid_at(grid, i) + 0.5) / camera->width - 0.5) * width;
    for (int j = 0; j < grid->n_rows; j++)
        lists->y[j] = (0.5 - (samplegrid_at(grid, j) + 0.5) / camera->height) * height;
    lists->per_x = camera->width / (spacing * width);
    lists->per_y = -camera->height / (spacing * height);
    return fill_lists(geometry, threads, lists, err);
}

Status vessellists_of_light(const Geometry *geometry, const LightView *view, int threads,
                            VesselLists *lists, Err *err)
{
    const int samples = view->tiles * TILE_SIDE;
    TRY(begin_lists(&view->eye, samples, samples, lists, err));
    for (int i = 0; i < samples; i++) {
        lists->x[i] = view->left + i * view->step_x;
        lists->y[i] = view->top + i * view->step_y;
    }
    lists->listed_columns = view->columns;
    lists->listed_rows = view->rows;
    lists->max_offset = 0.5 + SLACK_SAMPLES;
    lists->per_x = 1 / view->step_x;
    lists->per_y = 1 / view->step_y;
    return fill_lists(geometry, threads, lists, err);
}

void vessellists_release(VesselLists *lists)
{
    free(lists->x);
    free(lists->y);
    free(lists->segments);
    free(lists->segment_rows);
    indexlists_release(&lists->rows);
    *lists = (VesselLists){0};
}

/* ---- tiles of a row -------------------------------------------------------------------------- */

/* Returns the distance of a point above the plane of the lines of sight at the height y of the
 * view's plane. */
static double height_above(const VesselLists *lists, Vec3 p, double y)
{
    return lists->eye.perspective ? (p.y - y * p.z) / sqrt(1 + y * y) : p.y - y;
}

/* Returns the tiles of a row that the segment's support may touch: the tiles of the part of the
 * segment within reach of the slab between y_low and y_high. */
static TileSpan columns_of(const VesselLists *lists, const FrameSegment *segment, double y_low,
                           double y_high)
{
    if (side_of_camera(lists, segment) == 0)
        return lists->listed_columns;
    double from = 0, to = 1;
    const double heights[2][2] = {
        {height_above(lists, segment->a, y_low), height_above(lists, segment->b, y_low)},
        {-height_above(lists, segment->a, y_high), -height_above(lists, segment->b, y_high)}};
    for (int plane = 0; plane < 2; plane++)
        clip_parameters(heights[plane][0] + segment->reach, heights[plane][1] + segment->reach,
                        &from, &to);
    if (from > to)
        return NO_TILES;
    Vec3 span = vec3_sub(segment->b, segment->a);
    Vec3 first = vec3_add_scaled(segment->a, span, from);
    Vec3 last = vec3_add_scaled(segment->a, span, to);
    Interval range =
        capsule_extent(lists->eye.perspective, first.x, first.z, last.x, last.z, segment->reach);
    TileSpan columns = tilespan_of_samples(interval_in_samples(range, lists->x[0], lists->per_x),
                                           lists->max_offset, lists->n_columns);
    return tilespan_intersection(columns, lists->listed_columns);
}

Status vessellists_row(const VesselLists *lists, size_t row, TileSpan *columns, IndexLists *tiles,
                       Err *err)
{
    const uint32_t *segments = lists->rows.items + lists->rows.first[row];
    size_t n = indexlists_length(&lists->rows, (size_t)row);
    int first = (int)row * TILE_SIDE, last = first + TILE_SIDE - 1;
    last = last < lists->n_rows ? last : lists->n_rows - 1;
    double more = lists->max_offset / lists->per_y;
    for (size_t i = 0; i < n; i++)
        columns[i] = columns_of(lists, &lists->segments[segments[i]], lists->y[last] + more,
                                lists->y[first] - more);
    return list_spans(columns, segments, n, lists->tile_columns, tiles, err);
}
