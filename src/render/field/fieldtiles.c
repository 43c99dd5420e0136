/* Segments are moved to the camera's frame once, in double precision, and counted into the rows of
 * tiles that their support touches (a capsule: the segment, widened by its reach). A row of tiles
 * is the unit of work. For it every segment is clipped to the slab of space that the row's rays
 * fill, which gives the columns that it touches there, and with them the list of every tile; a list
 * holds its segments by rising index, whatever the number of threads. What the kernel leaves
 * undecided is cast ray by ray in double precision among the terms of the tile. */
#include "render/field/fieldtiles.h"

#include "render/cast/fieldcast.h"
#include "render/field/fieldterms.h"
#include "surface/surface.h"
#include <limits.h>
#include <stdlib.h>
#include <string.h>

typedef struct Workspace {
    TileSpan *columns; /* of the row's segments; as long as the longest row */
    uint32_t *offsets; /* of the row's tiles into `lists`; one more than there are tiles */
    uint32_t *lists;
    size_t lists_capacity;
    TileTerm *terms;
    size_t terms_capacity;
    uint32_t *candidates; /* segments of the terms; as long as `terms` */
    size_t candidates_capacity;
    TileWork work;
    FieldScratch *scratch; /* made when first needed */
    size_t scratch_capacity;
} Workspace;

/* Where the samples of a column or a row of tiles are in the camera's plane. */
typedef struct TilePlaces {
    double middle, half;
    float samples[TILE_SAMPLES]; /* from the middle; those outside the grid repeat its last */
} TilePlaces;

struct FieldTiles {
    const Geometry *geometry;
    Camera camera;
    SampleGrid grid;
    Viewpoint eye;
    double width, height; /* of the picture, in the camera's plane */
    double z_min;
    double *x, *y;       /* of the grid's columns and rows, in the camera's plane */
    double per_x, per_y; /* samples in a unit there, per_y below 0 */
    TilePlaces *tile_x, *tile_y;
    int tile_columns, tile_rows;
    FrameSegment *segments;
    size_t *row_offsets; /* into row_segments; one more than there are rows */
    uint32_t *row_segments;
    FieldKernel *trace;
    Workspace *workspaces;
    int workers;
};

/* 1: all in front of the camera, or orthographic; -1: all behind; 0: beside it. */
static int side_of_camera(const FieldTiles *tiles, const FrameSegment *segment)
{
    if (!tiles->eye.perspective)
        return 1;
    double near = min_of(segment->a.z, segment->b.z), far = max_of(segment->a.z, segment->b.z);
    return near > segment->reach * (1 + 1e-9) ? 1 : far < -segment->reach ? -1 : 0;
}

static TileSpan rows_of(const FieldTiles *tiles, const FrameSegment *segment)
{
    int side = side_of_camera(tiles, segment);
    if (side < 0)
        return NOWHERE;
    Interval range = {-HUGE_VAL, HUGE_VAL};
    if (side > 0)
        range = capsule_shadow(tiles->eye.perspective, segment->a.y, segment->a.z, segment->b.y,
                               segment->b.z, segment->reach);
    return tiles_within(samples_within(range, tiles->y[0], tiles->per_y), 0, tiles->grid.n_rows);
}

enum { CHUNK = 2048 };

static void prepare_chunk(size_t chunk, int worker, void *context)
{
    (void)worker;
    FieldTiles *tiles = context;
    const Geometry *geometry = tiles->geometry;
    size_t end =
        (chunk + 1) * CHUNK < geometry->n_segments ? (chunk + 1) * CHUNK : geometry->n_segments;
    for (size_t i = chunk * CHUNK; i < end; i++) {
        const FieldSegment *segment = &geometry->segments[i];
        Vec3 span = vec3_sub(segment->b, segment->a);
        FrameSegment *out = &tiles->segments[i];
        *out = (FrameSegment){.a = viewpoint_place(&tiles->eye, segment->a),
                              .b = viewpoint_place(&tiles->eye, segment->b),
                              .length = vec3_length(span),
                              .k = potential_k(segment->radius_mm)};
        out->axis = vec3_scale(viewpoint_to_frame(&tiles->eye, span), 1 / out->length);
        out->sine = sqrt(out->axis.x * out->axis.x + out->axis.y * out->axis.y);
        out->per_sine = out->sine > 0 ? 1 / out->sine : 0;
        double reach2 = log(potential_term_peak(segment) / TILE_TERM_CUTOFF);
        TileSpan rows = {1, 0};
        if (reach2 > 0) {
            out->reach = sqrt(reach2) / out->k;
            rows = rows_of(tiles, out);
        }
        out->first_row = rows.first;
        out->last_row = rows.last;
    }
}

/* Counting sort of the segments into rows. */
static Status sort_into_rows(FieldTiles *tiles, Err *err)
{
    size_t n = tiles->geometry->n_segments, total = 0;
    size_t *offsets = tiles->row_offsets;
    for (size_t i = 0; i < n; i++)
        for (int row = tiles->segments[i].first_row; row <= tiles->segments[i].last_row; row++)
            offsets[row + 1]++;
    for (int row = 0; row < tiles->tile_rows; row++) {
        total += offsets[row + 1];
        offsets[row + 1] = total;
    }
    TRY(mem_calloc(&tiles->row_segments, total, sizeof *tiles->row_segments, "rows of tiles", err));
    for (size_t i = n; i-- > 0;)
        for (int row = tiles->segments[i].first_row; row <= tiles->segments[i].last_row; row++)
            tiles->row_segments[--offsets[row + 1]] = (uint32_t)i;
    for (int row = 0; row < tiles->tile_rows; row++)
        offsets[row] = offsets[row + 1];
    offsets[tiles->tile_rows] = total;
    return STATUS_OK;
}

static double row_height(const FieldTiles *tiles, double row)
{
    return (0.5 - (row + 0.5) / tiles->camera.height) * tiles->height;
}

static void place_grid(FieldTiles *tiles)
{
    const SampleGrid *grid = &tiles->grid;
    const Camera *camera = &tiles->camera;
    for (int i = 0; i < grid->n_columns; i++)
        tiles->x[i] = ((grid->columns[i] + 0.5) / camera->width - 0.5) * tiles->width;
    for (int j = 0; j < grid->n_rows; j++)
        tiles->y[j] = row_height(tiles, grid->rows[j]);
    tiles->per_x = camera->width / (grid->spacing * tiles->width);
    tiles->per_y = -camera->height / (grid->spacing * tiles->height);
}

static void place_tiles(const double *places, int count, int (*place_of)(int sample),
                        TilePlaces *tiles)
{
    for (int first = 0; first < count; first += TILE_SIDE) {
        TilePlaces *tile = &tiles[first / TILE_SIDE];
        int last = first + TILE_SIDE - 1 < count - 1 ? first + TILE_SIDE - 1 : count - 1;
        tile->middle = (places[first] + places[last]) / 2;
        tile->half = fabs(places[last] - tile->middle);
        for (int sample = 0; sample < TILE_SAMPLES; sample++) {
            int place = first + place_of(sample);
            tile->samples[sample] = (float)(places[place < last ? place : last] - tile->middle);
        }
    }
}

static Status make_workspaces(FieldTiles *tiles, Err *err)
{
    size_t longest = 0;
    for (int row = 0; row < tiles->tile_rows; row++) {
        size_t n = tiles->row_offsets[row + 1] - tiles->row_offsets[row];
        longest = n > longest ? n : longest;
    }
    TRY(mem_calloc(&tiles->workspaces, (size_t)tiles->workers, sizeof *tiles->workspaces,
                   "workspaces", err));
    for (int i = 0; i < tiles->workers; i++) {
        Workspace *space = &tiles->workspaces[i];
        TRY(mem_calloc(&space->columns, longest, sizeof *space->columns, "rows of tiles", err));
        TRY(mem_calloc(&space->offsets, (size_t)tiles->tile_columns + 1, sizeof *space->offsets,
                       "tiles", err));
    }
    return STATUS_OK;
}

Status fieldtiles_new(const Geometry *geometry, const Camera *camera, const SampleGrid *grid,
                      double z_min, int workers, FieldTiles **out, Err *err)
{
    Status status;
    FieldTiles *tiles = NULL;
    TRY_GOTO(mem_calloc(&tiles, 1, sizeof *tiles, "tiles", err));
    tiles->geometry = geometry;
    tiles->camera = *camera;
    tiles->grid = *grid;
    tiles->z_min = z_min;
    tiles->workers = workers;
    tiles->trace = fieldkernels[kernels_kind(KERNELS_FASTEST)];
    tiles->eye = viewpoint_of_camera(camera);
    tiles->width = vec3_length(camera->right);
    tiles->height = vec3_length(camera->up);
    tiles->tile_columns = (grid->n_columns + TILE_SIDE - 1) / TILE_SIDE;
    tiles->tile_rows = (grid->n_rows + TILE_SIDE - 1) / TILE_SIDE;
    TRY_GOTO(mem_calloc(&tiles->x, (size_t)grid->n_columns, sizeof *tiles->x, "columns", err));
    TRY_GOTO(mem_calloc(&tiles->y, (size_t)grid->n_rows, sizeof *tiles->y, "rows", err));
    TRY_GOTO(mem_calloc(&tiles->tile_x, (size_t)tiles->tile_columns, sizeof *tiles->tile_x,
                        "columns", err));
    TRY_GOTO(
        mem_calloc(&tiles->tile_y, (size_t)tiles->tile_rows, sizeof *tiles->tile_y, "rows", err));
    place_grid(tiles);
    place_tiles(tiles->x, grid->n_columns, tile_sample_x, tiles->tile_x);
    place_tiles(tiles->y, grid->n_rows, tile_sample_y, tiles->tile_y);
    TRY_GOTO(mem_calloc(&tiles->segments, geometry->n_segments, sizeof *tiles->segments, "segments",
                        err));
    TRY_GOTO(mem_calloc(&tiles->row_offsets, (size_t)tiles->tile_rows + 1,
                        sizeof *tiles->row_offsets, "rows of tiles", err));
    threads_for((geometry->n_segments + CHUNK - 1) / CHUNK, workers, prepare_chunk, tiles);
    TRY_GOTO(sort_into_rows(tiles, err));
    TRY_GOTO(make_workspaces(tiles, err));
    *out = tiles;
    return STATUS_OK;
done:
    fieldtiles_free(tiles);
    return status;
}

void fieldtiles_free(FieldTiles *tiles)
{
    if (!tiles)
        return;
    for (int i = 0; tiles->workspaces && i < tiles->workers; i++) {
        Workspace *space = &tiles->workspaces[i];
        free(space->columns);
        free(space->offsets);
        free(space->lists);
        free(space->terms);
        free(space->candidates);
        tilework_release(&space->work);
        fieldscratch_free(space->scratch);
    }
    free(tiles->workspaces);
    free(tiles->x);
    free(tiles->y);
    free(tiles->tile_x);
    free(tiles->tile_y);
    free(tiles->segments);
    free(tiles->row_offsets);
    free(tiles->row_segments);
    free(tiles);
}

size_t fieldtiles_rows(const FieldTiles *tiles)
{
    return (size_t)tiles->tile_rows;
}

void fieldtiles_use_kernel(FieldTiles *tiles, FieldKernel *trace)
{
    tiles->trace = trace;
}

size_t fieldtiles_columns(const FieldTiles *tiles)
{
    return (size_t)tiles->tile_columns;
}

static double above(const FieldTiles *tiles, Vec3 p, double y)
{
    return tiles->eye.perspective ? (p.y - y * p.z) / sqrt(1 + y * y) : p.y - y;
}

/* The tiles of a row, whose rays are between y_low and y_high, that the support of the segment may
 * touch: those of the part of the segment that is within reach of the slab. */
static TileSpan columns_of(const FieldTiles *tiles, const FrameSegment *segment, double y_low,
                           double y_high)
{
    if (side_of_camera(tiles, segment) == 0)
        return (TileSpan){0, tiles->tile_columns - 1};
    double from = 0, to = 1;
    const double heights[2][2] = {
        {above(tiles, segment->a, y_low), above(tiles, segment->b, y_low)},
        {-above(tiles, segment->a, y_high), -above(tiles, segment->b, y_high)}};
    for (int plane = 0; plane < 2; plane++)
        clip_part(heights[plane][0] + segment->reach, heights[plane][1] + segment->reach, &from,
                  &to);
    if (from > to)
        return NOWHERE;
    Vec3 span = vec3_sub(segment->b, segment->a);
    Vec3 first = vec3_add_scaled(segment->a, span, from);
    Vec3 last = vec3_add_scaled(segment->a, span, to);
    Interval range =
        capsule_shadow(tiles->eye.perspective, first.x, first.z, last.x, last.z, segment->reach);
    return tiles_within(samples_within(range, tiles->x[0], tiles->per_x), 0, tiles->grid.n_columns);
}

/* Fills offsets and lists of the row, and makes room for the terms of its longest. */
static Status list_row(const FieldTiles *tiles, size_t row, Workspace *space, Err *err)
{
    const uint32_t *segments = tiles->row_segments + tiles->row_offsets[row];
    size_t n = tiles->row_offsets[row + 1] - tiles->row_offsets[row];
    int first = (int)row * TILE_SIDE, last = first + TILE_SIDE - 1;
    last = last < tiles->grid.n_rows ? last : tiles->grid.n_rows - 1;
    uint32_t *offsets = space->offsets;
    for (int i = 0; i <= tiles->tile_columns; i++)
        offsets[i] = 0;
    for (size_t i = 0; i < n; i++) {
        TileSpan span =
            columns_of(tiles, &tiles->segments[segments[i]], tiles->y[last], tiles->y[first]);
        space->columns[i] = span;
        for (int column = span.first; column <= span.last; column++)
            offsets[column + 1]++;
    }
    size_t total = 0, longest = 0;
    for (int i = 1; i <= tiles->tile_columns; i++) {
        longest = offsets[i] > longest ? offsets[i] : longest;
        total += offsets[i];
        if (total > UINT32_MAX)
            return err_set(err, STATUS_MEMORY, "too many segments in one row of the picture");
        offsets[i] = (uint32_t)total;
    }
    TRY(mem_reserve(&space->lists, &space->lists_capacity, total, sizeof *space->lists, "tiles",
                    err));
    TRY(mem_reserve(&space->terms, &space->terms_capacity, longest, sizeof *space->terms, "terms",
                    err));
    TRY(mem_reserve(&space->candidates, &space->candidates_capacity, longest,
                    sizeof *space->candidates, "terms", err));
    TRY(tilework_reserve(&space->work, longest, err));
    for (size_t i = n; i-- > 0;)
        for (int column = space->columns[i].first; column <= space->columns[i].last; column++)
            space->lists[--offsets[column + 1]] = segments[i];
    for (int i = 0; i < tiles->tile_columns; i++)
        offsets[i] = offsets[i + 1];
    offsets[tiles->tile_columns] = (uint32_t)total;
    return STATUS_OK;
}

/* Sets what all tiles of a row share. */
static void place_row(const FieldTiles *tiles, size_t row, FieldTile *tile)
{
    const TilePlaces *y = &tiles->tile_y[row];
    *tile = (FieldTile){.blend = &tiles->geometry->blend,
                        .perspective = tiles->eye.perspective,
                        .y = y->samples,
                        .middle_y = y->middle,
                        .z_min = tiles->z_min};
}

/* Sets the rest but for the terms. */
static void place_column(const FieldTiles *tiles, size_t column, size_t row, FieldTile *tile)
{
    const TilePlaces *x = &tiles->tile_x[column], *y = &tiles->tile_y[row];
    tile->x = x->samples;
    tile->middle_x = x->middle;
    tile->half_size = (float)sqrt(x->half * x->half + y->half * y->half);
}

static SeenTile place_samples(const FieldTiles *tiles, int column, size_t row)
{
    const TilePlaces *x = &tiles->tile_x[column], *y = &tiles->tile_y[row];
    return (SeenTile){.column = column * TILE_SIDE,
                      .row = (int)row * TILE_SIDE,
                      .n_columns = tile_extent(tiles->grid.n_columns - column * TILE_SIDE),
                      .n_rows = tile_extent(tiles->grid.n_rows - (int)row * TILE_SIDE),
                      .perspective = tiles->eye.perspective,
                      .x = x->samples,
                      .y = y->samples,
                      .middle_x = x->middle,
                      .middle_y = y->middle};
}

static Status grow_scratch(Workspace *space, size_t n, Err *err)
{
    if (n <= space->scratch_capacity)
        return STATUS_OK;
    FieldScratch *larger;
    size_t capacity = n > 2 * space->scratch_capacity ? n : 2 * space->scratch_capacity;
    TRY(fieldscratch_new(capacity, &larger, err));
    fieldscratch_free(space->scratch);
    space->scratch = larger;
    space->scratch_capacity = capacity;
    return STATUS_OK;
}

/* Decides one sample in double precision. */
static Status decide(const FieldTiles *tiles, Workspace *space, const FieldTile *tile, Ray ray,
                     int sample, TileHits *hits, Err *err)
{
    TRY(grow_scratch(space, tile->n_terms, err));
    double t;
    Vec3 normal;
    uint32_t segment = 0;
    hits->state[sample] = TILE_MISS;
    if (!field_first_hit_among(tiles->geometry, space->candidates, tile->n_terms, space->scratch,
                               ray, tiles->z_min, HUGE_VAL, &t, &normal, &segment))
        return STATUS_OK;
    bool within = vec3_dot(normal, ray.direction) > 0;
    normal = viewpoint_to_frame(&tiles->eye, within ? vec3_scale(normal, -1) : normal);
    hits->any_hit = true;
    hits->state[sample] = TILE_HIT;
    hits->z[sample] = t * vec3_dot(ray.direction, tiles->eye.axes[2]);
    hits->normal[0][sample] = (float)normal.x;
    hits->normal[1][sample] = (float)normal.y;
    hits->normal[2][sample] = (float)normal.z;
    hits->segment[sample] = segment;
    return STATUS_OK;
}

static Status decide_all(const FieldTiles *tiles, Workspace *space, const FieldTile *tile,
                         const SeenTile *seen, TileHits *hits, Err *err)
{
    const SampleGrid *grid = &tiles->grid;
    for (int sample = 0; hits->any_unsure && sample < TILE_SAMPLES; sample++) {
        int i = tile_sample_x(sample), j = tile_sample_y(sample);
        if (hits->state[sample] != TILE_UNSURE || i >= seen->n_columns || j >= seen->n_rows)
            continue;
        Ray ray =
            camera_ray(&tiles->camera, grid->columns[seen->column + i], grid->rows[seen->row + j]);
        TRY(decide(tiles, space, tile, ray, sample, hits, err));
    }
    return STATUS_OK;
}

Status fieldtiles_trace(FieldTiles *tiles, size_t row, int worker, const uint8_t *wanted,
                        TileVisitor *visit, void *context, Err *err)
{
    Workspace *space = &tiles->workspaces[worker];
    FieldTile tile;
    TRY(list_row(tiles, row, space, err));
    place_row(tiles, row, &tile);
    for (int column = 0; column < tiles->tile_columns; column++) {
        if (wanted && !wanted[column])
            continue;
        TileHits hits;
        SeenTile seen = place_samples(tiles, column, row);
        if (space->offsets[column] < space->offsets[column + 1]) {
            place_column(tiles, (size_t)column, row, &tile);
            uint32_t list = space->offsets[column];
            fieldterms_make(tiles->segments, space->lists + list, space->offsets[column + 1] - list,
                            &tile, space->terms, space->candidates);
            if (tile.n_terms) {
                tiles->trace(&tile, &space->work, &hits);
                TRY(decide_all(tiles, space, &tile, &seen, &hits, err));
                seen.hits = hits.any_hit ? &hits : NULL;
            }
        }
        visit(&seen, worker, context);
    }
    return STATUS_OK;
}
