/* Shades the samples of traced tiles, and stores their pixels in the planes of the image.
 *
 * A worker draws tiles row by row, from left to right in each row. Only tiles that may have hits
 * are drawn. The pixels between the drawn tiles are filled with the background row by row, so that
 * each pixel is written once. To fill the whole image first would take as long as drawing a sparse
 * image. */
#include "render/tile/canvas.h"

#include "render/cast/caster.h"
#include "render/light/visibility.h"
#include <stdlib.h>
#include <string.h>

/* ---- setting up ------------------------------------------------------------------------------ */

TileShading tileshading_make(const View *view, const Finish *finish, const Viewpoint *eye)
{
    const Rgb paper = view->background;
    TileShading look = {
        .finish = *finish, .n_lights = view->n_lights, .paper = {paper.r, paper.g, paper.b}};
    for (size_t i = 0; i < view->n_lights; i++) {
        const Light *light = &view->lights[i];
        Vec3 v = light->parallel
                     ? viewpoint_frame_direction(
                           eye, vec3_normalized(vec3_sub(light->location, light->target)))
                     : viewpoint_frame_point(eye, light->location);
        look.lights[i] = (TileLight){.towards = {(float)v.x, (float)v.y, (float)v.z},
                                     .color = {light->color.r, light->color.g, light->color.b},
                                     .parallel = light->parallel};
    }
    return look;
}

/* Returns true if shading needs the positions of points, and not only their normals. */
static bool needs_points(const View *view)
{
    bool needs = view->camera.projection == PROJECTION_PERSPECTIVE || fade_is_on(&view->fade);
    for (size_t i = 0; i < view->n_lights; i++)
        needs |= !view->lights[i].parallel;
    return needs;
}

/* Initialises a surface of one color whose camera rays are all parallel to the view direction. */
static void begin_surface(Rgb color, TileSurface *surface)
{
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        surface->direction[2][sample] = 1;
        surface->pigment[0][sample] = color.r;
        surface->pigment[1][sample] = color.g;
        surface->pigment[2][sample] = color.b;
    }
}

/* Lets both surfaces of a worker read the worker's arrays of shared visibility. Does nothing if
 * `visibility` is NULL. */
static void connect_visibility(const PixelVisibility *visibility, CanvasWorker *own)
{
    TileSurface *surfaces[] = {&own->surface, &own->ground};
    for (int i = 0; visibility && i < 2; i++) {
        surfaces[i]->ambient = own->ambient;
        for (int light = 0; light < VIEW_MAX_LIGHTS; light++)
            surfaces[i]->light_visibility[light] =
                visibility->lights[light] ? own->light_visibility[light] : NULL;
    }
}

/* Fills a row with the mean of `samples` samples of the background, summed in float. */
static void fill_row(const Canvas *canvas, int samples, float *row)
{
    const Rgb color = canvas->drawing->view->background;
    const float background[3] = {color.r, color.g, color.b};
    for (int c = 0; c < 3; c++) {
        float sum = background[c];
        for (int i = 1; i < samples; i++)
            sum += background[c];
        for (int i = 0; i < canvas->drawing->view->camera.width; i++)
            row[3 * i + c] = (float)((double)sum / samples);
    }
}

static Status make_background(Canvas *canvas, Err *err)
{
    size_t n = 3 * (size_t)canvas->drawing->view->camera.width;
    TRY(mem_calloc(&canvas->background, n, sizeof *canvas->background, "background", err));
    TRY(mem_calloc(&canvas->blank, n, sizeof *canvas->blank, "background", err));
    fill_row(canvas, 1, canvas->background);
    fill_row(canvas, 1, canvas->blank);
    if (!canvas->frame->codes.codes8)
        return STATUS_OK;
    srgb_codes_init(&canvas->codes);
    TRY(mem_calloc(&canvas->background_codes, n, 1, "background", err));
    for (size_t i = 0; i < n; i++)
        canvas->background_codes[i] = srgb_code(&canvas->codes, canvas->background[i]);
    return STATUS_OK;
}

Status canvas_init(const Drawing *drawing, Frame *frame, const Viewpoint *eye, Canvas *canvas,
                   Err *err)
{
    const RenderParams *params = drawing->params;
    const Appearance *appearance = drawing->appearance;
    *canvas =
        (Canvas){.drawing = drawing,
                 .frame = frame,
                 .workers = params->threads,
                 .eye = *eye,
                 .kernels = tilekernels[kernels_kind(params->kernels)],
                 .more = resampling_for(frame->color.values ? params->antialias : 1),
                 .look = tileshading_make(drawing->view, &appearance->finish, eye),
                 .ground_look = tileshading_make(drawing->view, &drawing->view->ground.finish, eye),
                 .needs_points = needs_points(drawing->view) || drawing->mean ||
                                 drawing->visibility || drawing->view->ground.present,
                 .wants_color = frame->color.values || frame->codes.codes8,
                 .wants_geometry = frame->depth.values || frame->normal.values || frame->id.ids};
    TRY(make_background(canvas, err));
    TRY(mem_calloc(&canvas->each, (size_t)canvas->workers, sizeof *canvas->each, "canvases", err));
    for (int i = 0; i < canvas->workers; i++) {
        begin_surface(appearance->color, &canvas->each[i].surface);
        begin_surface(drawing->view->ground.color, &canvas->each[i].ground);
        connect_visibility(drawing->visibility, &canvas->each[i]);
    }
    return STATUS_OK;
}

void canvas_release(Canvas *canvas)
{
    resampling_release(&canvas->more);
    free(canvas->background);
    free(canvas->blank);
    free(canvas->background_codes);
    free(canvas->each);
    *canvas = (Canvas){0};
}

void canvas_average_undrawn(Canvas *canvas)
{
    fill_row(canvas, canvas->more.side * canvas->more.side + 1, canvas->blank);
}

/* ---- colors --------------------------------------------------------------------------------- */

/* Returns the segment index of the vessel that a sample hits. */
static uint32_t segment_of(const Canvas *canvas, const TileHits *hits, int sample)
{
    return geometry_segment(canvas->drawing->geometry, hits->segment[sample]);
}

/* Sets the pigments of a surface whose vessels have different colors. */
static void set_pigments(const Canvas *canvas, const TracedTile *traced, TileSurface *surface)
{
    const TileHits *hits = traced->hits;
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        if (hits->state[sample] != TILE_HIT || traced->ground >> sample & 1)
            continue;
        Vec3 point = {0, 0, 0};
        if (canvas->drawing->mean)
            point = viewpoint_world_point(&canvas->eye, tile_hit_point(traced, sample));
        Rgb pigment = drawing_color(canvas->drawing, segment_of(canvas, hits, sample), point);
        surface->pigment[0][sample] = pigment.r;
        surface->pigment[1][sample] = pigment.g;
        surface->pigment[2][sample] = pigment.b;
    }
}

/* Sets the shading points of a surface and, in perspective, the directions of their camera rays. In
 * parallel views, begin_surface has set the directions. */
static void set_shading_points(const TracedTile *traced, TileSurface *surface)
{
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        if (traced->hits->state[sample] != TILE_HIT)
            continue;
        Vec3 through = tile_line(traced, sample);
        tile_set_vector(surface->point, sample, tile_hit_point(traced, sample));
        if (traced->perspective)
            tile_set_vector(surface->direction, sample, vec3_normalized(through));
    }
}

/* Returns the index of the pixel whose shared visibility a sample uses, or NO_HIT. per[0] and
 * per[1] are the numbers of pixels, across and down, per unit of the view's plane. */
static uint32_t shared_pixel(const Canvas *canvas, const TracedTile *traced, int sample,
                             const double per[2])
{
    const PixelVisibility *visibility = canvas->drawing->visibility;
    const Camera *camera = &canvas->drawing->view->camera;
    Vec3 line = tile_line(traced, sample), normal = tile_vector(traced->hits->normal, sample);
    double away = traced->perspective ? vec3_dot(normal, line) : normal.z;
    ShadingPoint point = shadingpoint_of(
        visibility, traced->ground >> sample & 1 ? SURFACE_GROUND : SURFACE_VESSEL,
        viewpoint_world_point(&canvas->eye, tile_hit_point(traced, sample)),
        viewpoint_world_direction(&canvas->eye, away > 0 ? vec3_scale(normal, -1) : normal),
        pixelvisibility_pixel_mm(camera, traced->hits->z[sample]));
    return pixelvisibility_find_pixel(visibility, line.x * per[0] + (camera->width - 1) / 2.0,
                                      (camera->height - 1) / 2.0 - line.y * per[1], &point);
}

/* Prefetches the shared visibility of the tile two columns to the right. Each of its rows is a
 * short piece of memory far from the other rows, which the processor does not fetch ahead by
 * itself. */
static void prefetch_visibility(const Canvas *canvas, const TracedTile *traced)
{
    const PixelVisibility *visibility = canvas->drawing->visibility;
    const int column = traced->column + 2 * TILE_SIDE;
    for (int row = traced->row; column < visibility->width && row < traced->row + traced->n_rows;
         row++) {
        size_t pixel =
            (size_t)(row - visibility->first_row) * (size_t)visibility->width + (size_t)column;
        __builtin_prefetch(&visibility->point_index[pixel]);
        if (visibility->ambient)
            __builtin_prefetch(&visibility->ambient[pixel]);
        for (size_t i = 0; i < canvas->look.n_lights; i++)
            if (visibility->lights[i])
                __builtin_prefetch(&visibility->lights[i][pixel]);
    }
}

/* Looks up the ambient and light visibility of the samples, which were computed per pixel. With one
 * sample per pixel, a sample is the centre of its pixel, and no search is needed. */
static void set_visibility(const Canvas *canvas, const TracedTile *traced, CanvasWorker *own)
{
    const PixelVisibility *visibility = canvas->drawing->visibility;
    const Camera *camera = &canvas->drawing->view->camera;
    const double per[2] = {camera->width / vec3_length(camera->right),
                           camera->height / vec3_length(camera->up)};
    bool centers = canvas->more.side == 0 && visibility->samples_per_side == 1;
    if (centers)
        prefetch_visibility(canvas, traced);
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        if (traced->hits->state[sample] != TILE_HIT)
            continue;
        uint32_t pixel = NO_HIT;
        if (centers)
            pixel = pixelvisibility_at(visibility, traced->column + tile_sample_x(sample),
                                       traced->row + tile_sample_y(sample));
        if (pixel == NO_HIT)
            pixel = shared_pixel(canvas, traced, sample, per);
        own->ambient[sample] = pixelvisibility_ambient(visibility, pixel);
        for (size_t i = 0; i < canvas->look.n_lights; i++)
            if (visibility->lights[i])
                own->light_visibility[i][sample] = pixelvisibility_light(visibility, i, pixel);
    }
}

void canvas_trace_ground(const Canvas *canvas, TracedTile *traced, TileHits *hits)
{
    const Ground *ground = &canvas->drawing->view->ground;
    Vec3 n = viewpoint_frame_direction(&canvas->eye, ground->normal);
    double offset = ground->offset_mm - vec3_dot(ground->normal, canvas->eye.location);
    if (!traced->hits)
        memset(hits->state, TILE_MISS, sizeof hits->state);
    traced->ground = 0;
    for (int sample = 0; ground->present && sample < TILE_SAMPLES; sample++) {
        Vec3 line = tile_line(traced, sample);
        double across = n.x * line.x + n.y * line.y;
        double z = traced->perspective ? offset / (across + n.z) : (offset - across) / n.z;
        bool hidden = hits->state[sample] == TILE_HIT && hits->z[sample] <= z;
        if (!(z >= NEAREST_VISIBLE_MM) || !isfinite(z) || hidden)
            continue;
        double away = traced->perspective ? across + n.z : n.z;
        tile_set_vector(hits->normal, sample, away > 0 ? vec3_scale(n, -1) : n);
        hits->z[sample] = z;
        hits->state[sample] = TILE_HIT;
        traced->ground |= (uint64_t)1 << sample;
    }
    if (traced->ground)
        traced->hits = hits;
}

static void set_fade(const Fade *fade, const TracedTile *traced, CanvasWorker *own)
{
    for (int sample = 0; sample < TILE_SAMPLES; sample++)
        if (traced->hits->state[sample] == TILE_HIT)
            own->fade[sample] = (float)fade_at(fade, tile_hit_distance(traced, sample));
    own->surface.fade = own->fade;
}

/* Shades the samples that hit the ground. */
static void shade_ground(const Canvas *canvas, const TracedTile *traced,
                         const uint8_t (*shadowed)[TILE_SAMPLES], CanvasWorker *own)
{
    float color[3][TILE_SAMPLES];
    own->ground.hits = traced->hits;
    own->ground.shadowed = shadowed;
    if (canvas->needs_points)
        set_shading_points(traced, &own->ground);
    canvas->kernels->shade(&canvas->ground_look, &own->ground, color);
    for (uint64_t left = traced->ground; left; left &= left - 1)
        for (int c = 0, sample = __builtin_ctzll(left); c < 3; c++)
            own->color[c][sample] = color[c][sample];
}

float (*canvas_shade(const Canvas *canvas, int worker, const TracedTile *traced,
                     const uint8_t (*shadowed)[TILE_SAMPLES]))[TILE_SAMPLES]
{
    CanvasWorker *own = &canvas->each[worker];
    own->surface.hits = traced->hits;
    own->surface.shadowed = shadowed;
    if (canvas->drawing->appearance->colors)
        set_pigments(canvas, traced, &own->surface);
    if (canvas->needs_points)
        set_shading_points(traced, &own->surface);
    if (canvas->drawing->visibility)
        set_visibility(canvas, traced, own);
    if (fade_is_on(&canvas->drawing->view->fade))
        set_fade(&canvas->drawing->view->fade, traced, own);
    canvas->kernels->shade(&canvas->look, &own->surface, own->color);
    if (traced->ground)
        shade_ground(canvas, traced, shadowed, own);
    if (canvas->frame->color.values)
        canvas->kernels->clear(traced->hits->state, canvas->background, own->color);
    return own->color;
}

/* Draws the thin vessels of a cell over a sample. */
static void cover_sample(const TracedTile *traced, ThinCells *cells, int column, int row,
                         int sample, float color[3][TILE_SAMPLES])
{
    const bool hit = traced->hits && traced->hits->state[sample] == TILE_HIT;
    float over[3] = {color[0][sample], color[1][sample], color[2][sample]};
    thincells_over(cells, column, row, hit ? (float)traced->hits->z[sample] : HUGE_VALF, over);
    for (int c = 0; c < 3; c++)
        color[c][sample] = over[c];
}

float (*canvas_draw_thin(const Canvas *canvas, int worker, const TracedTile *traced,
                         ThinCells *cells, int x, int y,
                         float (*color)[TILE_SAMPLES]))[TILE_SAMPLES]
{
    CanvasWorker *own = &canvas->each[worker];
    const int step = cells->block.columns / TILE_SIDE;
    if (cells->fragments.n == 0)
        return color;
    for (int c = 0; c < 3 && !color; c++)
        for (int sample = 0; sample < TILE_SAMPLES; sample++)
            own->color[c][sample] = canvas->background[c];
    for (int j = 0; j < TILE_SIDE; j++)
        for (int i = 0; i < TILE_SIDE; i++)
            if (!thincells_are_empty(cells, i * step + x, j * step + y))
                cover_sample(traced, cells, i * step + x, j * step + y, tile_sample_at(i, j),
                             own->color);
    return own->color;
}

/* ---- pixels ---------------------------------------------------------------------------------- */

void canvas_copy(const Canvas *canvas, int columns, int rows, float color[3][TILE_SAMPLES],
                 float *pixels, size_t stride)
{
    size_t n = 3 * (size_t)columns;
    float whole[TILE_SIDE][3 * TILE_SIDE];
    if (color && columns == TILE_SIDE && rows == TILE_SIDE) {
        canvas->kernels->paint(color, pixels, stride);
        return;
    }
    if (color)
        canvas->kernels->paint(color, whole[0], 3 * TILE_SIDE);
    for (int row = 0; row < rows; row++)
        memcpy(pixels + (size_t)row * stride, color ? whole[row] : canvas->background,
               n * sizeof *pixels);
}

static void store_codes(const Canvas *canvas, const TracedTile *traced,
                        float color[3][TILE_SAMPLES], uint8_t *pixels, size_t stride)
{
    const uint8_t *state = canvas->engine_colors_background ? NULL : traced->hits->state;
    uint8_t whole[TILE_SIDE][3 * TILE_SIDE];
    bool is_whole = traced->n_columns == TILE_SIDE && traced->n_rows == TILE_SIDE;
    canvas->kernels->encode(&canvas->codes, color, state, canvas->background_codes,
                            is_whole ? pixels : whole[0], is_whole ? stride : sizeof whole[0]);
    for (int row = 0; row < traced->n_rows && !is_whole; row++)
        memcpy(pixels + (size_t)row * stride, whole[row], 3 * (size_t)traced->n_columns);
}

/* Stores the geometry planes of a tile. */
static void store_geometry(const Canvas *canvas, const TracedTile *traced)
{
    const TileHits *hits = traced->hits;
    for (int j = 0; j < traced->n_rows; j++) {
        size_t first = canvas_pixel(canvas, traced->column, traced->row + j);
        planes_store_nothing(canvas->frame, first, (size_t)traced->n_columns);
        for (int i = 0; i < traced->n_columns && hits; i++) {
            int sample = tile_sample_at(i, j);
            if (hits->state[sample] != TILE_HIT || traced->ground >> sample & 1)
                continue;
            Vec3 normal =
                viewpoint_world_direction(&canvas->eye, tile_vector(hits->normal, sample));
            planes_store(canvas->frame, first + (size_t)i, tile_hit_distance(traced, sample),
                         normal, canvas->drawing->geometry->ids[segment_of(canvas, hits, sample)]);
        }
    }
}

/* Stores a rectangle of pixels without hits. It may cover several tiles. */
static void store_nothing(const Canvas *canvas, const TracedTile *empty, const float *background)
{
    const Frame *frame = canvas->frame;
    size_t n = 3 * (size_t)empty->n_columns;
    for (int j = 0; j < empty->n_rows; j++) {
        size_t first = 3 * canvas_pixel(canvas, empty->column, empty->row + j);
        if (frame->color.values)
            memcpy(frame->color.values + first, background, n * sizeof *background);
        if (frame->codes.codes8)
            memcpy(frame->codes.codes8 + first, canvas->background_codes, n);
        planes_store_nothing(frame, first / 3, (size_t)empty->n_columns);
    }
}

/* Fills the pixels, in a row of tiles, between the last drawn tile and column `end` with the
 * background. `row` is the upper row of pixels. */
static void store_blank(const Canvas *canvas, CanvasWorker *own, int end, int row)
{
    const Camera *camera = &canvas->drawing->view->camera;
    const TracedTile empty = {.column = own->column,
                              .row = row,
                              .n_columns = end - own->column,
                              .n_rows = tile_extent(camera->height - row)};
    if (empty.n_columns > 0)
        store_nothing(canvas, &empty, canvas->blank);
}

/* Fills the pixels that the worker has not drawn yet, down to the row of pixels `row`, with the
 * background. */
static void blank_rows(const Canvas *canvas, CanvasWorker *own, int row)
{
    for (; own->row < row; own->row += TILE_SIDE) {
        store_blank(canvas, own, canvas->drawing->view->camera.width, own->row);
        own->column = 0;
    }
}

void canvas_begin_rows(const Canvas *canvas, int worker, int first)
{
    canvas->each[worker].row = first * TILE_SIDE;
    canvas->each[worker].column = 0;
}

void canvas_end_rows(const Canvas *canvas, int worker, int end)
{
    blank_rows(canvas, &canvas->each[worker], end * TILE_SIDE);
}

void canvas_store(const Canvas *canvas, int worker, const TracedTile *traced,
                  float color[3][TILE_SAMPLES])
{
    Frame *frame = canvas->frame;
    CanvasWorker *own = &canvas->each[worker];
    size_t width = 3 * (size_t)canvas->drawing->view->camera.width;
    size_t first = 3 * canvas_pixel(canvas, traced->column, traced->row);
    blank_rows(canvas, own, traced->row);
    store_blank(canvas, own, traced->column, traced->row);
    own->column = traced->column + traced->n_columns;
    if (!traced->hits && !color) {
        store_nothing(canvas, traced, canvas->background);
        return;
    }
    if (frame->color.values)
        canvas_copy(canvas, traced->n_columns, traced->n_rows, color, frame->color.values + first,
                    width);
    if (frame->codes.codes8)
        store_codes(canvas, traced, color, frame->codes.codes8 + first, width);
    if (canvas->wants_geometry)
        store_geometry(canvas, traced);
}
