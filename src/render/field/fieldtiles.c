/* The tile engine of implicit surfaces (isosurface and blob): finds the first hits of the samples
 * of a tile. The segments are sorted into rows of tiles once. When a row is drawn, the lists of its
 * tiles are made, and the kernel traces each tile's terms. Samples that the kernel cannot decide in
 * single precision are cast as single rays in double precision among the terms of the tile.
 *
 * Batches are as large as a shadow queue permits, and extend over 8 rows of tiles. More points then
 * fall into one tile of the light view, and their packets are full. The last digits of shadows
 * depend on which points share a packet, so other sizes would change pictures. */
#include "render/field/fieldtiles.h"

#include "render/cast/caster.h"
#include "render/engine.h"
#include "render/field/fieldkernels.h"
#include "render/field/fieldspace.h"
#include "render/field/vessellists.h"
#include <assert.h>
#include <stdlib.h>

/* The workspace of one thread. */
typedef struct FieldWorker {
    TileSpan *columns; /* per segment of a row: the tiles that it touches */
    IndexLists lists;  /* per tile of the row: its segments */
    FieldSpace space;
    FieldTile row; /* fields that all tiles of the row share */
} FieldWorker;

/* The samples of a column or a row of tiles, in the plane of the view. */
typedef struct TileAxis {
    double middle, half;
    float samples[TILE_SAMPLES]; /* positions from the middle; samples outside the grid repeat its
                                  * last position */
} TileAxis;

/* What TileEngine.bin makes. Nothing changes afterwards, except the workers. */
typedef struct FieldTiles {
    const Geometry *geometry; /* borrowed, like `camera` */
    const Camera *camera;
    SampleGrid grid;
    VesselLists lists;
    TileAxis *x, *y; /* per column and per row of tiles; owned */
    FieldKernel *trace;
    FieldWorker *workers; /* owned */
    int n_workers;
} FieldTiles;

/* Makes the axes of `count` samples at these positions. */
static Status make_axes(const double *at, int count, int (*sample_at)(int sample), TileAxis **axes,
                        Err *err)
{
    size_t n = ((size_t)count + TILE_SIDE - 1) / TILE_SIDE;
    TRY(mem_calloc(axes, n, sizeof **axes, "tiles", err));
    for (int first = 0; first < count; first += TILE_SIDE) {
        TileAxis *axis = &(*axes)[first / TILE_SIDE];
        int last = first + TILE_SIDE - 1 < count - 1 ? first + TILE_SIDE - 1 : count - 1;
        axis->middle = (at[first] + at[last]) / 2;
        axis->half = fabs(at[last] - axis->middle);
        for (int sample = 0; sample < TILE_SAMPLES; sample++) {
            int i = first + sample_at(sample);
            axis->samples[sample] = (float)(at[i < last ? i : last] - axis->middle);
        }
    }
    return STATUS_OK;
}

/* Allocates the workspaces of the workers. */
static Status make_workers(FieldTiles *tiles, Err *err)
{
    size_t n = (size_t)tiles->n_workers;
    TRY(mem_calloc(&tiles->workers, n, sizeof *tiles->workers, "workspaces", err));
    for (size_t i = 0; i < n; i++) {
        FieldWorker *own = &tiles->workers[i];
        TRY(mem_calloc(&own->columns, tiles->lists.longest, sizeof *own->columns, "rows of tiles",
                       err));
        TRY(fieldspace_init(tiles->geometry, &own->space, err));
    }
    return STATUS_OK;
}

static void release_field(void *bins)
{
    FieldTiles *tiles = bins;
    if (!tiles)
        return;
    for (int i = 0; tiles->workers && i < tiles->n_workers; i++) {
        FieldWorker *own = &tiles->workers[i];
        free(own->columns);
        indexlists_release(&own->lists);
        fieldspace_release(&own->space);
    }
    free(tiles->workers);
    vessellists_release(&tiles->lists);
    free(tiles->x);
    free(tiles->y);
    free(tiles);
}

/* Finds the tiles that the segments may reach, and the positions of the samples [TileEngine.bin].
 * */
static Status bin_field(const Drawing *drawing, const SampleGrid *grid, void **bins, Err *err)
{
    const RenderParams *params = drawing->params;
    Status status;
    FieldTiles *tiles = NULL;
    TRY_GOTO(mem_calloc(&tiles, 1, sizeof *tiles, "tiles", err));
    tiles->geometry = drawing->geometry;
    tiles->camera = &drawing->view->camera;
    tiles->grid = *grid;
    tiles->n_workers = params->threads;
    tiles->trace = fieldkernels_for(tiles->geometry, params->kernels)->trace;
    tiles->lists.hidden = drawing->hidden;
    TRY_GOTO(vessellists_make(tiles->geometry, tiles->camera, grid, params->threads, &tiles->lists,
                              err));
    TRY_GOTO(make_axes(tiles->lists.x, grid->n_columns, tile_sample_x, &tiles->x, err));
    TRY_GOTO(make_axes(tiles->lists.y, grid->n_rows, tile_sample_y, &tiles->y, err));
    TRY_GOTO(make_workers(tiles, err));
    *bins = tiles;
    return STATUS_OK;
done:
    release_field(tiles);
    return status;
}

/* Lists the segments of each tile of a row [TileEngine.list]. */
static Status list_field(void *bins, int row, int worker, Err *err)
{
    const FieldTiles *tiles = bins;
    FieldWorker *own = &tiles->workers[worker];
    size_t longest = 0;
    TRY(vessellists_row(&tiles->lists, (size_t)row, own->columns, &own->lists, err));
    for (int i = 0; i < tiles->lists.tile_columns; i++) {
        size_t length = indexlists_length(&own->lists, (size_t)i);
        longest = length > longest ? length : longest;
    }
    own->row = (FieldTile){.groups = own->space.groups,
                           .perspective = tiles->lists.eye.perspective,
                           .blob = model_has(tiles->geometry->model, MODEL_BLOB),
                           .y = tiles->y[row].samples,
                           .middle_y = tiles->y[row].middle,
                           .z_min = caster_nearest_mm(tiles->geometry)};
    return fieldspace_reserve(&own->space, longest, err);
}

static bool is_field_listed(const void *bins, int column, int worker)
{
    const FieldTiles *tiles = bins;
    return indexlists_length(&tiles->workers[worker].lists, (size_t)column) > 0;
}

/* Decides one sample in double precision. */
static Status decide_sample(const FieldTiles *tiles, FieldSpace *space, const FieldTile *tile,
                            Ray ray, int sample, TileHits *hits, Err *err)
{
    TRY(fieldspace_reserve_rays(space, tile->n_terms, err));
    RayHit hit = {.index = 0};
    hits->state[sample] = TILE_MISS;
    if (!fieldspace_first_hit(space, tile->n_terms, ray, tile->z_min, &hit))
        return STATUS_OK;
    bool within = vec3_dot(hit.normal, ray.direction) > 0;
    Vec3 normal = viewpoint_frame_direction(&tiles->lists.eye,
                                            within ? vec3_scale(hit.normal, -1) : hit.normal);
    hits->any_hit = true;
    hits->state[sample] = TILE_HIT;
    hits->z[sample] = hit.t * vec3_dot(ray.direction, tiles->lists.eye.axes[2]);
    tile_set_vector(hits->normal, sample, normal);
    hits->segment[sample] = hit.index;
    return STATUS_OK;
}

/* Decides the samples inside the grid that the kernel left undecided. */
static Status decide_rest(const FieldTiles *tiles, FieldSpace *space, const FieldTile *tile,
                          const TracedTile *traced, TileHits *hits, Err *err)
{
    const SampleGrid *grid = &tiles->grid;
    for (int sample = 0; hits->any_unsure && sample < TILE_SAMPLES; sample++) {
        int i = tile_sample_x(sample), j = tile_sample_y(sample);
        if (hits->state[sample] != TILE_UNSURE || i >= traced->n_columns || j >= traced->n_rows)
            continue;
        Ray ray = camera_ray(tiles->camera, samplegrid_at(grid, traced->column + i),
                             samplegrid_at(grid, traced->row + j));
        TRY(decide_sample(tiles, space, tile, ray, sample, hits, err));
    }
    return STATUS_OK;
}

/* Traces the rays of a tile to the surface [TileEngine.trace]: makes the terms of the tile's
 * segments and runs the kernel on them. Rays that the kernel leaves are traced in double precision.
 * */
static Status trace_field(void *bins, int worker, int shift, BatchTile *batch_tile, Err *err)
{
    (void)shift; /* there are no shifted passes */
    const FieldTiles *tiles = bins;
    TracedTile *traced = &batch_tile->traced;
    TileHits *hits = &batch_tile->hits;
    FieldWorker *own = &tiles->workers[worker];
    FieldSpace *space = &own->space;
    FieldTile tile = own->row;
    const int column = traced->column / TILE_SIDE;
    const TileAxis *x = &tiles->x[column], *y = &tiles->y[traced->row / TILE_SIDE];
    const uint32_t *list = &own->lists.first[column];
    traced->x = tile.x = x->samples;
    traced->y = y->samples;
    traced->middle_x = tile.middle_x = x->middle;
    traced->middle_y = y->middle;
    traced->hits = NULL;
    if (list[0] == list[1])
        return STATUS_OK;
    tile.half_size = (float)sqrt(x->half * x->half + y->half * y->half);
    fieldterms_make(tiles->lists.segments, own->lists.items + list[0], list[1] - list[0], &tile,
                    space->terms.items, space->candidates.items);
    if (tile.n_terms == 0)
        return STATUS_OK;
    assert(tile.n_terms <= space->work_capacity);
    tiles->trace(&tile, space->work, hits);
    TRY(decide_rest(tiles, space, &tile, traced, hits, err));
    traced->hits = hits->any_hit ? hits : NULL;
    return STATUS_OK;
}

const TileEngine field_tiles = {.fine_grid = true,
                                .batch_tiles = SHADOW_BATCH,
                                .rows_at_once = 8,
                                .shadows = &field_shadows,
                                .bin = bin_field,
                                .release = release_field,
                                .list = list_field,
                                .is_listed = is_field_listed,
                                .trace = trace_field};

/* Returns true if this engine draws the model [Engine.supports]: blobs unless rays are asked for,
 * and the potential unless POV-Ray's cells are to be drawn. */
static bool can_draw_field(const Drawing *drawing)
{
    const SceneModel model = drawing->geometry->model;
    return model_has(model, MODEL_BLOB)
               ? drawing->params->method != RENDER_TRACE
               : model_has(model, MODEL_POTENTIAL) && !drawing->params->povray_cells;
}

const Engine field_engine = {.name = "field",
                             .tiles = &field_tiles,
                             .supports = can_draw_field,
                             .prepare = tilerender_prepare,
                             .rows = tilerender_rows,
                             .free = tilerender_free};
