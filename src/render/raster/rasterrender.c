/* A row of tiles is the unit of work: the lists of its tiles are made, and for each tile the
 * kernels find the first primitive at each sample, and the canvas shades and stores it. With
 * shadows, tiles are drawn in batches: the shadow queries of a batch are answered together, as many
 * of them fall into one tile of a light and share its list.
 *
 * Further samples of a tile's pixels use the tile's list, in N x N passes, each with all samples of
 * the tile moved by the same part of a pixel, in POV-Ray's order. Where a threshold chooses the
 * pixels, colours of neighbours are needed first, so the further samples are a second round over
 * the rows. */
#include "render/raster/rasterrender.h"

#include "render/cast/caster.h"
#include "render/light/shade.h"
#include "render/light/shadowqueue.h"
#include "render/raster/rasterbins.h"
#include "render/raster/rasterkernels.h"
#include "render/raster/rastershadow.h"
#include "render/tile/canvas.h"
#include <stdlib.h>
#include <string.h>

/* What the camera and the lights of a view see. */
typedef struct RasterPrepared {
    RasterBins *bins; /* owned */
    bool has_shadows;
    LightBins *shadows[VIEW_MAX_LIGHTS]; /* owned; NULL where the light casts none, or rays do */
    RasterGrid center;
    RasterGrid *further; /* owned; n x n, row by row */
} RasterPrepared;

/* Tiles that are drawn together, with shadows. */
enum { MOST_TILES = 64 };

/* A tile and what it sees. */
typedef struct BatchTile {
    SeenTile seen; /* its hits are the surfels, or NULL */
    RasterTile raster;
    RasterHits hits;
    TileHits surfels;
    uint64_t visible;                  /* bit i: sample i sees something */
    uint8_t (*shadowed)[TILE_SAMPLES]; /* one a light; of the batch */
    float sum[3][TILE_SAMPLES];        /* of all samples of a pixel */
    ThinCells center, further;         /* of the centre samples, and of the further ones; owned */
} BatchTile;

/* The tiles that a worker draws together. */
typedef struct Batch {
    RasterRow row;
    BatchTile *tiles;
    int n_tiles;
    uint8_t (*shadowed)[TILE_SAMPLES];    /* tile by tile, one a light */
    ShadowQueue *queues[VIEW_MAX_LIGHTS]; /* to the shadows that there are */
} Batch;

typedef struct RasterPicture {
    Canvas canvas;
    const RasterPrepared *prepared; /* borrowed */
    const RasterKernels *kernels;
    bool chooses; /* only some pixels get further samples, in a second round */
    bool second_round;
    Batch *batches; /* one a worker */
    int batch_size; /* tiles */
} RasterPicture;

/* ---- one sample a pixel ---------------------------------------------------------------------- */

/* Sets the depths of what is seen in double precision. */
static void measure_depths(BatchTile *tile)
{
    for (int sample = 0; sample < TILE_SAMPLES; sample++)
        tile->surfels.z[sample] = tile->raster.z_middle + (double)tile->hits.z[sample];
}

/* Turns the normals of what is seen towards the viewer. */
static void face_viewer(BatchTile *tile)
{
    float(*normal)[TILE_SAMPLES] = tile->surfels.normal;
    for (uint64_t left = tile->visible; left; left &= left - 1) {
        int sample = __builtin_ctzll(left);
        Vec3 v = {(double)normal[0][sample], (double)normal[1][sample], (double)normal[2][sample]};
        Vec3 line = tile->seen.perspective ? seen_line(&tile->seen, sample) : vec3(0, 0, 1);
        if (vec3_dot(v, line) > 0)
            for (int c = 0; c < 3; c++)
                normal[c][sample] = -normal[c][sample];
    }
}

/* One light, ray by ray. */
static void cast_shadows(const RasterPicture *picture, const Light *light, int worker,
                         const SeenPlaces *places, uint64_t wanted, uint8_t shadowed[TILE_SAMPLES])
{
    const Drawing *drawing = picture->canvas.drawing;
    for (; wanted; wanted &= wanted - 1) {
        int sample = __builtin_ctzll(wanted);
        Vec3 at = {places->x[sample], places->y[sample], places->z[sample]};
        Vec3 point = viewpoint_point(&picture->canvas.eye, at);
        LightWay way = light_way(light, point);
        shadowed[sample] = caster_shadow(drawing->caster, worker, &drawing->view->ground, point,
                                         way.towards, way.distance);
    }
}

static void ask_lights(const RasterPicture *picture, const BatchTile *tile, int worker,
                       Batch *batch)
{
    const View *view = picture->canvas.drawing->view;
    SeenPlaces places;
    picture->kernels->locate(&tile->raster, &tile->hits, &places);
    for (size_t i = 0; i < view->n_lights; i++) {
        const Light *light = &view->lights[i];
        if (!light->casts_shadows || light->samples > 1)
            continue;
        uint64_t wanted = tile->visible &
                          picture->canvas.kernels->face(&tile->seen, &places, tile->surfels.normal,
                                                        &picture->canvas.look.lights[i]);
        size_t answer = (size_t)(tile->shadowed + i - batch->shadowed) * TILE_SAMPLES;
        if (batch->queues[i])
            shadowqueue_add(batch->queues[i], &places, tile->hits.item, wanted, (uint32_t)answer);
        else
            cast_shadows(picture, light, worker, &places, wanted, tile->shadowed[i]);
    }
}

static Status find_shadows(const RasterPicture *picture, int worker, Batch *batch, Err *err)
{
    size_t n_lights = picture->canvas.drawing->view->n_lights;
    memset(batch->shadowed, 0, (size_t)batch->n_tiles * n_lights * sizeof *batch->shadowed);
    for (int i = 0; i < batch->n_tiles; i++)
        if (batch->tiles[i].visible)
            ask_lights(picture, &batch->tiles[i], worker, batch);
    for (size_t i = 0; i < n_lights; i++)
        if (batch->queues[i])
            TRY(shadowqueue_answer(batch->queues[i], batch->shadowed[0], err));
    return STATUS_OK;
}

/* Adds the ground to what the tile sees. */
static void see_ground(const RasterPicture *picture, BatchTile *tile)
{
    canvas_see_ground(&picture->canvas, &tile->seen, &tile->surfels);
    tile->visible |= tile->seen.ground;
    for (uint64_t left = tile->seen.ground; left; left &= left - 1) {
        int sample = __builtin_ctzll(left);
        tile->hits.z[sample] = (float)(tile->surfels.z[sample] - tile->raster.z_middle);
        tile->hits.item[sample] = RASTER_NOTHING;
    }
}

/* What the tiles of the batch see with their samples at the places of a grid. */
static Status see_batch(const RasterPicture *picture, const RasterGrid *grid, int worker,
                        Batch *batch, Err *err)
{
    const RasterKernels *kernels = picture->kernels;
    for (int i = 0; i < batch->n_tiles; i++) {
        BatchTile *tile = &batch->tiles[i];
        tile->raster.grid = grid;
        tile->seen.x = grid->x;
        tile->seen.y = grid->y;
        tile->visible = kernels->trace(&tile->raster, &tile->hits, &tile->surfels);
        tile->seen.hits = tile->visible ? &tile->surfels : NULL;
        if (tile->visible)
            kernels->resolve(&tile->raster, &tile->hits, &tile->surfels);
        if (tile->visible &&
            (picture->canvas.needs_places || picture->canvas.wants_geometry || tile->center.n > 0))
            measure_depths(tile);
        if (picture->canvas.drawing->view->ground.present)
            see_ground(picture, tile);
    }
    if (picture->prepared->has_shadows && picture->canvas.wants_color)
        return find_shadows(picture, worker, batch, err);
    return STATUS_OK;
}

/* The colours that the samples of a tile see, which sees something. */
static float (*color_tile(const RasterPicture *picture, int worker,
                          const BatchTile *tile))[TILE_SAMPLES]
{
    const uint8_t(*shadowed)[TILE_SAMPLES] = (const uint8_t(*)[TILE_SAMPLES])tile->shadowed;
    return canvas_shade(&picture->canvas, worker, &tile->seen,
                        picture->prepared->has_shadows ? shadowed : NULL);
}

static void draw_tile(const RasterPicture *picture, int worker, BatchTile *tile)
{
    const Canvas *canvas = &picture->canvas;
    float(*color)[TILE_SAMPLES] = NULL;
    if (tile->visible && canvas->wants_color)
        color = color_tile(picture, worker, tile);
    if (canvas->wants_color)
        color = canvas_cover(canvas, worker, &tile->seen, &tile->center, 0, 0, color);
    if (tile->visible && canvas->wants_geometry)
        face_viewer(tile);
    canvas_draw(canvas, worker, &tile->seen, color);
}

/* ---- further samples ------------------------------------------------------------------------- */

static bool wants_more(const Canvas *canvas, const SeenTile *seen, int i, int j)
{
    return resampling_wants(&canvas->more, canvas_pixel(canvas, seen->column + i, seen->row + j));
}

static bool any_wants_more(const Canvas *canvas, const SeenTile *seen)
{
    for (int j = 0; j < seen->n_rows; j++)
        for (int i = 0; i < seen->n_columns; i++)
            if (wants_more(canvas, seen, i, j))
                return true;
    return false;
}

static void begin_sum(const Canvas *canvas, BatchTile *tile)
{
    const SeenTile *seen = &tile->seen;
    for (int j = 0; j < seen->n_rows; j++)
        for (int i = 0; i < seen->n_columns; i++) {
            size_t pixel = canvas_pixel(canvas, seen->column + i, seen->row + j);
            for (size_t c = 0; c < 3; c++)
                tile->sum[c][tile_sample_at(i, j)] = canvas->frame->color.values[3 * pixel + c];
        }
}

/* Adds the further samples of a pass to the tile's sums. */
static void add_to_sum(const RasterPicture *picture, int worker, int pass, BatchTile *tile)
{
    const int side = picture->canvas.more.side;
    float(*color)[TILE_SAMPLES] = tile->visible ? color_tile(picture, worker, tile) : NULL;
    color = canvas_cover(&picture->canvas, worker, &tile->seen, &tile->further, pass % side,
                         pass / side, color);
    if (!color) {
        for (int c = 0; c < 3; c++)
            for (int sample = 0; sample < TILE_SAMPLES; sample++)
                tile->sum[c][sample] += picture->canvas.background[c];
        return;
    }
    for (int c = 0; c < 3; c++)
        for (int sample = 0; sample < TILE_SAMPLES; sample++)
            tile->sum[c][sample] += color[c][sample];
}

static void write_mean(const Canvas *canvas, const BatchTile *tile)
{
    const SeenTile *seen = &tile->seen;
    for (int j = 0; j < seen->n_rows; j++)
        for (int i = 0; i < seen->n_columns; i++) {
            size_t pixel = canvas_pixel(canvas, seen->column + i, seen->row + j);
            for (size_t c = 0; c < 3 && wants_more(canvas, seen, i, j); c++)
                canvas->frame->color.values[3 * pixel + c] =
                    resampling_mean(&canvas->more, tile->sum[c][tile_sample_at(i, j)]);
        }
}

/* The means of the centre samples, which the picture holds, and all others, summed in float in
 * POV-Ray's order. */
static Status resample_batch(const RasterPicture *picture, int worker, Batch *batch, Err *err)
{
    const Canvas *canvas = &picture->canvas;
    for (int i = 0; i < batch->n_tiles; i++)
        begin_sum(canvas, &batch->tiles[i]);
    for (int pass = 0; pass < canvas->more.side * canvas->more.side; pass++) {
        TRY(see_batch(picture, &picture->prepared->further[pass], worker, batch, err));
        for (int i = 0; i < batch->n_tiles; i++)
            add_to_sum(picture, worker, pass, &batch->tiles[i]);
    }
    for (int i = 0; i < batch->n_tiles; i++)
        write_mean(canvas, &batch->tiles[i]);
    return STATUS_OK;
}

/* ---- rows ------------------------------------------------------------------------------------ */

static Status draw_batch(const RasterPicture *picture, int worker, Batch *batch, Err *err)
{
    if (!picture->second_round) {
        TRY(see_batch(picture, &picture->prepared->center, worker, batch, err));
        for (int i = 0; i < batch->n_tiles; i++)
            draw_tile(picture, worker, &batch->tiles[i]);
    }
    if (picture->second_round || (picture->canvas.more.side > 0 && !picture->chooses))
        TRY(resample_batch(picture, worker, batch, err));
    batch->n_tiles = 0;
    return STATUS_OK;
}

static void begin_tile(const RasterPicture *picture, const RasterTile *raster, int column, int row,
                       BatchTile *tile)
{
    const Camera *camera = &picture->canvas.drawing->view->camera;
    tile->raster = *raster;
    tile->seen = (SeenTile){.column = column,
                            .row = row,
                            .n_columns = tile_extent(camera->width - column),
                            .n_rows = tile_extent(camera->height - row),
                            .perspective = raster->perspective,
                            .middle_x = raster->x,
                            .middle_y = raster->y};
}

/* Finds the thin vessels of a tile. */
static Status find_thin(const RasterPicture *picture, BatchTile *tile, Err *err)
{
    const ThinLayer *thin = picture->canvas.wants_color ? picture->canvas.drawing->thin : NULL;
    const SeenTile *seen = &tile->seen;
    const int side = picture->canvas.more.side, fine = side * TILE_SIDE;
    TRY(thincells_fill(thin, 1, seen->column, seen->row, TILE_SIDE, TILE_SIDE, &tile->center, err));
    if (side == 0 || tile->center.n == 0) {
        thincells_clear(&tile->further);
        return STATUS_OK;
    }
    return thincells_fill(thin, side, seen->column * side, seen->row * side, fine, fine,
                          &tile->further, err);
}

static Status draw_row(void *context, int row, int rows, int worker, Err *err)
{
    (void)rows; /* one */
    const RasterPicture *picture = context;
    const RasterBins *bins = picture->prepared->bins;
    Batch *batch = &picture->batches[worker];
    TRY(rasterbins_list(bins, (size_t)row, &batch->row, err));
    const uint32_t *offsets = batch->row.offsets;
    for (int column = 0; column < bins->tile_columns; column++) {
        uint32_t n = offsets[column + 1] - offsets[column];
        if (n == 0 && !picture->canvas.drawing->view->ground.present &&
            thinlayer_misses(picture->canvas.drawing->thin, column, row))
            continue;
        BatchTile *tile = &batch->tiles[batch->n_tiles];
        RasterTile raster = rasterbins_tile(bins, column, row, batch->row.lists + offsets[column],
                                            n, &picture->prepared->center);
        begin_tile(picture, &raster, column * TILE_SIDE, row * TILE_SIDE, tile);
        if (picture->second_round && !any_wants_more(&picture->canvas, &tile->seen))
            continue;
        TRY(find_thin(picture, tile, err));
        if (++batch->n_tiles == picture->batch_size)
            TRY(draw_batch(picture, worker, batch, err));
    }
    return draw_batch(picture, worker, batch, err);
}

/* ---- the picture ----------------------------------------------------------------------------- */

static void release_prepared(void *prepared)
{
    RasterPrepared *raster = prepared;
    for (size_t i = 0; i < VIEW_MAX_LIGHTS; i++)
        lightbins_free(raster->shadows[i]);
    rasterbins_free(raster->bins);
    free(raster->further);
    free(raster);
}

static Status prepare_samples(const RenderParams *params, const RasterView *view,
                              RasterPrepared *raster, Err *err)
{
    Resampling more = resampling_for(params->antialias);
    size_t n = (size_t)more.side;
    raster->center = rastergrid_make(view, 0, 0);
    TRY(mem_calloc(&raster->further, n * n, sizeof *raster->further, "samples", err));
    for (size_t i = 0; i < n * n; i++)
        raster->further[i] = rastergrid_make(view, more.offsets[i % n], more.offsets[i / n]);
    return STATUS_OK;
}

static Status prepare(const Drawing *drawing, void **prepared, Err *err)
{
    Status status;
    const RenderParams *params = drawing->params;
    RasterPrepared *raster;
    RasterView view =
        rasterview_of_camera(&drawing->view->camera, drawing->geometry->bounds, params->antialias);
    view.hidden = drawing->hidden;
    TRY(mem_calloc(&raster, 1, sizeof *raster, "tiles", err));
    TRY_GOTO(prepare_samples(params, &view, raster, err));
    raster->has_shadows = params->shadows && params->want_color;
    if (raster->has_shadows)
        TRY_GOTO(lightbins_new_hard(&raster_shadows, drawing, &view.eye, raster->shadows, err));
    TRY_GOTO(rasterbins_new(drawing->geometry, &view, params->threads, &raster->bins, err));
    *prepared = raster;
done:
    if (status != STATUS_OK)
        release_prepared(raster);
    return status;
}

static Status make_batch(const RasterPicture *picture, Batch *batch, Err *err)
{
    LightBins *const *shadows = picture->prepared->shadows;
    const Drawing *drawing = picture->canvas.drawing;
    size_t n = (size_t)picture->batch_size, n_lights = picture->canvas.drawing->view->n_lights;
    TRY(mem_calloc(&batch->tiles, n, sizeof *batch->tiles, "tiles", err));
    TRY(mem_calloc(&batch->shadowed, n * n_lights, sizeof *batch->shadowed, "lights", err));
    for (size_t i = 0; i < n; i++)
        batch->tiles[i].shadowed = batch->shadowed + i * n_lights;
    for (size_t i = 0; i < n_lights; i++)
        if (shadows[i])
            TRY(shadowqueue_new(shadows[i], drawing->params->kernels, drawing->hidden,
                                &batch->queues[i], err));
    return STATUS_OK;
}

static Status make_batches(RasterPicture *picture, Err *err)
{
    int workers = picture->canvas.workers;
    picture->batch_size = picture->prepared->has_shadows ? MOST_TILES : 1;
    TRY(mem_calloc(&picture->batches, (size_t)workers, sizeof *picture->batches, "canvases", err));
    for (int i = 0; i < workers; i++)
        TRY(make_batch(picture, &picture->batches[i], err));
    return STATUS_OK;
}

static void release(RasterPicture *picture)
{
    for (int i = 0; picture->batches && i < picture->canvas.workers; i++) {
        Batch *batch = &picture->batches[i];
        rasterrow_release(&batch->row);
        for (int k = 0; batch->tiles && k < picture->batch_size; k++) {
            thincells_release(&batch->tiles[k].center);
            thincells_release(&batch->tiles[k].further);
        }
        free(batch->tiles);
        free(batch->shadowed);
        for (size_t light = 0; light < VIEW_MAX_LIGHTS; light++)
            shadowqueue_free(batch->queues[light]);
    }
    free(picture->batches);
    canvas_release(&picture->canvas);
}

static Status draw_rows(const Drawing *drawing, void *prepared, Frame *frame, Err *err)
{
    Status status;
    const RenderParams *params = drawing->params;
    RasterPicture picture = {.prepared = prepared,
                             .kernels = rasterkernels[kernels_kind(params->kernels)],
                             .chooses = params->antialias_threshold > 0};
    Canvas *canvas = &picture.canvas;
    TRY_GOTO(canvas_init(drawing, frame, &picture.prepared->bins->view.eye, canvas, err));
    if (!picture.chooses)
        canvas_blank_is_mean(canvas);
    TRY_GOTO(make_batches(&picture, err));
    TRY_GOTO(canvas_pass(canvas, false, 1, draw_row, &picture, err));
    if (canvas->more.side > 0 && picture.chooses) {
        TRY_GOTO(canvas_choose(canvas, err));
        picture.second_round = true;
        TRY_GOTO(canvas_pass(canvas, true, 1, draw_row, &picture, err));
    }
done:
    release(&picture);
    return status;
}

static bool is_asked(const Drawing *drawing)
{
    const Camera *camera = &drawing->view->camera;
    RenderMethod method = drawing->params->method;
    return method == RENDER_RASTER ||
           (method == RENDER_FASTEST &&
            rasterbins_take(drawing->geometry, camera->width, camera->height));
}

static bool can_draw(const Drawing *drawing)
{
    return drawing->geometry->n_primitives > 0 && is_asked(drawing);
}

static bool needs_rays(const Drawing *drawing)
{
    return shadowengine_needs_rays(&raster_shadows, drawing);
}

static LightBins *light_bins(const void *prepared, size_t light)
{
    const RasterPrepared *raster = prepared;
    return raster->shadows[light];
}

const Engine raster_engine = {.name = "raster",
                              .makes_codes = true,
                              .covers = true,
                              .can = can_draw,
                              .needs_rays = needs_rays,
                              .prepare = prepare,
                              .rows = draw_rows,
                              .free = release_prepared,
                              .shadows = &raster_shadows,
                              .light_bins = light_bins};
