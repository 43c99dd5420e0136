/* Two passes over bands of one row of pixel tiles: the centre of every pixel, with geometry; then,
 * when the picture is antialiased, the N x N further samples of the pixels that want them, whose
 * colours wait in a band's buffer until each pixel adds up its own in POV-Ray's order. A band needs
 * memory in proportion to its width only. */
#include "render/field/fieldrender.h"

#include "render/light/resample.h"
#include "render/light/sight.h"
#include "render/tile/tilelook.h"
#include <stdlib.h>
#include <string.h>

/* What a worker writes to. */
typedef struct Canvas {
    TileSurface surface;
    uint8_t (*shadowed)[TILE_SAMPLES]; /* one a light */
    float background[3 * TILE_SIDE];   /* a row of it */
    uint8_t background_codes[3 * TILE_SIDE];
    float *band;     /* colours of a band's samples */
    uint8_t *wanted; /* tiles of a band's rows, one row of tiles */
    Status status;
    Err err;
} Canvas;

typedef struct FieldPicture {
    const Scene *scene;
    const RenderParams *params;
    const Band *rows; /* of the picture that the frame has */
    Frame *frame;
    const TileKernels *kernels;
    FieldTiles *tiles; /* of this pass over the whole picture, borrowed */
    SampleGrid grid;   /* likewise */
    int top;           /* the grid's row that is the frame's first */
    TileLook look;
    TileLight *lights;
    bool needs_places; /* rays or lights differ from sample to sample */
    Caster *caster;    /* for shadows; NULL without */
    bool by_sample;    /* colours are sight_color()'s, not the kernel's */
    Canvas *canvases;
    int workers;
    uint8_t *mask;   /* pixels to antialias; NULL: all */
    SrgbCodes codes; /* set if the frame is to have codes */
} FieldPicture;

static void store_vec3(float values[3][TILE_SAMPLES], int sample, Vec3 v)
{
    values[0][sample] = (float)v.x;
    values[1][sample] = (float)v.y;
    values[2][sample] = (float)v.z;
}

static Vec3 load_vec3(const float values[3][TILE_SAMPLES], int sample)
{
    return vec3((double)values[0][sample], (double)values[1][sample], (double)values[2][sample]);
}

static bool is_seen(const SeenTile *seen, const SampleGrid *grid, int sample)
{
    return seen->hits && seen->hits->state[sample] == TILE_HIT &&
           seen->column + tile_sample_x(sample) < grid->n_columns &&
           seen->row + tile_sample_y(sample) < grid->n_rows;
}

/* The ray of a sample. */
static Ray sample_ray(const FieldPicture *picture, const SeenTile *seen, int sample)
{
    return camera_ray(&picture->scene->camera,
                      picture->grid.columns[seen->column + tile_sample_x(sample)],
                      picture->grid.rows[seen->row + tile_sample_y(sample)]);
}

static bool is_shadowed(const FieldPicture *picture, int worker, const Light *light, Vec3 point,
                        Vec3 normal)
{
    Vec3 to_light = vec3_sub(light->location, point), towards;
    double distance = vec3_length(to_light);
    if (light->parallel) {
        towards = vec3_normalized(vec3_sub(light->location, light->target));
        distance = vec3_dot(to_light, towards);
    } else {
        towards = vec3_scale(to_light, 1 / distance);
    }
    return vec3_dot(normal, towards) >= 1e-10 &&
           caster_shadow(picture->caster, worker, point, towards, distance);
}

static void find_shadows(const FieldPicture *picture, const SeenTile *seen, int worker,
                         Canvas *canvas)
{
    const Scene *scene = picture->scene;
    memset(canvas->shadowed, 0, scene->n_lights * sizeof *canvas->shadowed);
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        if (!is_seen(seen, &picture->grid, sample))
            continue;
        Ray ray = sample_ray(picture, seen, sample);
        Vec3 point = ray_at(ray, tile_depth(seen->tile, seen->hits, sample));
        Vec3 normal = fieldtiles_to_world(picture->tiles, load_vec3(seen->hits->normal, sample));
        for (size_t i = 0; i < scene->n_lights; i++)
            if (scene->lights[i].casts_shadows)
                canvas->shadowed[i][sample] =
                    is_shadowed(picture, worker, &scene->lights[i], point, normal);
    }
    canvas->surface.shadowed = (const uint8_t(*)[TILE_SAMPLES])canvas->shadowed;
}

/* Rays and places of a tile in perspective; orthographic rays never change, and lights that are not
 * parallel need places there, too. */
static void place_surface(const SeenTile *seen, TileSurface *surface)
{
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        double x = seen->tile->middle_x + (double)seen->tile->x[sample];
        double y = seen->tile->middle_y + (double)seen->tile->y[sample];
        double z = seen->hits->z[sample];
        if (!seen->tile->perspective) {
            store_vec3(surface->point, sample, vec3(x, y, z));
            continue;
        }
        store_vec3(surface->point, sample, vec3(x * z, y * z, z));
        store_vec3(surface->direction, sample, vec3_normalized(vec3(x, y, 1)));
    }
}

/* Every sample on its own, with all that the kernel does not know. */
static void color_samples(const FieldPicture *picture, const SeenTile *seen, int worker,
                          float color[3][TILE_SAMPLES])
{
    const Scene *scene = picture->scene;
    const SampleGrid *grid = &picture->grid;
    const Sight sight = {scene, picture->params, picture->caster};
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        int column = seen->column + tile_sample_x(sample), row = seen->row + tile_sample_y(sample);
        if (column >= grid->n_columns || row >= grid->n_rows)
            continue;
        Surfel surfel, *hit = NULL;
        if (seen->hits && seen->hits->state[sample] == TILE_HIT) {
            const FieldSegment *segment = &scene->segments[seen->hits->segment[sample]];
            Vec3 normal =
                fieldtiles_to_world(picture->tiles, load_vec3(seen->hits->normal, sample));
            surfel = (Surfel){tile_depth(seen->tile, seen->hits, sample), vec3_normalized(normal),
                              segment->color, segment->id};
            hit = &surfel;
        }
        Rgb rgb = sight_color(&sight, worker, sample_ray(picture, seen, sample),
                              grid->columns[column], grid->rows[row], hit);
        color[0][sample] = rgb.r;
        color[1][sample] = rgb.g;
        color[2][sample] = rgb.b;
    }
}

/* Sets the colours of the tile's hits. */
static void color_tile(const FieldPicture *picture, const SeenTile *seen, int worker,
                       float color[3][TILE_SAMPLES])
{
    const Scene *scene = picture->scene;
    Canvas *canvas = &picture->canvases[worker];
    TileSurface *surface = &canvas->surface;
    surface->hits = seen->hits;
    if (!scene->uniform_color)
        for (int sample = 0; sample < TILE_SAMPLES; sample++) {
            Rgb pigment = scene->segments[seen->hits->segment[sample]].color;
            surface->pigment[0][sample] = pigment.r;
            surface->pigment[1][sample] = pigment.g;
            surface->pigment[2][sample] = pigment.b;
        }
    if (picture->needs_places)
        place_surface(seen, surface);
    if (picture->caster)
        find_shadows(picture, seen, worker, canvas);
    memset(color, 0, 3 * sizeof *color);
    picture->kernels->shade(&picture->look, surface, color);
}

/* Copies a tile's colours to rows of `width` pixels, as far as they reach: where `state` is
 * TILE_MISS the background's, which is nowhere when it is NULL. */
static void copy_tile(float color[3][TILE_SAMPLES], const uint8_t *state, Rgb background,
                      int columns, int rows, size_t width, float *to)
{
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < columns; i++) {
            int sample = tile_sample_at(i, j);
            bool seen = !state || state[sample] == TILE_HIT;
            float *pixel = to + 3 * ((size_t)j * width + (size_t)i);
            pixel[0] = seen ? color[0][sample] : background.r;
            pixel[1] = seen ? color[1][sample] : background.g;
            pixel[2] = seen ? color[2][sample] : background.b;
        }
}

/* How many columns and rows of a tile are inside the grid. */
static void tile_extent(const FieldPicture *picture, const SeenTile *seen, int *columns, int *rows)
{
    const SampleGrid *grid = &picture->grid;
    int right = grid->n_columns - seen->column, below = grid->n_rows - seen->row;
    *columns = right < TILE_SIDE ? right : TILE_SIDE;
    *rows = below < TILE_SIDE ? below : TILE_SIDE;
}

static void color_all(const FieldPicture *picture, const SeenTile *seen, int worker,
                      float color[3][TILE_SAMPLES])
{
    if (picture->by_sample)
        color_samples(picture, seen, worker, color);
    else
        color_tile(picture, seen, worker, color);
}

/* Writes the codes of a tile to the picture, where those of the background are. */
static void write_codes(const FieldPicture *picture, const SeenTile *seen, int worker)
{
    const Canvas *canvas = &picture->canvases[worker];
    size_t width = (size_t)picture->grid.n_columns;
    uint8_t *to = picture->frame->codes.codes8 +
                  3 * ((size_t)(seen->row - picture->top) * width + (size_t)seen->column);
    int columns, rows;
    tile_extent(picture, seen, &columns, &rows);
    float color[3][TILE_SAMPLES];
    const uint8_t *state = picture->by_sample ? NULL : seen->hits->state;
    color_all(picture, seen, worker, color);
    tilelook_encode(picture->kernels, &picture->codes, color, state, canvas->background_codes,
                    columns, rows, to, 3 * width);
}

/* Writes the part of a tile that is inside the grid to rows of samples, the first of which is row
 * `first_row` of the grid. */
static void write_colors(const FieldPicture *picture, const SeenTile *seen, int worker,
                         int first_row, float *values)
{
    int columns, rows;
    tile_extent(picture, seen, &columns, &rows);
    size_t width = (size_t)picture->grid.n_columns;
    float *to = values + 3 * ((size_t)(seen->row - first_row) * width + (size_t)seen->column);
    if (!seen->hits && !picture->by_sample) {
        const float *background = picture->canvases[worker].background;
        for (int j = 0; j < rows; j++)
            memcpy(to + 3 * width * (size_t)j, background, 3 * (size_t)columns * sizeof *to);
        return;
    }
    float color[3][TILE_SAMPLES];
    const uint8_t *state = picture->by_sample ? NULL : seen->hits->state;
    color_all(picture, seen, worker, color);
    copy_tile(color, state, picture->scene->background, columns, rows, width, to);
}

static void write_geometry(const FieldPicture *picture, const SeenTile *seen)
{
    Frame *frame = picture->frame;
    const Scene *scene = picture->scene;
    const Camera *camera = &scene->camera;
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        int i = seen->column + tile_sample_x(sample);
        int j = seen->row + tile_sample_y(sample) - picture->top;
        if (i >= camera->width || j >= picture->rows->rows)
            continue;
        bool hit = seen->hits && seen->hits->state[sample] == TILE_HIT;
        size_t pixel = (size_t)j * (size_t)camera->width + (size_t)i;
        if (frame->depth.values)
            frame->depth.values[pixel] =
                hit ? (float)tile_depth(seen->tile, seen->hits, sample) : INFINITY;
        if (frame->normal.values) {
            Vec3 local = hit ? load_vec3(seen->hits->normal, sample) : vec3(0, 0, 0);
            Vec3 normal = fieldtiles_to_world(picture->tiles, local);
            frame->normal.values[3 * pixel] = (float)normal.x;
            frame->normal.values[3 * pixel + 1] = (float)normal.y;
            frame->normal.values[3 * pixel + 2] = (float)normal.z;
        }
        if (frame->id.ids)
            frame->id.ids[pixel] = hit ? scene->segments[seen->hits->segment[sample]].id : 0;
    }
}

static void visit_center(const SeenTile *seen, int worker, void *context)
{
    const FieldPicture *picture = context;
    const Frame *frame = picture->frame;
    if (frame->depth.values || frame->normal.values || frame->id.ids)
        write_geometry(picture, seen);
    if (frame->color.values)
        write_colors(picture, seen, worker, picture->top, frame->color.values);
    if (frame->codes.codes8 && (seen->hits || picture->by_sample))
        write_codes(picture, seen, worker);
}

/* Fills a band with the codes of the background. */
static void clear_codes(const FieldPicture *picture, size_t band, int worker)
{
    size_t row = 3 * (size_t)picture->grid.n_columns, first = band * TILE_SIDE;
    size_t rows = (size_t)picture->rows->rows - first;
    size_t size = row * (rows < TILE_SIDE ? rows : TILE_SIDE);
    size_t done = size < 3 * TILE_SIDE ? size : 3 * TILE_SIDE;
    uint8_t *to = picture->frame->codes.codes8 + row * first;
    memcpy(to, picture->canvases[worker].background_codes, done);
    for (; done < size; done *= 2)
        memcpy(to + done, to, done < size - done ? done : size - done);
}

static void report_progress(const FieldPicture *picture, size_t band, int worker)
{
    if (worker == 0)
        band_progress(picture->rows, picture->params, picture->scene->camera.height,
                      picture->grid.spacing < 1, (double)band * TILE_SIDE / picture->rows->rows);
}

static void trace_centers(size_t band, int worker, void *context)
{
    FieldPicture *picture = context;
    Canvas *canvas = &picture->canvases[worker];
    size_t tile_row = (size_t)picture->top / TILE_SIDE + band;
    report_progress(picture, band, worker);
    if (picture->frame->codes.codes8)
        clear_codes(picture, band, worker);
    if (canvas->status == STATUS_OK)
        canvas->status = fieldtiles_trace(picture->tiles, tile_row, worker, NULL, visit_center,
                                          picture, &canvas->err);
}

/* Which band a tile's samples are stored for. */
typedef struct BandVisit {
    const FieldPicture *picture;
    int first_row; /* of the grid */
} BandVisit;

static void visit_further(const SeenTile *seen, int worker, void *context)
{
    const BandVisit *visit = context;
    write_colors(visit->picture, seen, worker, visit->first_row,
                 visit->picture->canvases[worker].band);
}

static bool wants_more(const FieldPicture *picture, int i, int j)
{
    return !picture->mask ||
           picture->mask[(size_t)j * (size_t)picture->scene->camera.width + (size_t)i];
}

/* Marks the tiles of one row of tiles that hold samples of pixels that want more. */
static bool mark_wanted(const FieldPicture *picture, size_t tile_row, uint8_t *wanted)
{
    const Camera *camera = &picture->scene->camera;
    int n = picture->params->antialias, row = (int)tile_row * TILE_SIDE - picture->top;
    int first = row / n, last = (row + TILE_SIDE - 1) / n;
    bool any = false;
    memset(wanted, 0, fieldtiles_columns(picture->tiles));
    for (int j = first; j <= last && j < picture->rows->rows; j++)
        for (int i = 0; i < camera->width; i++)
            if (wants_more(picture, i, j)) {
                any = true;
                for (int tile = i * n / TILE_SIDE; tile <= (i * n + n - 1) / TILE_SIDE; tile++)
                    wanted[tile] = 1;
            }
    return any;
}

/* The mean of a pixel's centre and further samples, summed row by row in float. */
static void add_up(const FieldPicture *picture, const float *band, int band_row, int i, int j)
{
    int n = picture->params->antialias;
    size_t width = (size_t)picture->grid.n_columns;
    const Camera *camera = &picture->scene->camera;
    float *value =
        &picture->frame->color.values[3 * ((size_t)j * (size_t)camera->width + (size_t)i)];
    for (int c = 0; c < 3; c++) {
        float sum = value[c];
        for (int y = 0; y < n; y++)
            for (int x = 0; x < n; x++)
                sum += band[3 * ((size_t)(band_row * n + y) * width + (size_t)(i * n + x)) + c];
        value[c] = (float)((double)sum / (n * n + 1));
    }
}

static void trace_further(size_t band, int worker, void *context)
{
    FieldPicture *picture = context;
    Canvas *canvas = &picture->canvases[worker];
    const Camera *camera = &picture->scene->camera;
    size_t n = (size_t)picture->params->antialias, rows = fieldtiles_rows(picture->tiles);
    report_progress(picture, band, worker);
    size_t tile_row = (size_t)picture->top / TILE_SIDE + band * n;
    BandVisit visit = {picture, (int)tile_row * TILE_SIDE};
    for (size_t row = tile_row; row < tile_row + n && row < rows; row++)
        if (canvas->status == STATUS_OK && mark_wanted(picture, row, canvas->wanted))
            canvas->status = fieldtiles_trace(picture->tiles, row, worker, canvas->wanted,
                                              visit_further, &visit, &canvas->err);
    if (canvas->status != STATUS_OK)
        return;
    int first = (int)band * TILE_SIDE;
    for (int j = first; j < first + TILE_SIDE && j < picture->rows->rows; j++)
        for (int i = 0; i < camera->width; i++)
            if (wants_more(picture, i, j))
                add_up(picture, canvas->band, j - first, i, j);
}

/* Makes a pass of `n` x `n` samples a pixel at the offsets given. */
static Status prepare_pass(const FieldPicture *picture, int n, const double *offsets,
                           FieldPass *pass, Err *err)
{
    const Camera *camera = &picture->scene->camera;
    int width = camera->width * n, height = camera->height * n;
    TRY(mem_calloc(&pass->columns, (size_t)width, sizeof *pass->columns, "columns", err));
    TRY(mem_calloc(&pass->rows, (size_t)height, sizeof *pass->rows, "rows", err));
    for (int i = 0; i < width; i++)
        pass->columns[i] = i / n + offsets[i % n];
    for (int j = 0; j < height; j++)
        pass->rows[j] = j / n + offsets[j % n];
    pass->grid = (SampleGrid){pass->columns, pass->rows, width, height, 1.0 / n};
    TRY(fieldtiles_new(picture->scene, &pass->grid, NEAREST_SEEN_MM, picture->workers, &pass->tiles,
                       err));
    fieldtiles_use_kernel(pass->tiles, fieldkernels[kernels_kind(picture->params->kernels)]);
    return STATUS_OK;
}

static void release_pass(FieldPass *pass)
{
    fieldtiles_free(pass->tiles);
    free(pass->columns);
    free(pass->rows);
    *pass = (FieldPass){0};
}

void fieldprepared_release(FieldPrepared *prepared)
{
    release_pass(&prepared->center);
    release_pass(&prepared->further);
}

/* One pass over the frame's rows. */
static Status run_pass(FieldPicture *picture, int n, const double *offsets, FieldPass *pass,
                       void (*body)(size_t band, int worker, void *context), double *prepared_s,
                       Err *err)
{
    double start_s = clock_seconds();
    Status status = pass->tiles ? STATUS_OK : prepare_pass(picture, n, offsets, pass, err);
    if (status != STATUS_OK) {
        release_pass(pass);
        return status;
    }
    picture->tiles = pass->tiles;
    picture->grid = pass->grid;
    picture->top = picture->rows->first * n;
    for (int i = 0; n > 1 && i < picture->workers; i++) {
        Canvas *canvas = &picture->canvases[i];
        TRY(mem_calloc(&canvas->band, (size_t)pass->grid.n_columns * TILE_SIDE * (size_t)n,
                       3 * sizeof *canvas->band, "bands", err));
        TRY(mem_calloc(&canvas->wanted, fieldtiles_columns(picture->tiles), 1, "bands", err));
    }
    *prepared_s += clock_seconds() - start_s;
    threads_for(((size_t)picture->rows->rows + TILE_SIDE - 1) / TILE_SIDE, picture->workers, body,
                picture);
    for (int i = 0; i < picture->workers; i++)
        if (picture->canvases[i].status != STATUS_OK) {
            if (err)
                *err = picture->canvases[i].err;
            return picture->canvases[i].status;
        }
    return STATUS_OK;
}

static Status prepare_canvases(FieldPicture *picture, Err *err)
{
    const Scene *scene = picture->scene;
    TRY(mem_calloc(&picture->canvases, (size_t)picture->workers, sizeof *picture->canvases,
                   "canvases", err));
    for (int i = 0; i < picture->workers; i++) {
        Canvas *canvas = &picture->canvases[i];
        TRY(mem_calloc(&canvas->shadowed, scene->n_lights, sizeof *canvas->shadowed, "lights",
                       err));
        for (int pixel = 0; pixel < TILE_SIDE; pixel++) {
            canvas->background[3 * pixel] = scene->background.r;
            canvas->background[3 * pixel + 1] = scene->background.g;
            canvas->background[3 * pixel + 2] = scene->background.b;
        }
        for (int value = 0; picture->frame->codes.codes8 && value < 3 * TILE_SIDE; value++)
            canvas->background_codes[value] = srgb_code(&picture->codes, canvas->background[value]);
        tilesurface_init(scene, &canvas->surface);
    }
    return STATUS_OK;
}

/* The second pass, over all pixels or those that differ from their neighbours. */
static Status antialias(FieldPicture *picture, FieldPass *pass, double *prepared_s, Err *err)
{
    Status status;
    const RenderParams *params = picture->params;
    const Plane *color = &picture->frame->color;
    double *offsets = NULL;
    TRY_GOTO(mem_calloc(&offsets, (size_t)params->antialias, sizeof *offsets, "samples", err));
    resample_offsets(params->antialias, offsets);
    if (params->antialias_threshold > 0) {
        TRY_GOTO(mem_calloc(&picture->mask, (size_t)color->width * (size_t)color->height, 1,
                            "masks", err));
        resample_mask(color, picture->rows->above, picture->rows->below,
                      (float)params->antialias_threshold, picture->workers, picture->mask);
    }
    TRY_GOTO(run_pass(picture, params->antialias, offsets, pass, trace_further, prepared_s, err));
done:
    free(offsets);
    return status;
}

static void release(FieldPicture *picture)
{
    for (int i = 0; picture->canvases && i < picture->workers; i++) {
        free(picture->canvases[i].shadowed);
        free(picture->canvases[i].band);
        free(picture->canvases[i].wanted);
    }
    free(picture->canvases);
    free(picture->lights);
    free(picture->mask);
}

Status fieldrender(const Scene *scene, const RenderParams *params, Caster *caster, const Band *rows,
                   FieldPrepared *prepared, Frame *frame, RenderStats *stats, Err *err)
{
    Status status;
    FieldPicture picture = {
        .scene = scene, .params = params, .rows = rows, .frame = frame, .caster = caster};
    picture.by_sample = sight_is_needed(scene, params);
    const double center = 0;
    const Camera *camera = &scene->camera;
    const Vec3 axes[3] = {vec3_normalized(camera->right), vec3_normalized(camera->up),
                          camera->direction};
    double start_s = clock_seconds();
    picture.workers = params->threads > 0 ? params->threads : threads_available();
    if (frame->codes.codes8)
        srgb_codes_init(&picture.codes);
    picture.kernels = tilekernels[kernels_kind(params->kernels)];
    picture.needs_places = tilelook_needs_places(scene);
    TRY_GOTO(tilelook_make(scene, camera->location, axes, &picture.lights, &picture.look, err));
    TRY_GOTO(prepare_canvases(&picture, err));
    double prepared_s = clock_seconds() - start_s;
    TRY_GOTO(run_pass(&picture, 1, &center, &prepared->center, trace_centers, &prepared_s, err));
    if (params->antialias > 1 && frame->color.values)
        TRY_GOTO(antialias(&picture, &prepared->further, &prepared_s, err));
    stats->prepare_s += prepared_s;
    stats->trace_s += clock_seconds() - start_s - prepared_s;
done:
    release(&picture);
    return status;
}
