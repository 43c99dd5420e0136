/* Draws an image tile by tile (8 x 8 samples) on several threads.
 *
 * Each worker (thread) collects tiles in a batch, has the engine find the first hits of their
 * samples, and shades the whole batch. The shadow queries of many tiles that fall into the same
 * tile of a light view are thus answered together.
 *
 * The first pass draws the sample at the centre of each pixel. The N x N further samples per pixel
 * of antialiasing are drawn in one of two ways, which the engine chooses [TileEngine.fine_grid]:
 *
 * - On a fine grid, N times as fine in each direction. A tile then covers a smaller part of the
 *   picture, so its list of vessels is shorter. The colors of a row of tiles go to a buffer, from
 *   which the samples of each pixel are summed.
 * - By N x N shifted passes over the tiles of the first pass, whose samples are moved by a fraction
 *   of a pixel. They add the colors to one sum per pixel while the list of the tile is in the
 *   cache.
 *
 * Both sum floats in POV-Ray's order, so that results are equal to the last bit. If a threshold
 * selects the pixels that get further samples (adaptive antialiasing), the centre samples of all
 * pixels must be known first, and shifted passes need a second pass over the rows. */
#include "render/tile/tilerender.h"

#include "render/cast/caster.h"
#include "render/light/raycolor.h"
#include "render/light/shade.h"
#include "render/light/shadowpass.h"
#include "render/tile/canvas.h"
#include <stdlib.h>
#include <string.h>

/* The samples of a pass over the image, and the geometry in its tiles. */
typedef struct TilePass {
    SampleGrid grid;
    void *bins; /* of the engine; NULL: there is no such pass */
} TilePass;

/* What all bands of a view share. */
typedef struct TilePrepared {
    const TileEngine *engine;
    TilePass center, further;
    LightBins *shadows[VIEW_MAX_LIGHTS]; /* NULL: the light casts none, or rays find them */
} TilePrepared;

/* The tiles that one worker draws together, and its workspaces. All arrays are owned. */
typedef struct TileBatch {
    BatchTile *tiles;
    int n_tiles;
    uint8_t *own;                         /* memory of BatchTile.own of all tiles */
    uint8_t (*shadowed)[TILE_SAMPLES];    /* per tile and light: BatchTile.shadowed */
    float (*sums)[TILE_SAMPLES];          /* per tile and channel: BatchTile.sum; shifted passes */
    ShadowQueue *queues[VIEW_MAX_LIGHTS]; /* per light that has a light view; otherwise NULL */
    uint8_t *wanted;    /* per tile of a row: has pixels that want further samples */
    float *fine_colors; /* of the samples of a row of pixel tiles; fine grid */
    int fine_row;       /* first row of samples in fine_colors */
} TileBatch;

/* A band while it is drawn. */
typedef struct TilePicture {
    Canvas canvas;
    const TilePrepared *prepared; /* borrowed, like `engine` and `pass` */
    const TileEngine *engine;
    const TilePass *pass;
    bool has_shadows;   /* hard shadows are wanted */
    bool further;       /* false: the pass of the centre samples; true: the pass after it */
    bool shifts;        /* further samples are drawn by shifted passes */
    bool chooses;       /* a threshold chooses the pixels that get further samples */
    int batch_tiles;    /* size of a batch */
    int rows_at_once;   /* rows of tiles that a worker draws at a time */
    TileBatch *batches; /* per worker */
} TilePicture;

/* Returns the number of tiles that cover a row or column of samples. */
static int tiles_of(int samples)
{
    return (samples + TILE_SIDE - 1) / TILE_SIDE;
}

/* Returns true if the sample is within the picture: the last tiles of rows and columns are cut off.
 * */
static bool is_inside(const TracedTile *traced, int sample)
{
    return tile_sample_x(sample) < traced->n_columns && tile_sample_y(sample) < traced->n_rows;
}

/* ---- shadows --------------------------------------------------------------------------------- */

/* Returns a bit mask of the samples inside the image that hit a surface. */
static uint64_t find_hits(const TracedTile *traced)
{
    const bool whole = traced->n_columns == TILE_SIDE && traced->n_rows == TILE_SIDE;
    uint64_t hits = 0;
    for (int sample = 0; sample < TILE_SAMPLES; sample++)
        hits |= (uint64_t)(traced->hits->state[sample] == TILE_HIT) << sample;
    for (int sample = 0; !whole && sample < TILE_SAMPLES; sample++)
        if (!is_inside(traced, sample))
            hits &= ~((uint64_t)1 << sample);
    return hits;
}

/* Computes the positions of a tile's hits in the frame of the view. Depths of the ground are
 * rounded as the engine rounds its own depths, so that vessels and ground cast equal shadows. */
static void compute_hit_points(const TileEngine *engine, const BatchTile *tile,
                               HitPoints *restrict points)
{
    const TracedTile *traced = &tile->traced;
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        points->x[sample] = traced->middle_x + (double)traced->x[sample];
        points->y[sample] = traced->middle_y + (double)traced->y[sample];
        points->z[sample] = tile->hits.z[sample];
    }
    for (uint64_t left = engine->single_depths ? traced->ground : 0; left; left &= left - 1) {
        double *z = &points->z[__builtin_ctzll(left)];
        *z = tile->depth_base + (double)(float)(*z - tile->depth_base);
    }
    for (int sample = 0; traced->perspective && sample < TILE_SAMPLES; sample++) {
        points->x[sample] *= points->z[sample];
        points->y[sample] *= points->z[sample];
    }
}

/* Sets `shadowed` of the samples in the mask `wanted` for one light, by rays. */
static void cast_shadows(const TilePicture *picture, int worker, const Light *light,
                         const HitPoints *points, uint64_t wanted, uint8_t shadowed[TILE_SAMPLES])
{
    const Drawing *drawing = picture->canvas.drawing;
    for (; wanted; wanted &= wanted - 1) {
        int sample = __builtin_ctzll(wanted);
        Vec3 at = {points->x[sample], points->y[sample], points->z[sample]};
        Vec3 point = viewpoint_world_point(&picture->canvas.eye, at);
        shadowed[sample] = !shadowrays_count(drawing, worker, light, ALL_SETS, point);
    }
}

/* Queues the shadow queries of a tile for each light with hard shadows. A light without a light
 * view is answered at once, by rays. */
static void query_lights(const TilePicture *picture, int worker, const BatchTile *tile)
{
    const View *view = picture->canvas.drawing->view;
    const TileKernels *kernels = picture->canvas.kernels;
    const TileBatch *batch = &picture->batches[worker];
    const uint64_t hits = find_hits(&tile->traced);
    HitPoints points;
    compute_hit_points(picture->engine, tile, &points);
    for (uint64_t left = tile->items ? tile->traced.ground : 0; left; left &= left - 1)
        tile->items[__builtin_ctzll(left)] = NO_ITEM;
    for (size_t i = 0; i < view->n_lights; i++) {
        const Light *light = &view->lights[i];
        if (!light->casts_shadows || light->samples > 1)
            continue;
        uint64_t wanted = hits & kernels->facing(&tile->traced, &points, tile->hits.normal,
                                                 &picture->canvas.look.lights[i]);
        size_t answer = (size_t)(tile->shadowed + i - batch->shadowed) * TILE_SAMPLES;
        if (batch->queues[i])
            shadowqueue_add(batch->queues[i], &points, tile->items, wanted, (uint32_t)answer);
        else
            cast_shadows(picture, worker, light, &points, wanted, tile->shadowed[i]);
    }
}

/* Sets `shadowed` of all tiles of the batch. */
static Status find_shadows(const TilePicture *picture, int worker, Err *err)
{
    TileBatch *batch = &picture->batches[worker];
    const Drawing *drawing = picture->canvas.drawing;
    size_t n_lights = drawing->view->n_lights;
    if (!picture->has_shadows)
        return STATUS_OK;
    memset(batch->shadowed, 0, (size_t)batch->n_tiles * n_lights * sizeof *batch->shadowed);
    for (int i = 0; i < batch->n_tiles; i++)
        if (batch->tiles[i].traced.hits)
            query_lights(picture, worker, &batch->tiles[i]);
    for (size_t i = 0; i < n_lights; i++)
        if (batch->queues[i])
            TRY(shadowqueue_answer(batch->queues[i], batch->shadowed[0], err));
    return STATUS_OK;
}

/* ---- colors --------------------------------------------------------------------------------- */

/* Returns the ray of a sample. */
static Ray sample_ray(const TilePicture *picture, const TracedTile *traced, int sample)
{
    const SampleGrid *grid = &picture->pass->grid;
    return camera_ray(&picture->canvas.drawing->view->camera,
                      samplegrid_at(grid, traced->column + tile_sample_x(sample)),
                      samplegrid_at(grid, traced->row + tile_sample_y(sample)));
}

/* Returns the surface that a sample hits. */
static Surfel surfel_of(const TilePicture *picture, const TracedTile *traced, int sample)
{
    const Vec3 normal = tile_vector(traced->hits->normal, sample);
    const Geometry *geometry = picture->canvas.drawing->geometry;
    return (Surfel){.t = tile_hit_distance(traced, sample),
                    .normal =
                        vec3_normalized(viewpoint_world_direction(&picture->canvas.eye, normal)),
                    .segment = geometry_segment(geometry, traced->hits->segment[sample])};
}

/* Colors each sample of a tile by ray_color, with ground, occlusion and soft shadows found by rays.
 * The shading kernel cannot do this. */
static void color_samples(const TilePicture *picture, int worker, const TracedTile *traced,
                          float color[3][TILE_SAMPLES])
{
    const SampleGrid *grid = &picture->pass->grid;
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        if (!is_inside(traced, sample))
            continue;
        const bool hit = traced->hits && traced->hits->state[sample] == TILE_HIT;
        const Surfel surfel = hit ? surfel_of(picture, traced, sample) : (Surfel){0};
        Rgb rgb = ray_color(picture->canvas.drawing, worker, sample_ray(picture, traced, sample),
                            samplegrid_at(grid, traced->column + tile_sample_x(sample)),
                            samplegrid_at(grid, traced->row + tile_sample_y(sample)),
                            hit ? &surfel : NULL);
        color[0][sample] = rgb.r;
        color[1][sample] = rgb.g;
        color[2][sample] = rgb.b;
    }
}

/* Returns the colors of a tile, with the thin vessels in `cells` drawn over them. Each sample uses
 * cell (x, y) of its pixel. Returns NULL if all samples have the color of the background. */
static float (*color_tile(const TilePicture *picture, int worker, const BatchTile *tile,
                          ThinCells *cells, int x, int y))[TILE_SAMPLES]
{
    const Canvas *canvas = &picture->canvas;
    const uint8_t(*shadowed)[TILE_SAMPLES] = (const uint8_t(*)[TILE_SAMPLES])tile->shadowed;
    float(*color)[TILE_SAMPLES] = NULL;
    if (canvas->engine_colors_background) {
        color = canvas->each[worker].color;
        color_samples(picture, worker, &tile->traced, color);
    } else if (tile->traced.hits) {
        color = canvas_shade(canvas, worker, &tile->traced, picture->has_shadows ? shadowed : NULL);
    }
    return canvas_draw_thin(canvas, worker, &tile->traced, cells, x, y, color);
}

/* ---- shifted passes -------------------------------------------------------------------------- */

/* Returns true if further samples are traced in a pixel of the band. */
static bool wants_more(const Canvas *canvas, int column, int row)
{
    return resampling_wants(&canvas->more, canvas_pixel(canvas, column, row));
}

/* Starts the sums of a tile with its pixels' centres, which the frame holds. */
static void begin_sums(const Canvas *canvas, BatchTile *tile)
{
    const TracedTile *traced = &tile->traced;
    for (int j = 0; j < traced->n_rows; j++)
        for (int i = 0; i < traced->n_columns; i++) {
            size_t pixel = canvas_pixel(canvas, traced->column + i, traced->row + j);
            for (size_t c = 0; c < 3; c++)
                tile->sum[c][tile_sample_at(i, j)] = canvas->frame->color.values[3 * pixel + c];
        }
}

/* Adds the samples of a shifted pass to the sums of a tile. */
static void add_to_sums(const TilePicture *picture, int worker, int shift, BatchTile *tile)
{
    const int side = picture->canvas.more.side;
    float(*color)[TILE_SAMPLES] =
        color_tile(picture, worker, tile, &tile->further, shift % side, shift / side);
    for (int c = 0; c < 3; c++)
        for (int sample = 0; sample < TILE_SAMPLES; sample++)
            tile->sum[c][sample] += color ? color[c][sample] : picture->canvas.background[c];
}

/* Stores the color of each pixel of a tile with further samples: the mean of all its samples. */
static void write_means(const Canvas *canvas, const BatchTile *tile)
{
    const TracedTile *traced = &tile->traced;
    for (int j = 0; j < traced->n_rows; j++)
        for (int i = 0; i < traced->n_columns; i++) {
            size_t pixel = canvas_pixel(canvas, traced->column + i, traced->row + j);
            for (size_t c = 0; c < 3 && wants_more(canvas, traced->column + i, traced->row + j);
                 c++)
                canvas->frame->color.values[3 * pixel + c] =
                    resampling_mean(&canvas->more, tile->sum[c][tile_sample_at(i, j)]);
        }
}

/* Finds the hits of a tile, or of a shifted pass over it (`shift` >= 0). Adds the hits of the
 * ground, unless color_samples finds them. */
static Status trace_tile(const TilePicture *picture, int worker, int shift, BatchTile *tile,
                         Err *err)
{
    const Canvas *canvas = &picture->canvas;
    TRY(picture->engine->trace(picture->pass->bins, worker, shift, tile, err));
    if (!canvas->engine_colors_background && canvas->drawing->view->ground.present)
        canvas_trace_ground(canvas, &tile->traced, &tile->hits);
    return STATUS_OK;
}

/* Draws all shifted passes over the tiles of the batch. */
static Status draw_shifted(const TilePicture *picture, int worker, Err *err)
{
    const Canvas *canvas = &picture->canvas;
    TileBatch *batch = &picture->batches[worker];
    for (int i = 0; i < batch->n_tiles; i++)
        begin_sums(canvas, &batch->tiles[i]);
    for (int shift = 0; shift < canvas->more.side * canvas->more.side; shift++) {
        for (int i = 0; i < batch->n_tiles; i++)
            TRY(trace_tile(picture, worker, shift, &batch->tiles[i], err));
        TRY(find_shadows(picture, worker, err));
        for (int i = 0; i < batch->n_tiles; i++)
            add_to_sums(picture, worker, shift, &batch->tiles[i]);
    }
    for (int i = 0; i < batch->n_tiles; i++)
        write_means(canvas, &batch->tiles[i]);
    return STATUS_OK;
}

/* ---- the fine grid --------------------------------------------------------------------------- */

/* Stores the colors of a tile of the fine grid in the batch's buffer, until all samples of its
 * pixels are there. */
static void buffer_fine_tile(const TilePicture *picture, const TileBatch *batch,
                             const TracedTile *traced, float (*color)[TILE_SAMPLES])
{
    size_t width = (size_t)picture->pass->grid.n_columns;
    canvas_copy(&picture->canvas, traced->n_columns, traced->n_rows, color,
                batch->fine_colors +
                    3 * ((size_t)(traced->row - batch->fine_row) * width + (size_t)traced->column),
                3 * width);
}

/* Adds the further samples of the pixel (i, j) to its centre sample, row by row in float, and
 * stores the mean. `samples` are the colors of the row of pixels. */
static void average_pixel(const TilePicture *picture, const float *samples, int i, int j)
{
    const Resampling *more = &picture->canvas.more;
    size_t n = (size_t)more->side, width = (size_t)picture->pass->grid.n_columns;
    float *value = &picture->canvas.frame->color.values[3 * canvas_pixel(&picture->canvas, i, j)];
    for (size_t c = 0; c < 3; c++) {
        float sum = value[c];
        for (size_t y = 0; y < n; y++)
            for (size_t x = 0; x < n; x++)
                sum += samples[3 * (y * width + (size_t)i * n + x) + c];
        value[c] = resampling_mean(more, sum);
    }
}

/* Averages the pixels of the rows [first, end) that get further samples. */
static void average_rows(const TilePicture *picture, const TileBatch *batch, int first, int end)
{
    const SampleGrid *grid = &picture->pass->grid;
    const size_t row = 3 * (size_t)grid->n_columns * (size_t)grid->side;
    for (int j = first; j < end; j++)
        for (int i = 0; i < grid->n_columns / grid->side; i++)
            if (wants_more(&picture->canvas, i, j))
                average_pixel(picture, batch->fine_colors + (size_t)(j - first) * row, i, j);
}

/* ---- tiles ----------------------------------------------------------------------------------- */

/* Turns the normals of hits towards the viewer. */
static void face_viewer(const TracedTile *traced, TileHits *hits)
{
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        if (hits->state[sample] != TILE_HIT)
            continue;
        Vec3 normal = tile_vector(traced->hits->normal, sample);
        Vec3 line = traced->perspective ? tile_line(traced, sample) : vec3(0, 0, 1);
        if (vec3_dot(normal, line) > 0)
            tile_set_vector(hits->normal, sample, vec3_scale(normal, -1));
    }
}

/* Colors a tile of the present pass, and stores its pixels or, on a fine grid, its samples. */
static void store_tile(const TilePicture *picture, int worker, BatchTile *tile)
{
    const Canvas *canvas = &picture->canvas;
    float(*color)[TILE_SAMPLES] = NULL;
    if (canvas->wants_color)
        color = color_tile(picture, worker, tile, &tile->cells, 0, 0);
    if (picture->further) {
        buffer_fine_tile(picture, &picture->batches[worker], &tile->traced, color);
        return;
    }
    if (picture->engine->either_side && canvas->wants_geometry && tile->traced.hits)
        face_viewer(&tile->traced, &tile->hits);
    canvas_store(canvas, worker, &tile->traced, color);
}

/* Draws the tiles of the batch and empties it. Shifted passes follow the centre samples at once; if
 * a threshold chooses pixels, they follow in the second pass over the rows, which has no centre
 * samples of its own. */
static Status draw_batch(const TilePicture *picture, int worker, Err *err)
{
    TileBatch *batch = &picture->batches[worker];
    if (!picture->further || !picture->shifts) {
        TRY(find_shadows(picture, worker, err));
        for (int i = 0; i < batch->n_tiles; i++)
            store_tile(picture, worker, &batch->tiles[i]);
    }
    if (picture->shifts && picture->further == picture->chooses)
        TRY(draw_shifted(picture, worker, err));
    batch->n_tiles = 0;
    return STATUS_OK;
}

/* Computes how thin vessels cover the cells of the tile's samples: of the present pass
 * (tile->cells) and of the shifted passes (tile->further). */
static Status cover_tile(const TilePicture *picture, BatchTile *tile, Err *err)
{
    const ThinLayer *thin = picture->canvas.wants_color ? picture->canvas.drawing->thin : NULL;
    const TracedTile *traced = &tile->traced;
    const int per_pixel = picture->pass->grid.side, side = picture->canvas.more.side;
    const int fine = side * TILE_SIDE;
    if (per_pixel == 1 &&
        thinlayer_misses(thin, traced->column / TILE_SIDE, traced->row / TILE_SIDE))
        thin = NULL;
    const CellBlock center = {traced->column, traced->row, TILE_SIDE, TILE_SIDE, per_pixel};
    const CellBlock further = {traced->column * side, traced->row * side, fine, fine, side};
    TRY(thincells_fill(thin, center, &tile->cells, err));
    if (!picture->shifts || tile->cells.fragments.n == 0)
        thin = NULL;
    return thincells_fill(thin, further, &tile->further, err);
}

/* Makes the tile at (column, row) the next tile of the batch, and traces it. Sets *shown to false
 * if it shows nothing but background; the caller then reuses its place in the batch. */
static Status begin_tile(const TilePicture *picture, int column, int row, int worker, bool *shown,
                         Err *err)
{
    const SampleGrid *grid = &picture->pass->grid;
    const Camera *camera = &picture->canvas.drawing->view->camera;
    TileBatch *batch = &picture->batches[worker];
    BatchTile *tile = &batch->tiles[batch->n_tiles];
    const bool listed = picture->engine->is_listed(picture->pass->bins, column, worker);
    tile->traced = (TracedTile){.column = column * TILE_SIDE,
                                .row = row * TILE_SIDE,
                                .n_columns = tile_extent(grid->n_columns - column * TILE_SIDE),
                                .n_rows = tile_extent(grid->n_rows - row * TILE_SIDE),
                                .perspective = camera->projection == PROJECTION_PERSPECTIVE};
    TRY(cover_tile(picture, tile, err));
    *shown = tile->cells.fragments.n > 0 || picture->canvas.engine_colors_background ||
             picture->canvas.drawing->view->ground.present;
    if (!listed && !*shown)
        return STATUS_OK;
    *shown |= picture->shifts;
    if (!picture->shifts || !picture->further)
        TRY(trace_tile(picture, worker, -1, tile, err));
    *shown |= tile->traced.hits != NULL;
    return STATUS_OK;
}

/* Draws a row of tiles of the present pass: all of them, or those marked in `wanted`. A batch that
 * is not full is not drawn; the caller draws it with draw_batch. */
static Status draw_tiles(const TilePicture *picture, int row, const uint8_t *wanted, int worker,
                         Err *err)
{
    TileBatch *batch = &picture->batches[worker];
    const int columns = tiles_of(picture->pass->grid.n_columns);
    bool shown;
    TRY(picture->engine->list(picture->pass->bins, row, worker, err));
    for (int column = 0; column < columns; column++) {
        if (wanted && !wanted[column])
            continue;
        TRY(begin_tile(picture, column, row, worker, &shown, err));
        if (!shown && picture->further && !picture->shifts)
            buffer_fine_tile(picture, batch, &batch->tiles[batch->n_tiles].traced, NULL);
        batch->n_tiles += shown;
        if (batch->n_tiles == picture->batch_tiles)
            TRY(draw_batch(picture, worker, err));
    }
    return STATUS_OK;
}

/* ---- passes ---------------------------------------------------------------------------------- */

/* Draws the centre samples of part `number` of the band: picture->rows_at_once rows of tiles. */
static Status draw_centers(size_t number, int worker, void *context, Err *err)
{
    const TilePicture *picture = context;
    const Canvas *canvas = &picture->canvas;
    const Band *band = &canvas->drawing->band;
    const int done = (int)number * picture->rows_at_once, top = band->first / TILE_SIDE;
    const int most = tiles_of(band->rows), last = done + picture->rows_at_once;
    const int first = top + done, end = top + (last < most ? last : most);
    TRY(drawing_progress(canvas->drawing, worker, false, (size_t)done * TILE_SIDE, err));
    canvas_begin_rows(canvas, worker, first);
    for (int row = first; row < end; row++)
        TRY(draw_tiles(picture, row, NULL, worker, err));
    TRY(draw_batch(picture, worker, err));
    canvas_end_rows(canvas, worker, end);
    return STATUS_OK;
}

/* Marks the tiles, in one row of tiles of the grid, that hold samples of pixels that get further
 * samples. Ignores the rows of pixels from `end` on. Returns false if it marks none. */
static bool mark_wanted(const TilePicture *picture, int tile_row, int end, uint8_t *wanted)
{
    const SampleGrid *grid = &picture->pass->grid;
    int n = grid->side, width = grid->n_columns / n;
    int first = tile_row * TILE_SIDE / n, last = (tile_row * TILE_SIDE + TILE_SIDE - 1) / n;
    bool any = false;
    memset(wanted, 0, (size_t)tiles_of(grid->n_columns));
    for (int j = first; j <= last && j < end; j++)
        for (int i = 0; i < width; i++)
            if (wants_more(&picture->canvas, i, j)) {
                any = true;
                for (int tile = i * n / TILE_SIDE; tile <= (i * n + n - 1) / TILE_SIDE; tile++)
                    wanted[tile] = 1;
            }
    return any;
}

/* Draws the further samples of the pixels in row `number` of tiles of the band. */
static Status draw_further(size_t number, int worker, void *context, Err *err)
{
    const TilePicture *picture = context;
    const Drawing *drawing = picture->canvas.drawing;
    const Band *band = &drawing->band;
    const SampleGrid *grid = &picture->pass->grid;
    TileBatch *batch = &picture->batches[worker];
    TRY(drawing_progress(drawing, worker, true, number * TILE_SIDE, err));
    int row = band->first / TILE_SIDE + (int)number, first = row * TILE_SIDE,
        end = first + tile_extent(band->first + band->rows - first);
    batch->fine_row = first * grid->side;
    for (int i = row * grid->side; i < (row + 1) * grid->side && i < tiles_of(grid->n_rows); i++)
        if (mark_wanted(picture, i, end, batch->wanted))
            TRY(draw_tiles(picture, i, batch->wanted, worker, err));
    TRY(draw_batch(picture, worker, err));
    if (!picture->shifts)
        average_rows(picture, batch, first, end);
    return STATUS_OK;
}

/* ---- data that all bands share --------------------------------------------------------------- */

void tilerender_free(void *prepared)
{
    TilePrepared *tiles = prepared;
    tiles->engine->release(tiles->center.bins);
    tiles->engine->release(tiles->further.bins);
    for (size_t i = 0; i < VIEW_MAX_LIGHTS; i++)
        lightbins_free(tiles->shadows[i]);
    free(tiles);
}

LightBins *tilerender_light_bins(const void *prepared, size_t light)
{
    const TilePrepared *tiles = prepared;
    return tiles->shadows[light];
}

/* Sets the samples of a pass, side x side per pixel at `offsets` within it, and sorts the geometry
 * into their tiles. */
static Status prepare_pass(const TileEngine *engine, const Drawing *drawing, int side,
                           const double *offsets, TilePass *pass, Err *err)
{
    const Camera *camera = &drawing->view->camera;
    pass->grid = (SampleGrid){
        .side = side, .n_columns = camera->width * side, .n_rows = camera->height * side};
    for (int i = 0; i < side; i++)
        pass->grid.offsets[i] = offsets[i];
    return engine->bin(drawing, &pass->grid, &pass->bins, err);
}

Status tilerender_prepare(const TileEngine *engine, const Drawing *drawing, void **prepared,
                          Err *err)
{
    Status status;
    const RenderParams *params = drawing->params;
    const double center = 0;
    const Resampling more = resampling_for(params->want_color ? params->antialias : 1);
    const Viewpoint eye = viewpoint_of_camera(&drawing->view->camera);
    TilePrepared *tiles;
    TRY(mem_calloc(&tiles, 1, sizeof *tiles, "tiles", err));
    tiles->engine = engine;
    TRY_GOTO(prepare_pass(engine, drawing, 1, &center, &tiles->center, err));
    if (more.side > 0 && engine->fine_grid)
        TRY_GOTO(prepare_pass(engine, drawing, more.side, more.offsets, &tiles->further, err));
    if (params->shadows && params->want_color)
        TRY_GOTO(lightbins_new_for_view(engine->shadows, drawing, &eye, tiles->shadows, err));
    *prepared = tiles;
done:
    if (status != STATUS_OK)
        tilerender_free(tiles);
    return status;
}

/* ---- a band ---------------------------------------------------------------------------------- */

/* Returns the pass of the further samples. Shifted passes use the tiles of the centre samples. */
static const TilePass *further_pass(const TilePicture *picture)
{
    return picture->shifts ? &picture->prepared->center : &picture->prepared->further;
}

/* Allocates a batch, and its queue of shadow queries for each light that has shadows. */
static Status make_batch(const TilePicture *picture, TileBatch *batch, Err *err)
{
    const TileEngine *engine = picture->engine;
    const Drawing *drawing = picture->canvas.drawing;
    const SampleGrid *further = &further_pass(picture)->grid;
    size_t n = (size_t)picture->batch_tiles, n_lights = drawing->view->n_lights;
    size_t row = (size_t)further->n_columns * TILE_SIDE * (size_t)further->side;
    TRY(mem_calloc(&batch->tiles, n, sizeof *batch->tiles, "tiles", err));
    TRY(mem_calloc(&batch->own, n, engine->tile_bytes, "tiles", err));
    TRY(mem_calloc(&batch->shadowed, n * n_lights, sizeof *batch->shadowed, "lights", err));
    TRY(mem_calloc(&batch->wanted, (size_t)tiles_of(further->n_columns), 1, "bands", err));
    if (picture->shifts)
        TRY(mem_calloc(&batch->sums, n * 3, sizeof *batch->sums, "tiles", err));
    else
        TRY(mem_calloc(&batch->fine_colors, row, 3 * sizeof *batch->fine_colors, "bands", err));
    for (size_t i = 0; i < n; i++) {
        batch->tiles[i].own = batch->own + i * engine->tile_bytes;
        batch->tiles[i].shadowed = batch->shadowed + i * n_lights;
        batch->tiles[i].sum = batch->sums ? batch->sums + 3 * i : NULL;
    }
    for (size_t i = 0; i < n_lights; i++)
        if (picture->has_shadows && picture->prepared->shadows[i])
            TRY(shadowqueue_new(picture->prepared->shadows[i], drawing->params->kernels,
                                drawing->hidden, &batch->queues[i], err));
    return STATUS_OK;
}

/* Allocates a batch for each worker. */
static Status make_batches(TilePicture *picture, Err *err)
{
    int workers = picture->canvas.workers;
    TRY(mem_calloc(&picture->batches, (size_t)workers, sizeof *picture->batches, "canvases", err));
    for (int i = 0; i < workers; i++)
        TRY(make_batch(picture, &picture->batches[i], err));
    return STATUS_OK;
}

static void release_batch(const TilePicture *picture, TileBatch *batch)
{
    for (int i = 0; batch->tiles && i < picture->batch_tiles; i++) {
        thincells_release(&batch->tiles[i].cells);
        thincells_release(&batch->tiles[i].further);
    }
    for (size_t i = 0; i < VIEW_MAX_LIGHTS; i++)
        shadowqueue_free(batch->queues[i]);
    free(batch->tiles);
    free(batch->own);
    free(batch->shadowed);
    free(batch->sums);
    free(batch->wanted);
    free(batch->fine_colors);
}

static void release_picture(TilePicture *picture)
{
    for (int i = 0; picture->batches && i < picture->canvas.workers; i++)
        release_batch(picture, &picture->batches[i]);
    free(picture->batches);
    canvas_release(&picture->canvas);
}

/* Draws the centre samples, then the further samples, unless these were drawn together. */
static Status draw_band(TilePicture *picture, Err *err)
{
    Canvas *canvas = &picture->canvas;
    const size_t rows = (size_t)tiles_of(canvas->drawing->band.rows);
    const size_t at_once = (size_t)picture->rows_at_once;
    if (picture->shifts && !picture->chooses)
        canvas_average_undrawn(canvas);
    TRY(make_batches(picture, err));
    TRY(threads_try((rows + at_once - 1) / at_once, canvas->workers, draw_centers, picture, err));
    if (canvas->more.side == 0 || (picture->shifts && !picture->chooses))
        return STATUS_OK;
    picture->further = true;
    picture->pass = further_pass(picture);
    TRY(resampling_choose(&canvas->more, canvas->drawing->params, &canvas->drawing->band,
                          &canvas->frame->color, err));
    return threads_try(rows, canvas->workers, draw_further, picture, err);
}

Status tilerender_rows(const Drawing *drawing, void *prepared, Frame *frame, Err *err)
{
    const RenderParams *params = drawing->params;
    const Viewpoint eye = viewpoint_of_camera(&drawing->view->camera);
    const TilePrepared *tiles = prepared;
    TilePicture picture = {.prepared = tiles,
                           .engine = tiles->engine,
                           .pass = &tiles->center,
                           .chooses = params->antialias_threshold > 0};
    Canvas *canvas = &picture.canvas;
    Status status = STATUS_OK;
    TRY_GOTO(canvas_init(drawing, frame, &eye, canvas, err));
    canvas->engine_colors_background =
        params->method == RENDER_TRACE && raycolor_is_needed(drawing->view, params);
    picture.shifts = canvas->more.side > 0 && !tiles->engine->fine_grid;
    picture.has_shadows =
        params->shadows && canvas->wants_color && !canvas->engine_colors_background;
    picture.batch_tiles = picture.has_shadows ? tiles->engine->batch_tiles : 1;
    picture.rows_at_once = picture.has_shadows ? tiles->engine->rows_at_once : 1;
    status = draw_band(&picture, err);
done:
    release_picture(&picture);
    return status;
}
