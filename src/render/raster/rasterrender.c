/* A row of tiles is the unit of work: its lists are made, and tile by tile primitives are found,
 * shaded and written, so that a pixel is written once and what is empty is filled row by row. With
 * shadows that is done for batches of tiles, whose places are many enough in each tile of a light.
 * Further samples of a tile's pixels use its list: pass after pass, each with all samples of the
 * tile moved by the same part of a pixel, in POV-Ray's order. With a threshold that takes the
 * colours of neighbours, and so a second round. */
#include "render/raster/rasterrender.h"

#include "render/light/resample.h"
#include "render/raster/rasterkernels.h"
#include "render/tile/tilelook.h"
#include <stdlib.h>
#include <string.h>

/* A tile of the picture and the part of it that is inside. */
typedef struct Place {
    int column, row;       /* of its first pixel */
    int n_columns, n_rows; /* pixels of it inside the picture */
} Place;

/* A tile and what it sees. */
typedef struct Sheet {
    Place place;
    RasterTile tile;
    RasterHits hits;
    uint64_t seen; /* bit i: sample i sees something */
    TileHits surfels;
    uint8_t (*shadowed)[TILE_SAMPLES]; /* one a light; of the canvas */
    float sum[3][TILE_SAMPLES];        /* of all samples of a pixel */
} Sheet;

/* What a worker writes to. */
typedef struct Canvas {
    RasterRow row;
    Sheet *sheets; /* a batch */
    int n_sheets;
    uint8_t (*shadowed)[TILE_SAMPLES]; /* sheet by sheet, one a light */
    RasterQueue **queues;              /* one a light; NULL where the light has no RasterShadow */
    TileSurface surface;
    float color[3][TILE_SAMPLES];
    Status status;
    Err err;
} Canvas;

typedef struct RasterPicture {
    const Scene *scene;
    const RenderParams *params;
    const Band *band; /* that the frame holds */
    Frame *frame;
    const RasterBins *bins; /* of the whole picture */
    const RasterKernels *kernels;
    const TileKernels *shading;
    RasterGrid center;
    RasterGrid *further; /* n x n, row by row */
    int n_further;
    TileLook look;
    TileLight *lights;
    RasterShadow **shadows;      /* one a light, of RasterPrepared; NULL without shadows */
    Caster *caster;              /* likewise */
    bool needs_places;           /* rays or lights differ from sample to sample */
    SrgbCodes codes;             /* set if the frame is to have codes */
    float *background;           /* a row of the picture */
    uint8_t *background_codes;   /* likewise, if the frame is to have them */
    float *resampled_background; /* the mean of as many backgrounds as there are samples */
    uint8_t *mask;               /* pixels that get further samples; NULL: all */
    bool second_round;
    Canvas *canvases;
    int workers;
    int batch; /* tiles */
} RasterPicture;

static size_t pixel_at(const RasterPicture *picture, const Place *place, int i, int j)
{
    size_t width = (size_t)picture->scene->camera.width;
    return (size_t)(place->row + j) * width + (size_t)(place->column + i);
}

/* ---- one sample a pixel ---------------------------------------------------------------------- */

static double seen_z(const RasterTile *tile, const RasterHits *hits, int sample)
{
    return tile->z_middle + (double)hits->z[sample];
}

/* Rays and places in perspective; parallel rays never change, and lights that are not parallel need
 * places there, too. */
static void place_surface(const RasterTile *tile, const RasterHits *hits, TileSurface *surface)
{
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        if (hits->item[sample] == RASTER_NOTHING)
            continue;
        double x = tile->x + (double)tile->grid->x[sample];
        double y = tile->y + (double)tile->grid->y[sample], z = seen_z(tile, hits, sample);
        double scale = tile->perspective ? z : 1, per = 1 / sqrt(1 + x * x + y * y);
        surface->point[0][sample] = (float)(x * scale);
        surface->point[1][sample] = (float)(y * scale);
        surface->point[2][sample] = (float)z;
        if (!tile->perspective)
            continue;
        surface->direction[0][sample] = (float)(x * per);
        surface->direction[1][sample] = (float)(y * per);
        surface->direction[2][sample] = (float)per;
    }
}

/* The normal in the world, facing the viewer. */
static Vec3 seen_normal(const RasterPicture *picture, const RasterTile *tile,
                        const TileHits *surfels, int sample)
{
    Vec3 normal = {(double)surfels->normal[0][sample], (double)surfels->normal[1][sample],
                   (double)surfels->normal[2][sample]};
    Vec3 sight = {0, 0, 1};
    if (tile->perspective)
        sight = vec3(tile->x + (double)tile->grid->x[sample],
                     tile->y + (double)tile->grid->y[sample], 1);
    if (vec3_dot(normal, sight) > 0)
        normal = vec3_scale(normal, -1);
    return rasterview_to_world(&picture->bins->view, normal);
}

/* Of the samples that see something, as bits, those whose surface faces the light. */
static uint64_t find_facing(const RasterPicture *picture, const Sheet *sheet,
                            const TileLight *light, const RasterPlaces *places)
{
    uint8_t facing[TILE_SAMPLES];
    uint64_t wanted = 0;
    picture->kernels->face(&sheet->tile, places, sheet->surfels.normal, light, facing);
    for (uint64_t left = sheet->seen; left; left &= left - 1) {
        int sample = __builtin_ctzll(left);
        wanted |= (uint64_t)facing[sample] << sample;
    }
    return wanted;
}

/* One light, ray by ray. */
static void cast_shadows(const RasterPicture *picture, const Light *light, int worker,
                         const RasterPlaces *places, uint64_t wanted,
                         uint8_t shadowed[TILE_SAMPLES])
{
    const RasterView *view = &picture->bins->view;
    for (; wanted; wanted &= wanted - 1) {
        int sample = __builtin_ctzll(wanted);
        Vec3 at = {places->x[sample], places->y[sample], places->z[sample]};
        Vec3 place = vec3_add(view->location, rasterview_to_world(view, at));
        Vec3 to_light = vec3_sub(light->location, place);
        double distance = vec3_length(to_light);
        shadowed[sample] = caster_shadow(picture->caster, worker, place,
                                         vec3_scale(to_light, 1 / distance), distance);
    }
}

static void ask_lights(const RasterPicture *picture, const Sheet *sheet, int worker, Canvas *canvas)
{
    const Scene *scene = picture->scene;
    RasterPlaces places;
    picture->kernels->locate(&sheet->tile, &sheet->hits, &places);
    for (size_t i = 0; i < scene->n_lights; i++) {
        const Light *light = &scene->lights[i];
        if (!light->casts_shadows)
            continue;
        uint64_t wanted = find_facing(picture, sheet, &picture->lights[i], &places);
        size_t answer = (size_t)(sheet->shadowed + i - canvas->shadowed) * TILE_SAMPLES;
        if (canvas->queues[i])
            rasterqueue_ask(canvas->queues[i], picture->kernels, &places, sheet->hits.item, wanted,
                            (uint32_t)answer);
        else
            cast_shadows(picture, light, worker, &places, wanted, sheet->shadowed[i]);
    }
}

static void find_shadows(const RasterPicture *picture, int worker, Canvas *canvas)
{
    size_t n_lights = picture->scene->n_lights;
    memset(canvas->shadowed, 0, (size_t)canvas->n_sheets * n_lights * sizeof *canvas->shadowed);
    for (int i = 0; i < canvas->n_sheets; i++)
        if (canvas->sheets[i].seen)
            ask_lights(picture, &canvas->sheets[i], worker, canvas);
    for (size_t i = 0; i < n_lights; i++)
        if (canvas->queues[i])
            rasterqueue_answer(canvas->queues[i], picture->kernels, canvas->shadowed[0]);
}

static bool wants_color(const Frame *frame)
{
    return frame->color.values || frame->codes.codes8;
}

/* What the tiles of the batch see with their samples at the places of a grid. */
static void see_batch(const RasterPicture *picture, const RasterGrid *grid, int worker,
                      Canvas *canvas)
{
    const RasterKernels *kernels = picture->kernels;
    for (int i = 0; i < canvas->n_sheets; i++) {
        Sheet *sheet = &canvas->sheets[i];
        sheet->tile.grid = grid;
        sheet->seen = kernels->trace(&sheet->tile, &sheet->hits, &sheet->surfels);
        if (sheet->seen)
            kernels->resolve(&sheet->tile, &sheet->hits, &sheet->surfels);
    }
    if (picture->shadows)
        find_shadows(picture, worker, canvas);
}

/* The colours that the samples of a tile see, which sees something, in canvas->color. */
static void color_sheet(const RasterPicture *picture, const Sheet *sheet, Canvas *canvas)
{
    const Scene *scene = picture->scene;
    TileSurface *surface = &canvas->surface;
    surface->hits = &sheet->surfels;
    if (!scene->uniform_color)
        for (int sample = 0; sample < TILE_SAMPLES; sample++) {
            if (sheet->surfels.state[sample] != TILE_HIT)
                continue;
            Rgb pigment = scene->primitives[sheet->surfels.segment[sample]].color;
            surface->pigment[0][sample] = pigment.r;
            surface->pigment[1][sample] = pigment.g;
            surface->pigment[2][sample] = pigment.b;
        }
    if (picture->needs_places)
        place_surface(&sheet->tile, &sheet->hits, surface);
    if (picture->shadows)
        surface->shadowed = (const uint8_t(*)[TILE_SAMPLES])sheet->shadowed;
    picture->shading->shade(&picture->look, surface, canvas->color);
    const float background[3] = {scene->background.r, scene->background.g, scene->background.b};
    if (picture->frame->color.values)
        picture->kernels->clear(&sheet->hits, background, canvas->color);
}

static void write_codes(const RasterPicture *picture, const Sheet *sheet, Canvas *canvas)
{
    const Place *place = &sheet->place;
    tilelook_encode(picture->shading, &picture->codes, canvas->color, sheet->surfels.state,
                    picture->background_codes, place->n_columns, place->n_rows,
                    &picture->frame->codes.codes8[3 * pixel_at(picture, place, 0, 0)],
                    3 * (size_t)picture->scene->camera.width);
}

/* Rows of the background, or of its codes. */
static void write_background(const RasterPicture *picture, const Place *place,
                             const float *background)
{
    const Frame *frame = picture->frame;
    size_t n = 3 * (size_t)place->n_columns;
    for (int j = 0; j < place->n_rows; j++) {
        size_t first = 3 * pixel_at(picture, place, 0, j);
        if (frame->color.values)
            memcpy(frame->color.values + first, background, n * sizeof *background);
        if (frame->codes.codes8)
            memcpy(frame->codes.codes8 + first, picture->background_codes, n);
    }
}

static void write_colors(const RasterPicture *picture, const Place *place,
                         float color[3][TILE_SAMPLES])
{
    if (place->n_columns == TILE_SIDE && place->n_rows == TILE_SIDE) {
        picture->kernels->paint(color,
                                &picture->frame->color.values[3 * pixel_at(picture, place, 0, 0)],
                                3 * (size_t)picture->scene->camera.width);
        return;
    }
    for (int j = 0; j < place->n_rows; j++) {
        float *pixel = &picture->frame->color.values[3 * pixel_at(picture, place, 0, j)];
        for (int i = 0; i < place->n_columns; i++, pixel += 3) {
            int sample = tile_sample_at(i, j);
            pixel[0] = color[0][sample];
            pixel[1] = color[1][sample];
            pixel[2] = color[2][sample];
        }
    }
}

static double seen_depth(const RasterTile *tile, const RasterHits *hits, int sample)
{
    double x = tile->x + (double)tile->grid->x[sample];
    double y = tile->y + (double)tile->grid->y[sample];
    return seen_z(tile, hits, sample) * (tile->perspective ? sqrt(1 + x * x + y * y) : 1);
}

/* `sheet` NULL: nothing is seen in the whole place. */
static void write_geometry(const RasterPicture *picture, const Place *place, const Sheet *sheet)
{
    const Frame *frame = picture->frame;
    for (int j = 0; j < place->n_rows; j++)
        for (int i = 0; i < place->n_columns; i++) {
            int sample = tile_sample_at(i, j);
            bool hit = sheet && sheet->hits.item[sample] != RASTER_NOTHING;
            size_t pixel = pixel_at(picture, place, i, j);
            if (frame->depth.values)
                frame->depth.values[pixel] =
                    hit ? (float)seen_depth(&sheet->tile, &sheet->hits, sample) : HUGE_VALF;
            if (frame->normal.values) {
                Vec3 normal = hit ? seen_normal(picture, &sheet->tile, &sheet->surfels, sample)
                                  : vec3(0, 0, 0);
                frame->normal.values[3 * pixel] = (float)normal.x;
                frame->normal.values[3 * pixel + 1] = (float)normal.y;
                frame->normal.values[3 * pixel + 2] = (float)normal.z;
            }
            if (frame->id.ids)
                frame->id.ids[pixel] =
                    hit ? picture->scene->primitives[sheet->surfels.segment[sample]].id : 0;
        }
}

/* ---- further samples ------------------------------------------------------------------------- */

static bool wants_more(const RasterPicture *picture, const Place *place, int i, int j)
{
    return !picture->mask || picture->mask[pixel_at(picture, place, i, j)];
}

static bool any_wants_more(const RasterPicture *picture, const Place *place)
{
    for (int j = 0; j < place->n_rows; j++)
        for (int i = 0; i < place->n_columns; i++)
            if (wants_more(picture, place, i, j))
                return true;
    return false;
}

static void begin_sum(const RasterPicture *picture, Sheet *sheet)
{
    const Place *place = &sheet->place;
    const float *values = picture->frame->color.values;
    for (int j = 0; j < place->n_rows; j++)
        for (int i = 0; i < place->n_columns; i++)
            for (int c = 0; c < 3; c++)
                sheet->sum[c][tile_sample_at(i, j)] =
                    values[3 * pixel_at(picture, place, i, j) + (size_t)c];
}

static void add_to_sum(const RasterPicture *picture, Sheet *sheet, Canvas *canvas)
{
    const Scene *scene = picture->scene;
    const float background[3] = {scene->background.r, scene->background.g, scene->background.b};
    if (sheet->seen)
        color_sheet(picture, sheet, canvas);
    for (int c = 0; c < 3; c++)
        for (int sample = 0; sample < TILE_SAMPLES; sample++)
            sheet->sum[c][sample] += sheet->seen ? canvas->color[c][sample] : background[c];
}

static void write_mean(const RasterPicture *picture, const Sheet *sheet)
{
    const Place *place = &sheet->place;
    float *values = picture->frame->color.values;
    for (int j = 0; j < place->n_rows; j++)
        for (int i = 0; i < place->n_columns; i++)
            for (int c = 0; c < 3 && wants_more(picture, place, i, j); c++)
                values[3 * pixel_at(picture, place, i, j) + (size_t)c] =
                    (float)((double)sheet->sum[c][tile_sample_at(i, j)] / (picture->n_further + 1));
}

/* The means of the centre samples, which the picture holds, and all others, summed in float in
 * POV-Ray's order. */
static void resample_batch(const RasterPicture *picture, int worker, Canvas *canvas)
{
    for (int i = 0; i < canvas->n_sheets; i++)
        begin_sum(picture, &canvas->sheets[i]);
    for (int pass = 0; pass < picture->n_further; pass++) {
        see_batch(picture, &picture->further[pass], worker, canvas);
        for (int i = 0; i < canvas->n_sheets; i++)
            add_to_sum(picture, &canvas->sheets[i], canvas);
    }
    for (int i = 0; i < canvas->n_sheets; i++)
        write_mean(picture, &canvas->sheets[i]);
}

/* ---- rows ------------------------------------------------------------------------------------ */

/* Columns of tiles from `first` to below `last`, which see nothing. */
static void fill_background(const RasterPicture *picture, int row, int first, int last,
                            const float *background)
{
    const Camera *camera = &picture->scene->camera;
    int end = last * TILE_SIDE < camera->width ? last * TILE_SIDE : camera->width;
    int n_rows = picture->band->rows - row * TILE_SIDE;
    Place place = {first * TILE_SIDE, row * TILE_SIDE, end - first * TILE_SIDE,
                   n_rows < TILE_SIDE ? n_rows : TILE_SIDE};
    if (place.n_columns <= 0)
        return;
    const Frame *frame = picture->frame;
    write_background(picture, &place, background);
    if (frame->depth.values || frame->normal.values || frame->id.ids)
        write_geometry(picture, &place, NULL);
}

static void draw_sheet(const RasterPicture *picture, const Sheet *sheet, Canvas *canvas)
{
    const Frame *frame = picture->frame;
    if (!sheet->seen)
        write_background(picture, &sheet->place, picture->background);
    else if (wants_color(frame))
        color_sheet(picture, sheet, canvas);
    if (frame->color.values && sheet->seen)
        write_colors(picture, &sheet->place, canvas->color);
    if (frame->codes.codes8 && sheet->seen)
        write_codes(picture, sheet, canvas);
    if (frame->depth.values || frame->normal.values || frame->id.ids)
        write_geometry(picture, &sheet->place, sheet->seen ? sheet : NULL);
}

static void draw_batch(const RasterPicture *picture, bool further, int worker, Canvas *canvas)
{
    if (!picture->second_round) {
        see_batch(picture, &picture->center, worker, canvas);
        for (int i = 0; i < canvas->n_sheets; i++)
            draw_sheet(picture, &canvas->sheets[i], canvas);
    }
    if (further)
        resample_batch(picture, worker, canvas);
    canvas->n_sheets = 0;
}

static Place place_of(const RasterPicture *picture, int column, int row)
{
    int n_columns = picture->scene->camera.width - column * TILE_SIDE;
    int n_rows = picture->band->rows - row * TILE_SIDE;
    return (Place){column * TILE_SIDE, row * TILE_SIDE,
                   n_columns < TILE_SIDE ? n_columns : TILE_SIDE,
                   n_rows < TILE_SIDE ? n_rows : TILE_SIDE};
}

static void draw_row(size_t row, int worker, void *context)
{
    const RasterPicture *picture = context;
    const RasterBins *bins = picture->bins;
    const Camera *camera = &picture->scene->camera;
    Canvas *canvas = &picture->canvases[worker];
    bool further = picture->n_further > 0 && picture->frame->color.values &&
                   (picture->second_round || picture->params->antialias_threshold == 0);
    if (worker == 0)
        band_progress(picture->band, picture->params, camera->height, picture->second_round,
                      (double)row * TILE_SIDE / picture->band->rows);
    if (canvas->status != STATUS_OK)
        return;
    int tile_row = picture->band->first / TILE_SIDE + (int)row;
    canvas->status = rasterbins_list(bins, (size_t)tile_row, &canvas->row, &canvas->err);
    if (canvas->status != STATUS_OK)
        return;
    const uint32_t *offsets = canvas->row.offsets;
    const float *background = further ? picture->resampled_background : picture->background;
    int empty = 0; /* the first column of a run of empty tiles */
    for (int column = 0; column < bins->tile_columns; column++) {
        uint32_t n = offsets[column + 1] - offsets[column];
        if (n == 0)
            continue;
        if (!picture->second_round)
            fill_background(picture, (int)row, empty, column, background);
        empty = column + 1;
        Sheet *sheet = &canvas->sheets[canvas->n_sheets];
        sheet->place = place_of(picture, column, (int)row);
        sheet->tile = rasterbins_tile(bins, column, tile_row, canvas->row.lists + offsets[column],
                                      n, &picture->center);
        if (picture->second_round && !any_wants_more(picture, &sheet->place))
            continue;
        if (++canvas->n_sheets == picture->batch)
            draw_batch(picture, further, worker, canvas);
    }
    draw_batch(picture, further, worker, canvas);
    if (!picture->second_round)
        fill_background(picture, (int)row, empty, bins->tile_columns, background);
}

/* ---- the picture ----------------------------------------------------------------------------- */

static Status prepare_shadows(const Scene *scene, const RasterView *view, int workers,
                              RasterPrepared *prepared, Err *err)
{
    bool rays = false;
    TRY(mem_calloc(&prepared->shadows, scene->n_lights, sizeof *prepared->shadows, "lights", err));
    prepared->n_lights = scene->n_lights;
    TRY(rastershadows_new(scene, view, workers, prepared->shadows, err));
    for (size_t i = 0; i < scene->n_lights; i++)
        rays |= scene->lights[i].casts_shadows && !prepared->shadows[i];
    return rays ? caster_new(scene, NULL, workers, &prepared->caster, err) : STATUS_OK;
}

static Status prepare(const Scene *scene, const RasterView *view, bool shadows, int workers,
                      RasterPrepared *prepared, Err *err)
{
    if (shadows)
        TRY(prepare_shadows(scene, view, workers, prepared, err));
    return rasterbins_new(scene, view, workers, &prepared->bins, err);
}

void rasterprepared_release(RasterPrepared *prepared)
{
    for (size_t i = 0; i < prepared->n_lights; i++)
        rastershadow_free(prepared->shadows[i]);
    free(prepared->shadows);
    caster_free(prepared->caster);
    rasterbins_free(prepared->bins);
    *prepared = (RasterPrepared){0};
}

static Status make_background(const RasterPicture *picture, int samples, float **row, Err *err)
{
    const Scene *scene = picture->scene;
    const float background[3] = {scene->background.r, scene->background.g, scene->background.b};
    TRY(mem_calloc(row, 3 * (size_t)scene->camera.width, sizeof **row, "background", err));
    for (int c = 0; c < 3; c++) {
        float sum = background[c];
        for (int i = 1; i < samples; i++)
            sum += background[c];
        for (int i = 0; i < scene->camera.width; i++)
            (*row)[3 * i + c] = (float)((double)sum / samples);
    }
    return STATUS_OK;
}

static Status make_codes(RasterPicture *picture, Err *err)
{
    size_t n = 3 * (size_t)picture->scene->camera.width;
    if (!picture->frame->codes.codes8)
        return STATUS_OK;
    srgb_codes_init(&picture->codes);
    TRY(mem_calloc(&picture->background_codes, n, 1, "background", err));
    for (size_t i = 0; i < n; i++)
        picture->background_codes[i] = srgb_code(&picture->codes, picture->background[i]);
    return STATUS_OK;
}

static Status prepare_samples(RasterPicture *picture, const RasterView *view, Err *err)
{
    int n = picture->params->antialias > 1 ? picture->params->antialias : 0;
    double *offsets = NULL;
    picture->center = rastergrid_make(view, 0, 0);
    TRY(mem_calloc(&picture->further, (size_t)n * (size_t)n, sizeof *picture->further, "samples",
                   err));
    TRY(mem_calloc(&offsets, (size_t)n, sizeof *offsets, "samples", err));
    picture->n_further = n * n;
    if (n > 0)
        resample_offsets(n, offsets);
    for (int i = 0; i < n * n; i++)
        picture->further[i] = rastergrid_make(view, offsets[i % n], offsets[i / n]);
    free(offsets);
    return STATUS_OK;
}

static Status prepare_canvas(const RasterPicture *picture, Canvas *canvas, Err *err)
{
    const Scene *scene = picture->scene;
    size_t batch = (size_t)picture->batch;
    tilesurface_init(scene, &canvas->surface);
    TRY(mem_calloc(&canvas->sheets, batch, sizeof *canvas->sheets, "tiles", err));
    TRY(mem_calloc(&canvas->queues, scene->n_lights, sizeof *canvas->queues, "lights", err));
    TRY(mem_calloc(&canvas->shadowed, batch * scene->n_lights, sizeof *canvas->shadowed, "lights",
                   err));
    for (size_t i = 0; i < batch; i++)
        canvas->sheets[i].shadowed = canvas->shadowed + i * scene->n_lights;
    for (size_t i = 0; picture->shadows && i < scene->n_lights; i++)
        if (picture->shadows[i])
            TRY(rasterqueue_new(picture->shadows[i], &canvas->queues[i], err));
    return STATUS_OK;
}

static Status prepare_canvases(RasterPicture *picture, Err *err)
{
    picture->batch = picture->shadows ? RASTER_BATCH : 1;
    TRY(mem_calloc(&picture->canvases, (size_t)picture->workers, sizeof *picture->canvases,
                   "canvases", err));
    for (int i = 0; i < picture->workers; i++)
        TRY(prepare_canvas(picture, &picture->canvases[i], err));
    return STATUS_OK;
}

static Status draw_rows(RasterPicture *picture, Err *err)
{
    threads_for(((size_t)picture->band->rows + TILE_SIDE - 1) / TILE_SIDE, picture->workers,
                draw_row, picture);
    for (int i = 0; i < picture->workers; i++)
        if (picture->canvases[i].status != STATUS_OK) {
            if (err)
                *err = picture->canvases[i].err;
            return picture->canvases[i].status;
        }
    return STATUS_OK;
}

static Status second_round(RasterPicture *picture, Err *err)
{
    const Plane *color = &picture->frame->color;
    TRY(mem_calloc(&picture->mask, (size_t)color->width * (size_t)color->height, 1, "masks", err));
    resample_mask(color, picture->band->above, picture->band->below,
                  (float)picture->params->antialias_threshold, picture->workers, picture->mask);
    picture->second_round = true;
    return draw_rows(picture, err);
}

static void release(RasterPicture *picture)
{
    for (int i = 0; picture->canvases && i < picture->workers; i++) {
        Canvas *canvas = &picture->canvases[i];
        rasterrow_release(&canvas->row);
        free(canvas->sheets);
        free(canvas->shadowed);
        for (size_t light = 0; canvas->queues && light < picture->scene->n_lights; light++)
            rasterqueue_free(canvas->queues[light]);
        free(canvas->queues);
    }
    free(picture->canvases);
    free(picture->further);
    free(picture->lights);
    free(picture->background);
    free(picture->background_codes);
    free(picture->resampled_background);
    free(picture->mask);
}

Status rasterrender(const Scene *scene, const RenderParams *params, const Band *band,
                    RasterPrepared *prepared, Frame *frame, RenderStats *stats, Err *err)
{
    Status status;
    RasterPicture picture = {.scene = scene, .params = params, .band = band, .frame = frame};
    RasterView view = rasterview_of_camera(scene, 0, scene->camera.height, params->antialias);
    double start_s = clock_seconds();
    picture.workers = params->threads > 0 ? params->threads : threads_available();
    picture.kernels = rasterkernels[kernels_kind(params->kernels)];
    picture.shading = tilekernels[kernels_kind(params->kernels)];
    picture.needs_places = tilelook_needs_places(scene);
    TRY_GOTO(tilelook_make(scene, view.location, view.axes, &picture.lights, &picture.look, err));
    TRY_GOTO(prepare_samples(&picture, &view, err));
    TRY_GOTO(make_background(&picture, 1, &picture.background, err));
    TRY_GOTO(make_codes(&picture, err));
    TRY_GOTO(make_background(&picture, picture.n_further + 1, &picture.resampled_background, err));
    if (!prepared->bins)
        TRY_GOTO(prepare(scene, &view, params->shadows && wants_color(frame), picture.workers,
                         prepared, err));
    picture.bins = prepared->bins;
    picture.shadows = prepared->shadows;
    picture.caster = prepared->caster;
    TRY_GOTO(prepare_canvases(&picture, err));
    double prepared_s = clock_seconds() - start_s;
    TRY_GOTO(draw_rows(&picture, err));
    if (picture.n_further > 0 && params->antialias_threshold > 0 && frame->color.values)
        TRY_GOTO(second_round(&picture, err));
    stats->prepare_s += prepared_s;
    stats->trace_s += clock_seconds() - start_s - prepared_s;
done:
    release(&picture);
    if (status != STATUS_OK)
        rasterprepared_release(prepared);
    return status;
}
