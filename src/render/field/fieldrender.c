/* Two passes over rows of tiles: the centres of all pixels, with geometry; then, when the picture
 * is antialiased, the N x N further samples of the pixels that want them. Those are a grid of
 * samples, and so of tiles, N times as fine in either direction, whose tiles have shorter lists of
 * vessels: N rows of them are traced into a buffer for each row of pixel tiles, from where each
 * pixel adds up its own in POV-Ray's order. The buffer grows with the picture's width alone. */
#include "render/field/fieldrender.h"

#include "render/cast/caster.h"
#include "render/field/fieldshadow.h"
#include "render/field/fieldtiles.h"
#include "render/light/raycolor.h"
#include "render/light/shade.h"
#include "render/light/shadowqueue.h"
#include "render/tile/canvas.h"
#include <stdlib.h>
#include <string.h>

/* The samples of a pass over the whole picture, and the vessels that they see. */
typedef struct FieldPass {
    double *columns, *rows; /* owned; of the grid */
    SampleGrid grid;
    FieldTiles *tiles; /* owned */
} FieldPass;

/* The centres of all pixels, and the further samples; and what lights see. */
typedef struct FieldPrepared {
    FieldPass center, further;
    LightBins *shadows[VIEW_MAX_LIGHTS]; /* owned; NULL where the light casts none, or rays do */
} FieldPrepared;

/* Rows of tiles whose centres are traced together, with shadows. */
enum { ROWS_AT_ONCE = 8 };

/* A tile of a batch. */
typedef struct BatchTile {
    SeenTile seen; /* its hits are these, or NULL */
    TileHits hits;
    uint8_t (*shadowed)[TILE_SAMPLES]; /* one a light; of the batch */
    ThinCells cells;                   /* owned */
} BatchTile;

/* The tiles that a worker shades together, so that what many places ask of one tile of a light is
 * answered in one go. */
typedef struct Batch {
    BatchTile *tiles;
    int n_tiles;
    uint8_t (*shadowed)[TILE_SAMPLES];    /* tile by tile, one a light */
    ShadowQueue *queues[VIEW_MAX_LIGHTS]; /* to the shadows that there are */
    Status status;                        /* of what a visitor could not report */
    Err err;
} Batch;

/* What a worker's further samples are kept in until a band is added up. */
typedef struct FurtherRows {
    float *colors;   /* of a row of pixel tiles' samples */
    uint8_t *wanted; /* tiles of a row of the grid */
} FurtherRows;

typedef struct FieldPicture {
    Canvas canvas;
    const FieldPrepared *prepared; /* borrowed, as is `pass` */
    const FieldPass *pass;
    bool has_shadows;
    int batch_size;       /* tiles */
    Batch *batches;       /* one a worker */
    FurtherRows *further; /* likewise */
} FieldPicture;

static bool is_inside(const SeenTile *seen, int sample)
{
    return tile_sample_x(sample) < seen->n_columns && tile_sample_y(sample) < seen->n_rows;
}

/* The ray of a sample. */
static Ray sample_ray(const FieldPicture *picture, const SeenTile *seen, int sample)
{
    return camera_ray(&picture->canvas.drawing->view->camera,
                      picture->pass->grid.columns[seen->column + tile_sample_x(sample)],
                      picture->pass->grid.rows[seen->row + tile_sample_y(sample)]);
}

static Vec3 world_normal(const FieldPicture *picture, const SeenTile *seen, int sample)
{
    const float(*normal)[TILE_SAMPLES] = seen->hits->normal;
    return viewpoint_to_world(
        &picture->canvas.eye,
        vec3((double)normal[0][sample], (double)normal[1][sample], (double)normal[2][sample]));
}

/* Where the hits of a tile are. */
static void locate(const SeenTile *seen, SeenPlaces *restrict places)
{
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        places->x[sample] = seen->middle_x + (double)seen->x[sample];
        places->y[sample] = seen->middle_y + (double)seen->y[sample];
        places->z[sample] = seen->hits->z[sample];
    }
    for (int sample = 0; seen->perspective && sample < TILE_SAMPLES; sample++) {
        places->x[sample] *= places->z[sample];
        places->y[sample] *= places->z[sample];
    }
}

/* The samples inside the picture that see something, as bits. */
static uint64_t find_hits(const SeenTile *seen)
{
    const bool whole = seen->n_columns == TILE_SIDE && seen->n_rows == TILE_SIDE;
    uint64_t hits = 0;
    for (int sample = 0; sample < TILE_SAMPLES; sample++)
        if (seen->hits->state[sample] == TILE_HIT && (whole || is_inside(seen, sample)))
            hits |= (uint64_t)1 << sample;
    return hits;
}

/* One light, ray by ray. */
static void cast_shadows(const FieldPicture *picture, const SeenTile *seen, const Light *light,
                         int worker, uint64_t wanted, uint8_t shadowed[TILE_SAMPLES])
{
    const Drawing *drawing = picture->canvas.drawing;
    for (; wanted; wanted &= wanted - 1) {
        int sample = __builtin_ctzll(wanted);
        Vec3 point = ray_at(sample_ray(picture, seen, sample), seen_depth(seen, sample));
        LightWay way = light_way(light, point);
        shadowed[sample] =
            vec3_dot(world_normal(picture, seen, sample), way.towards) >= MIN_LIT_COSINE &&
            caster_shadow(drawing->caster, worker, &drawing->view->ground, point, way.towards,
                          way.distance);
    }
}

static void ask_lights(const FieldPicture *picture, int worker, const BatchTile *tile)
{
    const View *view = picture->canvas.drawing->view;
    const Batch *batch = &picture->batches[worker];
    const uint64_t hits = find_hits(&tile->seen);
    SeenPlaces places;
    locate(&tile->seen, &places);
    for (size_t i = 0; i < view->n_lights; i++) {
        const Light *light = &view->lights[i];
        if (!light->casts_shadows || light->samples > 1)
            continue;
        uint64_t wanted =
            hits & picture->canvas.kernels->face(&tile->seen, &places, tile->seen.hits->normal,
                                                 &picture->canvas.look.lights[i]);
        size_t answer = (size_t)(tile->shadowed + i - batch->shadowed) * TILE_SAMPLES;
        if (batch->queues[i])
            shadowqueue_add(batch->queues[i], &places, NULL, wanted, (uint32_t)answer);
        else
            cast_shadows(picture, &tile->seen, light, worker, wanted, tile->shadowed[i]);
    }
}

/* Sets whether each light is hidden from the hits of the batch. */
static Status find_shadows(const FieldPicture *picture, int worker, Err *err)
{
    Batch *batch = &picture->batches[worker];
    const Drawing *drawing = picture->canvas.drawing;
    size_t n_lights = drawing->view->n_lights;
    memset(batch->shadowed, 0, (size_t)batch->n_tiles * n_lights * sizeof *batch->shadowed);
    for (int i = 0; i < batch->n_tiles; i++)
        if (batch->tiles[i].seen.hits)
            ask_lights(picture, worker, &batch->tiles[i]);
    for (size_t i = 0; i < n_lights; i++)
        if (batch->queues[i])
            TRY(shadowqueue_answer(batch->queues[i], batch->shadowed[0], err));
    return STATUS_OK;
}

/* Every sample on its own, with all that the kernel does not know. */
static void color_samples(const FieldPicture *picture, int worker, const SeenTile *seen,
                          float color[3][TILE_SAMPLES])
{
    const Drawing *drawing = picture->canvas.drawing;
    const SampleGrid *grid = &picture->pass->grid;
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        if (!is_inside(seen, sample))
            continue;
        int column = seen->column + tile_sample_x(sample), row = seen->row + tile_sample_y(sample);
        Surfel surfel, *hit = NULL;
        if (seen->hits && seen->hits->state[sample] == TILE_HIT) {
            uint32_t index = seen->hits->segment[sample];
            surfel = (Surfel){.t = seen_depth(seen, sample),
                              .normal = vec3_normalized(world_normal(picture, seen, sample)),
                              .segment = drawing->geometry->segments[index].segment};
            hit = &surfel;
        }
        Rgb rgb = ray_color(drawing, worker, sample_ray(picture, seen, sample),
                            grid->columns[column], grid->rows[row], hit);
        color[0][sample] = rgb.r;
        color[1][sample] = rgb.g;
        color[2][sample] = rgb.b;
    }
}

/* The colours of a tile; NULL: the background's. */
static float (*color_tile(const FieldPicture *picture, int worker, BatchTile *tile))[TILE_SAMPLES]
{
    const SeenTile *seen = &tile->seen;
    float(*color)[TILE_SAMPLES] = NULL;
    if (picture->canvas.wholly_colored) {
        color = picture->canvas.each[worker].color;
        color_samples(picture, worker, seen, color);
    } else if (seen->hits) {
        color = canvas_shade(&picture->canvas, worker, seen,
                             picture->has_shadows ? (const uint8_t(*)[TILE_SAMPLES])tile->shadowed
                                                  : NULL);
    }
    return canvas_cover(&picture->canvas, worker, seen, &tile->cells, 0, 0, color);
}

/* Shades the tiles of the batch, and has `keep` store each. */
static Status shade_batch(const FieldPicture *picture, int worker,
                          void (*keep)(const BatchTile *tile, float (*color)[TILE_SAMPLES],
                                       int worker, void *context),
                          void *context, Err *err)
{
    Batch *batch = &picture->batches[worker];
    if (picture->has_shadows && !picture->canvas.wholly_colored && picture->canvas.wants_color)
        TRY(find_shadows(picture, worker, err));
    for (int i = 0; i < batch->n_tiles; i++) {
        BatchTile *tile = &batch->tiles[i];
        keep(tile, picture->canvas.wants_color ? color_tile(picture, worker, tile) : NULL, worker,
             context);
    }
    batch->n_tiles = 0;
    return STATUS_OK;
}

/* Finds the thin vessels of the tile that the batch gets next. */
static void find_thin(const FieldPicture *picture, const SeenTile *seen, Batch *batch)
{
    const Canvas *canvas = &picture->canvas;
    const int per_pixel = picture->pass->grid.n_columns / canvas->drawing->view->camera.width;
    if (batch->status == STATUS_OK)
        batch->status = thincells_fill(canvas->wants_color ? canvas->drawing->thin : NULL,
                                       per_pixel, seen->column, seen->row, TILE_SIDE, TILE_SIDE,
                                       &batch->tiles[batch->n_tiles].cells, &batch->err);
}

/* Whether the tile that the batch gets next has anything but the background's colour. */
static bool shows_something(const FieldPicture *picture, const SeenTile *vessels,
                            const Batch *batch)
{
    return vessels->hits || picture->canvas.drawing->view->ground.present ||
           picture->canvas.wholly_colored || batch->tiles[batch->n_tiles].cells.n > 0;
}

/* Adds a tile to the batch, with the ground where the canvas shades that. */
static void add_tile(const FieldPicture *picture, const SeenTile *vessels, Batch *batch)
{
    BatchTile *tile = &batch->tiles[batch->n_tiles++];
    tile->seen = *vessels;
    if (vessels->hits) {
        tile->hits = *vessels->hits;
        tile->seen.hits = &tile->hits;
    }
    if (!picture->canvas.wholly_colored && picture->canvas.drawing->view->ground.present)
        canvas_see_ground(&picture->canvas, &tile->seen, &tile->hits);
}

static void keep_center(const BatchTile *tile, float (*color)[TILE_SAMPLES], int worker,
                        void *context)
{
    const FieldPicture *picture = context;
    if (tile->seen.hits || color)
        canvas_draw(&picture->canvas, worker, &tile->seen, color);
}

static void visit_center(const SeenTile *vessels, int worker, void *context)
{
    FieldPicture *picture = context;
    Batch *batch = &picture->batches[worker];
    find_thin(picture, vessels, batch);
    if (batch->status != STATUS_OK)
        return;
    if (shows_something(picture, vessels, batch))
        add_tile(picture, vessels, batch);
    if (batch->n_tiles == picture->batch_size)
        batch->status = shade_batch(picture, worker, keep_center, picture, &batch->err);
}

static Status batch_status(const Batch *batch, Err *err)
{
    if (batch->status != STATUS_OK && err)
        *err = batch->err;
    return batch->status;
}

static Status trace_centers(void *context, int first, int rows, int worker, Err *err)
{
    FieldPicture *picture = context;
    for (int row = first; row < first + rows; row++)
        TRY(fieldtiles_trace(picture->pass->tiles, (size_t)row, worker, NULL, visit_center, picture,
                             err));
    TRY(batch_status(&picture->batches[worker], err));
    return shade_batch(picture, worker, keep_center, picture, err);
}

/* Where the colours of a row of pixel tiles' further samples go. */
typedef struct FurtherVisit {
    const FieldPicture *picture;
    int first_row; /* of the grid */
} FurtherVisit;

static void keep_further(const BatchTile *tile, float (*color)[TILE_SAMPLES], int worker,
                         void *context)
{
    const FurtherVisit *visit = context;
    const FieldPicture *picture = visit->picture;
    const SeenTile *seen = &tile->seen;
    size_t width = (size_t)picture->pass->grid.n_columns;
    canvas_store(&picture->canvas, seen->n_columns, seen->n_rows, color,
                 picture->further[worker].colors +
                     3 * ((size_t)(seen->row - visit->first_row) * width + (size_t)seen->column),
                 3 * width);
}

static void visit_further(const SeenTile *vessels, int worker, void *context)
{
    FurtherVisit *visit = context;
    Batch *batch = &visit->picture->batches[worker];
    find_thin(visit->picture, vessels, batch);
    if (batch->status != STATUS_OK)
        return;
    if (!shows_something(visit->picture, vessels, batch)) {
        const BatchTile empty = {.seen = *vessels};
        keep_further(&empty, NULL, worker, visit);
        return;
    }
    add_tile(visit->picture, vessels, batch);
    if (batch->n_tiles == visit->picture->batch_size)
        batch->status = shade_batch(visit->picture, worker, keep_further, visit, &batch->err);
}

static bool wants_more(const FieldPicture *picture, int i, int j)
{
    return resampling_wants(&picture->canvas.more, canvas_pixel(&picture->canvas, i, j));
}

/* The first row of pixels below a row of tiles that is not the band's. */
static int end_row(const FieldPicture *picture, int row)
{
    const Band *band = &picture->canvas.drawing->band;
    return row * TILE_SIDE + tile_extent(band->first + band->rows - row * TILE_SIDE);
}

/* Marks the tiles of one row of tiles of the grid that hold samples of pixels that want more. */
static bool mark_wanted(const FieldPicture *picture, int tile_row, int end, uint8_t *wanted)
{
    int n = picture->canvas.more.side, width = picture->canvas.drawing->view->camera.width;
    int first = tile_row * TILE_SIDE / n, last = (tile_row * TILE_SIDE + TILE_SIDE - 1) / n;
    bool any = false;
    memset(wanted, 0, fieldtiles_columns(picture->pass->tiles));
    for (int j = first; j <= last && j < end; j++)
        for (int i = 0; i < width; i++)
            if (wants_more(picture, i, j)) {
                any = true;
                for (int tile = i * n / TILE_SIDE; tile <= (i * n + n - 1) / TILE_SIDE; tile++)
                    wanted[tile] = 1;
            }
    return any;
}

/* The mean of a pixel's centre and further samples, summed row by row in float; `samples` are those
 * of its row of pixels. */
static void add_up(const FieldPicture *picture, const float *samples, int i, int j)
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

static Status trace_further(void *context, int row, int rows, int worker, Err *err)
{
    (void)rows; /* one */
    FieldPicture *picture = context;
    FurtherRows *own = &picture->further[worker];
    int n = picture->canvas.more.side, width = picture->canvas.drawing->view->camera.width;
    int end = end_row(picture, row), first = row * TILE_SIDE;
    FurtherVisit visit = {picture, first * n};
    for (int i = row * n; i < (row + 1) * n && i < (int)fieldtiles_rows(picture->pass->tiles); i++)
        if (mark_wanted(picture, i, end, own->wanted))
            TRY(fieldtiles_trace(picture->pass->tiles, (size_t)i, worker, own->wanted,
                                 visit_further, &visit, err));
    TRY(batch_status(&picture->batches[worker], err));
    TRY(shade_batch(picture, worker, keep_further, &visit, err));
    size_t pixels = 3 * (size_t)picture->pass->grid.n_columns * (size_t)n; /* of a row of pixels */
    for (int j = first; j < end; j++)
        for (int i = 0; i < width; i++)
            if (wants_more(picture, i, j))
                add_up(picture, own->colors + (size_t)(j - first) * pixels, i, j);
    return STATUS_OK;
}

/* ---- the picture ----------------------------------------------------------------------------- */

/* Makes a pass of `n` x `n` samples a pixel at the offsets given. */
static Status prepare_pass(const Drawing *drawing, int n, const double *offsets, FieldPass *pass,
                           Err *err)
{
    const RenderParams *params = drawing->params;
    const Camera *camera = &drawing->view->camera;
    int width = camera->width * n, height = camera->height * n;
    double nearest = caster_nearest_mm(drawing->geometry);
    TRY(mem_calloc(&pass->columns, (size_t)width, sizeof *pass->columns, "columns", err));
    TRY(mem_calloc(&pass->rows, (size_t)height, sizeof *pass->rows, "rows", err));
    for (int i = 0; i < width; i++)
        pass->columns[i] = i / n + offsets[i % n];
    for (int j = 0; j < height; j++)
        pass->rows[j] = j / n + offsets[j % n];
    pass->grid = (SampleGrid){pass->columns, pass->rows, width, height, 1.0 / n, drawing->hidden};
    TRY(fieldtiles_new(drawing->geometry, camera, &pass->grid, nearest, params->threads,
                       &pass->tiles, err));
    fieldtiles_use_kernel(pass->tiles, fieldkernels_for(drawing->geometry, params->kernels)->trace);
    return STATUS_OK;
}

static void release_pass(FieldPass *pass)
{
    fieldtiles_free(pass->tiles);
    free(pass->columns);
    free(pass->rows);
}

static void release_prepared(void *prepared)
{
    FieldPrepared *field = prepared;
    release_pass(&field->center);
    release_pass(&field->further);
    for (size_t i = 0; i < VIEW_MAX_LIGHTS; i++)
        lightbins_free(field->shadows[i]);
    free(field);
}

static Status prepare(const Drawing *drawing, void **prepared, Err *err)
{
    Status status;
    const double center = 0;
    const Viewpoint eye = viewpoint_of_camera(&drawing->view->camera);
    Resampling more = resampling_for(drawing->params->want_color ? drawing->params->antialias : 1);
    FieldPrepared *field;
    TRY(mem_calloc(&field, 1, sizeof *field, "tiles", err));
    TRY_GOTO(prepare_pass(drawing, 1, &center, &field->center, err));
    if (more.side > 0)
        TRY_GOTO(prepare_pass(drawing, more.side, more.offsets, &field->further, err));
    if (drawing->params->shadows)
        TRY_GOTO(lightbins_new_hard(&field_shadows, drawing, &eye, field->shadows, err));
    *prepared = field;
done:
    if (status != STATUS_OK)
        release_prepared(field);
    return status;
}

static Status make_batch(const FieldPicture *picture, Batch *batch, Err *err)
{
    size_t n = (size_t)picture->batch_size, n_lights = picture->canvas.drawing->view->n_lights;
    TRY(mem_calloc(&batch->tiles, n, sizeof *batch->tiles, "tiles", err));
    TRY(mem_calloc(&batch->shadowed, n * n_lights, sizeof *batch->shadowed, "lights", err));
    for (size_t i = 0; i < n; i++)
        batch->tiles[i].shadowed = batch->shadowed + i * n_lights;
    for (size_t i = 0; i < n_lights; i++)
        if (picture->prepared->shadows[i])
            TRY(shadowqueue_new(picture->prepared->shadows[i],
                                picture->canvas.drawing->params->kernels,
                                picture->canvas.drawing->hidden, &batch->queues[i], err));
    return STATUS_OK;
}

static Status make_batches(FieldPicture *picture, Err *err)
{
    int workers = picture->canvas.workers;
    picture->batch_size = picture->has_shadows ? SHADOW_BATCH : 1;
    TRY(mem_calloc(&picture->batches, (size_t)workers, sizeof *picture->batches, "canvases", err));
    for (int i = 0; i < workers; i++)
        TRY(make_batch(picture, &picture->batches[i], err));
    return STATUS_OK;
}

static void release_batch(Batch *batch, int n)
{
    for (int i = 0; batch->tiles && i < n; i++)
        thincells_release(&batch->tiles[i].cells);
    free(batch->tiles);
    free(batch->shadowed);
    for (size_t i = 0; i < VIEW_MAX_LIGHTS; i++)
        shadowqueue_free(batch->queues[i]);
}

static Status make_further_rows(FieldPicture *picture, Err *err)
{
    size_t n = (size_t)picture->canvas.more.side, workers = (size_t)picture->canvas.workers;
    TRY(mem_calloc(&picture->further, workers, sizeof *picture->further, "bands", err));
    for (size_t i = 0; i < workers; i++) {
        FurtherRows *own = &picture->further[i];
        TRY(mem_calloc(&own->colors, (size_t)picture->pass->grid.n_columns * TILE_SIDE * n,
                       3 * sizeof *own->colors, "bands", err));
        TRY(mem_calloc(&own->wanted, fieldtiles_columns(picture->pass->tiles), 1, "bands", err));
    }
    return STATUS_OK;
}

/* The second pass, over all pixels or those that differ from their neighbours. */
static Status antialias(FieldPicture *picture, Err *err)
{
    TRY(canvas_choose(&picture->canvas, err));
    TRY(make_further_rows(picture, err));
    return canvas_pass(&picture->canvas, true, 1, trace_further, picture, err);
}

static void release(FieldPicture *picture)
{
    for (int i = 0; picture->further && i < picture->canvas.workers; i++) {
        free(picture->further[i].colors);
        free(picture->further[i].wanted);
    }
    free(picture->further);
    for (int i = 0; picture->batches && i < picture->canvas.workers; i++)
        release_batch(&picture->batches[i], picture->batch_size);
    free(picture->batches);
    canvas_release(&picture->canvas);
}

static Status draw_rows(const Drawing *drawing, void *prepared, Frame *frame, Err *err)
{
    Status status;
    const FieldPrepared *field = prepared;
    FieldPicture picture = {
        .prepared = field, .pass = &field->center, .has_shadows = drawing->params->shadows};
    Canvas *canvas = &picture.canvas;
    const Viewpoint eye = viewpoint_of_camera(&drawing->view->camera);
    TRY_GOTO(canvas_init(drawing, frame, &eye, canvas, err));
    canvas->wholly_colored = drawing->params->method == RENDER_TRACE &&
                             raycolor_is_needed(drawing->view, drawing->params);
    TRY_GOTO(make_batches(&picture, err));
    TRY_GOTO(canvas_pass(canvas, false, picture.has_shadows ? ROWS_AT_ONCE : 1, trace_centers,
                         &picture, err));
    picture.pass = &field->further;
    if (canvas->more.side > 0)
        TRY_GOTO(antialias(&picture, err));
done:
    release(&picture);
    return status;
}

static bool can_draw(const Drawing *drawing)
{
    const SceneModel model = drawing->geometry->model;
    return model_has(model, MODEL_BLOB)
               ? drawing->params->method != RENDER_TRACE
               : model_has(model, MODEL_POTENTIAL) && !drawing->params->povray_cells;
}

static bool needs_rays(const Drawing *drawing)
{
    return shadowengine_needs_rays(&field_shadows, drawing);
}

static LightBins *light_bins(const void *prepared, size_t light)
{
    const FieldPrepared *field = prepared;
    return field->shadows[light];
}

const Engine field_engine = {.name = "field",
                             .makes_codes = true,
                             .covers = true,
                             .can = can_draw,
                             .needs_rays = needs_rays,
                             .prepare = prepare,
                             .rows = draw_rows,
                             .free = release_prepared,
                             .shadows = &field_shadows,
                             .light_bins = light_bins};
