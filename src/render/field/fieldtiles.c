/* A row of tiles is the unit of work: the lists of its tiles are made, and each tile's terms are
 * set out and traced by the kernel. What the kernel leaves undecided is cast ray by ray in double
 * precision among the terms of the tile. */
#include "render/field/fieldtiles.h"

#include "render/field/fieldspace.h"
#include <stdlib.h>

typedef struct Workspace {
    TileSpan *columns; /* of the row's segments; as long as the longest row */
    BinLists lists;    /* of the row's tiles */
    FieldSpace terms;
} Workspace;

/* Where the samples of a column or a row of tiles are in the camera's plane. */
typedef struct TilePlaces {
    double middle, half;
    float samples[TILE_SAMPLES]; /* from the middle; those outside the grid repeat its last */
} TilePlaces;

struct FieldTiles {
    const Geometry *geometry;
    Camera camera;
    VesselLists lists;
    double z_min;
    TilePlaces *tile_x, *tile_y;
    FieldKernel *trace;
    Workspace *workspaces;
    int workers;
};

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
    TRY(mem_calloc(&tiles->workspaces, (size_t)tiles->workers, sizeof *tiles->workspaces,
                   "workspaces", err));
    for (int i = 0; i < tiles->workers; i++) {
        Workspace *space = &tiles->workspaces[i];
        TRY(mem_calloc(&space->columns, tiles->lists.longest, sizeof *space->columns,
                       "rows of tiles", err));
        TRY(fieldspace_init(tiles->geometry, &space->terms, err));
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
    tiles->z_min = z_min;
    tiles->workers = workers;
    tiles->trace = fieldkernels_for(geometry, KERNELS_FASTEST)->trace;
    TRY_GOTO(vessellists_make(geometry, camera, grid, workers, &tiles->lists, err));
    const VesselLists *lists = &tiles->lists;
    TRY_GOTO(mem_calloc(&tiles->tile_x, (size_t)lists->tile_columns, sizeof *tiles->tile_x,
                        "columns", err));
    TRY_GOTO(
        mem_calloc(&tiles->tile_y, (size_t)lists->tile_rows, sizeof *tiles->tile_y, "rows", err));
    place_tiles(lists->x, grid->n_columns, tile_sample_x, tiles->tile_x);
    place_tiles(lists->y, grid->n_rows, tile_sample_y, tiles->tile_y);
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
        binlists_release(&space->lists);
        fieldspace_release(&space->terms);
    }
    free(tiles->workspaces);
    vessellists_release(&tiles->lists);
    free(tiles->tile_x);
    free(tiles->tile_y);
    free(tiles);
}

size_t fieldtiles_rows(const FieldTiles *tiles)
{
    return (size_t)tiles->lists.tile_rows;
}

void fieldtiles_use_kernel(FieldTiles *tiles, FieldKernel *trace)
{
    tiles->trace = trace;
}

size_t fieldtiles_columns(const FieldTiles *tiles)
{
    return (size_t)tiles->lists.tile_columns;
}

/* Makes the lists of the row's tiles, and room for the terms of the longest. */
static Status list_row(const FieldTiles *tiles, size_t row, Workspace *space, Err *err)
{
    size_t longest = 0;
    TRY(vessellists_row(&tiles->lists, row, space->columns, &space->lists, err));
    for (int i = 0; i < tiles->lists.tile_columns; i++) {
        size_t length = space->lists.offsets[i + 1] - space->lists.offsets[i];
        longest = length > longest ? length : longest;
    }
    return fieldspace_reserve(&space->terms, longest, err);
}

/* Sets what all tiles of a row share. */
static void place_row(const FieldTiles *tiles, size_t row, const Workspace *space, FieldTile *tile)
{
    const TilePlaces *y = &tiles->tile_y[row];
    *tile = (FieldTile){.groups = space->terms.groups,
                        .perspective = tiles->lists.eye.perspective,
                        .blob = model_has(tiles->geometry->model, MODEL_BLOB),
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
                      .n_columns = tile_extent(tiles->lists.grid.n_columns - column * TILE_SIDE),
                      .n_rows = tile_extent(tiles->lists.grid.n_rows - (int)row * TILE_SIDE),
                      .perspective = tiles->lists.eye.perspective,
                      .x = x->samples,
                      .y = y->samples,
                      .middle_x = x->middle,
                      .middle_y = y->middle};
}

/* Decides one sample in double precision. */
static Status decide(const FieldTiles *tiles, FieldSpace *space, const FieldTile *tile, Ray ray,
                     int sample, TileHits *hits, Err *err)
{
    TRY(fieldspace_reserve_rays(space, tile->n_terms, err));
    RayHit hit = {.index = 0};
    hits->state[sample] = TILE_MISS;
    if (!fieldspace_first_hit(space, tile->n_terms, ray, tiles->z_min, &hit))
        return STATUS_OK;
    bool within = vec3_dot(hit.normal, ray.direction) > 0;
    Vec3 normal =
        viewpoint_to_frame(&tiles->lists.eye, within ? vec3_scale(hit.normal, -1) : hit.normal);
    hits->any_hit = true;
    hits->state[sample] = TILE_HIT;
    hits->z[sample] = hit.t * vec3_dot(ray.direction, tiles->lists.eye.axes[2]);
    hits->normal[0][sample] = (float)normal.x;
    hits->normal[1][sample] = (float)normal.y;
    hits->normal[2][sample] = (float)normal.z;
    hits->segment[sample] = hit.index;
    return STATUS_OK;
}

static Status decide_all(const FieldTiles *tiles, FieldSpace *space, const FieldTile *tile,
                         const SeenTile *seen, TileHits *hits, Err *err)
{
    const SampleGrid *grid = &tiles->lists.grid;
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
    place_row(tiles, row, space, &tile);
    for (int column = 0; column < tiles->lists.tile_columns; column++) {
        if (wanted && !wanted[column])
            continue;
        TileHits hits;
        SeenTile seen = place_samples(tiles, column, row);
        const size_t *list = &space->lists.offsets[column];
        if (list[0] < list[1]) {
            place_column(tiles, (size_t)column, row, &tile);
            fieldterms_make(tiles->lists.segments, space->lists.items + list[0], list[1] - list[0],
                            &tile, space->terms.terms, space->terms.candidates);
            if (tile.n_terms) {
                tiles->trace(&tile, &space->terms.work, &hits);
                TRY(decide_all(tiles, &space->terms, &tile, &seen, &hits, err));
                seen.hits = hits.any_hit ? &hits : NULL;
            }
        }
        visit(&seen, worker, context);
    }
    return STATUS_OK;
}
