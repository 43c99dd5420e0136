/* Finds the thin vessels of a view, and draws them as strips by the area that they cover.
 *
 * Samples miss a vessel that is narrower than the distance between samples, or hit it by chance: a
 * tree of 10^6 terminals at 640 pixels becomes noise. Thin vessels are therefore drawn as strips,
 * by the area that they cover in each sample's cell [tile/thincells.h]. Wider vessels are sampled.
 *
 * A strip is cut into pieces of about piece_px pixels. A piece has one color: the mean color of the
 * visible half of its wall, shaded at N_NORMALS normals. The visibility of a light from a piece is
 * that from the point of its wall that faces the light. The point that faces the viewer cannot be
 * used: if the light comes from behind, the vessel itself hides the light from this point, but not
 * from the lit sides of the visible half. The ambient visibility is that of the point that faces
 * the viewer. */
#include "render/thin/thinvessels.h"

#include "render/cast/caster.h"
#include "render/light/shade.h"
#include "render/tile/interval.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Normals at which a piece is shaded, in the middles of parts of equal width across the strip. With
 * 5, the mean diffuse light of a lamp behind the viewer is 2.7 % too bright; with 10, 1.0 %. The
 * time to color the pieces is proportional to this number. */
enum { N_NORMALS = 5 };
/* Rows of samples that a thread draws at a time: one row of tiles, because strips are listed per
 * tile. */
enum { ROWS = TILE_SIDE };
/* Length of a piece, pixels. Shorter pieces take more time and, below one pixel, show nothing more;
 * longer pieces blur the shadows that fall on a vessel. */
static const double piece_px = 1.5;
/* Height of shading points above the vessel's surface, in radii: less than a sample resolves,
 * because thin vessels are narrower than a pixel, and more than rounding. */
static const double lift_radii = 0.25;

/* ---- which are thin -------------------------------------------------------------------------- */

/* A vessel of a geometry: a primitive, or a segment of a field. */
typedef struct ThinVessel {
    Vec3 a, b;
    double radius_a, radius_b;
    uint32_t segment;
    bool has_length;
} ThinVessel;

static size_t count_vessels(const Geometry *geometry)
{
    return geometry->n_primitives ? geometry->n_primitives : geometry->n_segments;
}

static ThinVessel vessel_at(const Geometry *geometry, size_t i)
{
    if (geometry->n_primitives) {
        const Primitive *p = &geometry->primitives[i];
        return (ThinVessel){p->a,         p->b,
                            p->radius_mm, primitive_radius_b(p),
                            p->segment,   p->kind != PRIMITIVE_SPHERE};
    }
    const FieldSegment *s = &geometry->segments[i];
    return (ThinVessel){s->a, s->b, s->radius_mm, s->radius_mm, s->segment, true};
}

/* Returns the part of a vessel between two positions, 0..1 from its first end. */
static ThinVessel vessel_part(const ThinVessel *vessel, double from, double to)
{
    Vec3 span = vec3_sub(vessel->b, vessel->a);
    double widening = vessel->radius_b - vessel->radius_a;
    ThinVessel part = *vessel;
    part.a = vec3_add_scaled(vessel->a, span, from);
    part.b = vec3_add_scaled(vessel->a, span, to);
    part.radius_a = vessel->radius_a + from * widening;
    part.radius_b = vessel->radius_a + to * widening;
    return part;
}

/* Returns the greater width of the vessel in pixels; infinite if an end is not in front of a
 * perspective camera. */
static double widest(const ThinVessel *vessel, const Camera *camera)
{
    const CameraPoint a = camera_point(camera, vessel->a), b = camera_point(camera, vessel->b);
    if (!(a.per_mm > 0) || !(b.per_mm > 0))
        return HUGE_VAL;
    return 2 * fmax(vessel->radius_a * a.per_mm, vessel->radius_b * b.per_mm);
}

/* Vessels per chunk, the unit of work of a thread: so many that taking a chunk costs nothing, so
 * few that a large tree has chunks for all threads. The result does not depend on it. */
enum { CHUNK = 1 << 14 };

typedef ARRAY(ThinStrip) ThinStrips;

/* The search for the thin vessels of a view. */
typedef struct ThinSearch {
    ThinVessels *thin;
    const Camera *camera;
    ThinWidths widths;
    size_t n, n_chunks; /* numbers of vessels and of chunks */
    ThinStrips *found;  /* per chunk: the strips of its thin vessels; owned */
} ThinSearch;

/* Clips the range [*from, *to] of a vessel to the part in front of an orthographic camera. */
static void clip_at_camera(const ThinVessel *vessel, const Camera *camera, double *from, double *to)
{
    if (camera->projection == PROJECTION_ORTHOGRAPHIC)
        clip_parameters(camera_point(camera, vessel->a).depth_mm - NEAREST_VISIBLE_MM,
                        camera_point(camera, vessel->b).depth_mm - NEAREST_VISIBLE_MM, from, to);
}

static double depth_along_view(const Camera *camera, Vec3 point)
{
    return vec3_dot(vec3_sub(point, camera->location), camera->direction);
}

/* Makes the strip of a vessel. The vessel is clipped at the camera's plane, then its projection is
 * clipped at the edges of the picture, with a margin of the strip's width. Returns false if nothing
 * is left. */
static bool make_strip(const ThinSearch *search, uint32_t number, ThinStrip *strip)
{
    const Camera *camera = search->camera;
    const ThinVessel whole = vessel_at(search->thin->whole, number);
    double near = 0, far = 1, from = 0, to = 1;
    clip_at_camera(&whole, camera, &near, &far);
    if (!(near < far))
        return false;
    const ThinVessel vessel = vessel_part(&whole, near, far);
    const CameraPoint a = camera_point(camera, vessel.a), b = camera_point(camera, vessel.b);
    const double width =
        fmax(vessel.radius_a * a.per_mm + vessel.radius_b * b.per_mm, search->widths.min_width_px);
    const double margin = width + 1; /* keeps clipped ends out of all cells of the picture */
    const double z[2] = {depth_along_view(camera, vessel.a) - vessel.radius_a,
                         depth_along_view(camera, vessel.b) - vessel.radius_b};
    clip_parameters(a.x + margin, b.x + margin, &from, &to);
    clip_parameters(camera->width + margin - a.x, camera->width + margin - b.x, &from, &to);
    clip_parameters(a.y + margin, b.y + margin, &from, &to);
    clip_parameters(camera->height + margin - a.y, camera->height + margin - b.y, &from, &to);
    if (!(from < to))
        return false;
    const double length = elementary_hypot(b.x - a.x, b.y - a.y) * (to - from);
    *strip = (ThinStrip){.z = {(float)z[0], (float)z[1]},
                         .part = {(float)near, (float)far},
                         .width = (float)width,
                         .vessel = number,
                         .run = number,
                         .n_pieces = (uint32_t)ceil(fmax(length / piece_px, 1))};
    /* The ends of the strip after clipping. Both functions of strip->z below need its values before
     * clipping, so these are replaced last. */
    const double ends[2] = {from, to};
    float depths[2], parts[2];
    for (int end = 0; end < 2; end++) {
        double s = ends[end];
        double inverse = (1 - s) / z[0] + s / z[1];
        strip->x[end] = (float)(a.x + s * (b.x - a.x));
        strip->y[end] = (float)(a.y + s * (b.y - a.y));
        depths[end] =
            (float)(search->thin->layer.perspective ? 1 / inverse : z[0] + s * (z[1] - z[0]));
        parts[end] = (float)thinstrip_part(&search->thin->layer, strip, s);
    }
    memcpy(strip->z, depths, sizeof depths);
    memcpy(strip->part, parts, sizeof parts);
    return true;
}

/* Finds the thin vessels of a chunk, and makes their strips. */
static Status search_chunk(size_t chunk, int worker, void *context, Err *err)
{
    (void)worker;
    const ThinSearch *search = context;
    bool *is_thin = search->thin->layer.is_thin;
    for (size_t i = chunk * CHUNK; i < search->n && i < (chunk + 1) * CHUNK; i++) {
        const ThinVessel vessel = vessel_at(search->thin->whole, i);
        ThinStrip strip;
        is_thin[i] = widest(&vessel, search->camera) <
                     fmax(search->widths.below_px, search->widths.min_width_px);
        if (is_thin[i] && vessel.has_length && make_strip(search, (uint32_t)i, &strip))
            TRY(ARRAY_PUSH(&search->found[chunk], "thin vessels", err, strip));
    }
    return STATUS_OK;
}

/* Returns true if a strip adds its area to that of the strip before it: its vessel begins where the
 * other vessel ends, and does not lead back over it in the picture. */
static bool continues(const ThinSearch *search, const ThinStrip *before, const ThinStrip *strip)
{
    const Geometry *whole = search->thin->whole;
    const Vec3 end = vessel_at(whole, before->vessel).b, start = vessel_at(whole, strip->vessel).a;
    return vec3_distance(end, start) == 0 &&
           (before->x[1] - before->x[0]) * (strip->x[1] - strip->x[0]) +
                   (before->y[1] - before->y[0]) * (strip->y[1] - strip->y[0]) >=
               0;
}

/* Puts the strips of all chunks together in the order of the vessels, and numbers their runs
 * (chains of vessels, end to end). */
static Status gather_strips(const ThinSearch *search, Err *err)
{
    ThinLayer *layer = &search->thin->layer;
    size_t n = 0;
    for (size_t chunk = 0; chunk < search->n_chunks; chunk++)
        n += search->found[chunk].n;
    TRY(mem_alloc(&layer->strips, n, sizeof *layer->strips, "thin vessels", err));
    for (size_t chunk = 0; chunk < search->n_chunks; chunk++)
        for (size_t i = 0; i < search->found[chunk].n; i++) {
            ThinStrip *strip = &layer->strips[layer->n++];
            *strip = search->found[chunk].items[i];
            if (layer->n > 1 && continues(search, strip - 1, strip))
                strip->run = strip[-1].run;
        }
    return STATUS_OK;
}

/* Returns by how many radii the end of a run is moved outwards. A strip ends at the end of the
 * vessel's axis; on the picture, a round end adds half a disc to its area, and a flat end half an
 * ellipse. A rectangle of the width of the strip has the area of half a disc if it is pi / 4 radii
 * long. Nothing is added where a run begins within another vessel: everywhere except at a round end
 * or a free flat end of its first cylinder. */
static double end_in_radii(const ThinSearch *search, const ThinStrip *strip, int end)
{
    const double quarter_turn = 0.78539816339744831;
    const Geometry *whole = search->thin->whole;
    const ThinVessel vessel = vessel_at(whole, strip->vessel);
    const Primitive *one = whole->n_primitives ? &whole->primitives[strip->vessel] : NULL;
    const bool is_round = one && (end ? one->round_b : one->round_a);
    if (end == 0 && !is_round && !(one && one->free_a))
        return 0;
    const Vec3 axis = vec3_normalized(vec3_sub(vessel.b, vessel.a));
    Vec3 sight = search->camera->direction;
    if (search->thin->layer.perspective)
        sight = vec3_normalized(vec3_sub(vessel.b, search->camera->location));
    return quarter_turn * (is_round ? 1 : fabs(vec3_dot(axis, sight)));
}

/* Moves the ends of a strip that are ends of its run outwards by end_in_radii. */
static void extend_strip(const ThinSearch *search, ThinStrip *strip, bool is_first, bool is_last)
{
    const float x = strip->x[1] - strip->x[0], y = strip->y[1] - strip->y[0];
    const float length = sqrtf(x * x + y * y), radius = strip->width / 2;
    const float toward[2] = {length > 0 ? x / length : 1, length > 0 ? y / length : 0};
    const float before = is_first ? radius * (float)end_in_radii(search, strip, 0) : 0;
    const float behind = is_last ? radius * (float)end_in_radii(search, strip, 1) : 0;
    strip->x[0] -= before * toward[0];
    strip->y[0] -= before * toward[1];
    strip->x[1] += behind * toward[0];
    strip->y[1] += behind * toward[1];
}

/* Numbers the pieces of all strips. */
static Status number_pieces(ThinVessels *thin, Err *err)
{
    ThinLayer *layer = &thin->layer;
    for (size_t i = 0; i < layer->n; i++) {
        layer->strips[i].first_piece = (uint32_t)layer->n_pieces;
        layer->n_pieces += layer->strips[i].n_pieces;
    }
    TRY(mem_calloc(&thin->piece_strips, layer->n_pieces, sizeof *thin->piece_strips, "thin vessels",
                   err));
    TRY(mem_calloc(&layer->colors, layer->n_pieces, sizeof *layer->colors, "thin vessels", err));
    for (size_t i = 0; i < layer->n; i++)
        for (uint32_t k = 0; k < layer->strips[i].n_pieces; k++)
            thin->piece_strips[layer->strips[i].first_piece + k] = (uint32_t)i;
    return STATUS_OK;
}

static Vec3 lit_point(const void *context, const Light *light, size_t piece);

/* Fills search->thin, except its camera. */
static Status find_strips(ThinSearch *search, int threads, Err *err)
{
    ThinLayer *layer = &search->thin->layer;
    layer->perspective = search->camera->projection == PROJECTION_PERSPECTIVE;
    TRY(mem_calloc(&search->found, search->n_chunks, sizeof *search->found, "vessels", err));
    TRY(mem_calloc(&layer->is_thin, search->n, sizeof *layer->is_thin, "vessels", err));
    TRY(threads_try(search->n_chunks, threads, search_chunk, search, err));
    TRY(gather_strips(search, err));
    for (size_t i = 0; i < layer->n; i++) {
        const ThinStrip *strip = &layer->strips[i];
        extend_strip(search, &layer->strips[i], i == 0 || strip[-1].run != strip->run,
                     i + 1 == layer->n || strip[1].run != strip->run);
    }
    TRY(number_pieces(search->thin, err));
    search->thin->lights =
        (OffPixelPoints){.n = layer->n_pieces, .at = lit_point, .context = search->thin};
    return thinlayer_sort(layer, search->camera, err);
}

void thinvessels_release(ThinVessels *thin)
{
    thinlayer_release(&thin->layer);
    offpixel_release(&thin->lights);
    free(thin->piece_strips);
    free(thin->ambient);
    *thin = (ThinVessels){0};
}

Status thinvessels_find(const Geometry *whole, const Camera *camera, ThinWidths widths, int threads,
                        ThinVessels *thin, Err *err)
{
    *thin = (ThinVessels){.whole = whole};
    size_t n = model_has(whole->model, MODEL_TRIANGLES) ? 0 : count_vessels(whole);
    ThinSearch search = {.thin = thin,
                         .camera = camera,
                         .widths = widths,
                         .n = n,
                         .n_chunks = (n + CHUNK - 1) / CHUNK};
    Status status = find_strips(&search, threads, err);
    for (size_t chunk = 0; search.found && chunk < search.n_chunks; chunk++)
        ARRAY_RELEASE(&search.found[chunk]);
    free(search.found);
    memcpy(&thin->camera, camera, sizeof thin->camera);
    if (status != STATUS_OK)
        thinvessels_release(thin);
    return status;
}

/* ---- walls of pieces ------------------------------------------------------------------------- */

/* The wall of a vessel in the middle of a piece. */
typedef struct ThinWall {
    Vec3 middle;      /* on the vessel's axis */
    Vec3 axis;        /* unit */
    Vec3 direction;   /* unit, of the line of sight to the middle */
    Vec3 front, side; /* unit, perpendicular to the axis: towards the viewer, and across the view */
    double radius;
    uint32_t segment;
} ThinWall;

static ThinWall wall_of(const ThinVessels *thin, size_t piece)
{
    const Camera *camera = &thin->camera;
    const ThinStrip *strip = &thin->layer.strips[thin->piece_strips[piece]];
    const ThinVessel whole = vessel_at(thin->whole, strip->vessel);
    const double s = ((double)(piece - strip->first_piece) + 0.5) / strip->n_pieces;
    const double part = thinstrip_part(&thin->layer, strip, s);
    const ThinVessel at = vessel_part(&whole, part, part);
    ThinWall wall = {.middle = at.a,
                     .axis = vec3_normalized(vec3_sub(whole.b, whole.a)),
                     .direction = camera->direction,
                     .radius = at.radius_a,
                     .segment = whole.segment};
    if (camera->projection == PROJECTION_PERSPECTIVE)
        wall.direction = vec3_normalized(vec3_sub(wall.middle, camera->location));
    Vec3 side = vec3_cross(wall.axis, wall.direction), other;
    if (vec3_length(side) > 1e-9)
        wall.side = vec3_normalized(side);
    else
        vec3_perpendiculars(wall.axis, &wall.side, &other);
    wall.front = vec3_cross(wall.axis, wall.side);
    if (vec3_dot(wall.front, wall.direction) > 0)
        wall.front = vec3_scale(wall.front, -1);
    return wall;
}

/* Returns the shading point above the wall where the wall has this normal. */
static Vec3 above_wall(const ThinWall *wall, Vec3 normal)
{
    return vec3_add_scaled(wall->middle, normal, (1 + lift_radii) * wall->radius);
}

/* OffPixelPoints.at: the point of a piece that faces the light. */
static Vec3 lit_point(const void *context, const Light *light, size_t piece)
{
    const ThinWall wall = wall_of(context, piece);
    Vec3 towards = light_direction(light, wall.middle).towards;
    Vec3 across = vec3_add_scaled(towards, wall.axis, -vec3_dot(towards, wall.axis));
    return above_wall(&wall, vec3_length(across) > 1e-6 ? vec3_normalized(across) : wall.front);
}

/* ---- ambient visibility ---------------------------------------------------------------------- */

/* Assigns the pieces to the pixels of a picture of one row, so that occlusion_compute can process
 * them. Sets (*columns)[piece], which the caller frees, and *n to the number of columns. A run
 * begins at a multiple of APART, at least APART columns behind the run before it. occlusion_compute
 * averages over pixels in up to the next quad (two columns) to either side [light/occlusion.c], so
 * that runs, whose walls have nothing in common, are never averaged. */
static Status place_pieces(const ThinVessels *thin, uint32_t **columns, size_t *n, Err *err)
{
    enum { APART = 4 };
    const ThinLayer *layer = &thin->layer;
    size_t at = 0;
    TRY(mem_calloc(columns, layer->n_pieces, sizeof **columns, "occlusion", err));
    for (size_t i = 0; i < layer->n; i++) {
        const ThinStrip *strip = &layer->strips[i];
        if (i > 0 && strip->run != strip[-1].run)
            at = (at / APART + 2) * APART;
        for (uint32_t k = 0; k < strip->n_pieces; k++)
            (*columns)[strip->first_piece + k] = (uint32_t)at++;
    }
    *n = at;
    return STATUS_OK;
}

/* Makes the shading points of the pieces, at the pixels that place_pieces has assigned. */
static Status make_points(const Drawing *drawing, const ThinVessels *thin, const uint32_t *columns,
                          PixelVisibility *light, Err *err)
{
    size_t n = thin->layer.n_pieces;
    TRY(mem_alloc(&light->point_index, (size_t)light->width, sizeof *light->point_index,
                  "occlusion", err));
    TRY(mem_calloc(&light->points, n, sizeof *light->points, "occlusion", err));
    memset(light->point_index, 0xff,
           (size_t)light->width * sizeof *light->point_index); /* NO_HIT */
    for (size_t piece = 0; piece < n; piece++) {
        const ThinWall wall = wall_of(thin, piece);
        double t = vec3_distance(wall.middle, drawing->view->camera.location);
        light->point_index[columns[piece]] = (uint32_t)piece;
        light->points[piece] =
            shadingpoint_of(light, SURFACE_VESSEL, above_wall(&wall, wall.front), wall.front,
                            pixelvisibility_pixel_mm(&drawing->view->camera, t));
    }
    return STATUS_OK;
}

Status thinvessels_find_ambient(const Drawing *drawing, const OccluderSet *occluders,
                                ThinVessels *thin, Err *err)
{
    PixelVisibility *light = NULL;
    uint32_t *columns = NULL;
    size_t width = 0;
    Status status;
    TRY_GOTO(mem_calloc(&light, 1, sizeof *light, "occlusion", err));
    TRY_GOTO(place_pieces(thin, &columns, &width, err));
    light->width = (int)width;
    light->rows = light->samples_per_side = 1;
    light->origin = occluders->origin;
    TRY_GOTO(make_points(drawing, thin, columns, light, err));
    TRY_GOTO(occlusion_compute(drawing, occluders, light, err));
    free(thin->ambient);
    TRY_GOTO(
        mem_calloc(&thin->ambient, thin->layer.n_pieces, sizeof *thin->ambient, "occlusion", err));
    for (size_t piece = 0; piece < thin->layer.n_pieces; piece++)
        thin->ambient[piece] = light->ambient[columns[piece]];
done:
    pixelvisibility_free(light);
    free(columns);
    return status;
}

/* ---- colors --------------------------------------------------------------------------------- */

/* Sets the visibility of each light at a piece, 0..1; -1 for a light that casts no shadows. */
static void find_light_visibility(const ThinVessels *thin, const View *view, size_t piece,
                                  float light_visibility[VIEW_MAX_LIGHTS])
{
    for (size_t i = 0; i < view->n_lights; i++)
        light_visibility[i] = thin->lights.n_visible[i] ? (float)thin->lights.n_visible[i][piece] /
                                                              (float)light_points(&view->lights[i])
                                                        : -1;
}

/* Returns the mean color of the visible half of a piece's surface. */
static Rgb wall_color(const Drawing *drawing, const ThinVessels *thin, const ThinWall *wall,
                      size_t piece)
{
    float light_visibility[VIEW_MAX_LIGHTS];
    Rgb sum = {0};
    find_light_visibility(thin, drawing->view, piece, light_visibility);
    for (int k = 0; k < N_NORMALS; k++) {
        double across = (2 * k + 1.0) / N_NORMALS - 1;
        Vec3 normal =
            vec3_add_scaled(vec3_scale(wall->front, sqrt(1 - across * across)), wall->side, across);
        const ShadingInput at = {.finish = &drawing->appearance->finish,
                                 .pigment = appearance_color(drawing->appearance, wall->segment),
                                 .point = vec3_add_scaled(wall->middle, normal, wall->radius),
                                 .normal = normal,
                                 .direction = wall->direction,
                                 .ambient = thin->ambient ? (double)thin->ambient[piece] : 1,
                                 .light_visibility = light_visibility};
        Rgb one = shade(drawing->view, &at, NULL, NULL);
        sum =
            (Rgb){sum.r + one.r / N_NORMALS, sum.g + one.g / N_NORMALS, sum.b + one.b / N_NORMALS};
    }
    return sum;
}

/* Returns the color of a piece, mixed with the background's color if the view fades with depth. */
static Rgb piece_color(const Drawing *drawing, const ThinVessels *thin, size_t piece)
{
    const View *view = drawing->view;
    const ThinWall wall = wall_of(thin, piece);
    Rgb color = wall_color(drawing, thin, &wall, piece);
    if (!fade_is_on(&view->fade))
        return color;
    const CameraPoint at = camera_point(&thin->camera, wall.middle);
    const Grade *grade = &view->effects.grade;
    const Rgb paper = grade->present
                          ? grade_at(grade, at.x, at.y, thin->camera.width, thin->camera.height)
                          : view->background;
    return rgb_mixed(color, paper, fade_at(&view->fade, at.depth_mm - wall.radius));
}

/* The arguments of the threads that color and draw strips. */
typedef struct ThinJob {
    const Drawing *drawing;
    const ThinVessels *thin;
    Frame *frame;
    ThinCells *cells; /* per worker; owned */
} ThinJob;

/* Returns true if the strip may touch the rows of a band. */
static bool touches_band(const ThinStrip *strip, const Band *band)
{
    float top = (float)(band->first - TILE_SIDE) - strip->width;
    float bottom = (float)(band->first + band->rows + TILE_SIDE) + strip->width;
    return (strip->y[0] > top || strip->y[1] > top) &&
           (strip->y[0] < bottom || strip->y[1] < bottom);
}

/* Strips that a thread colors at a time: so many that taking them costs nothing. */
enum { STRIPS_AT_ONCE = 256 };

static void color_strips(size_t index, int worker, void *context)
{
    (void)worker;
    const ThinJob *job = context;
    const ThinLayer *layer = &job->thin->layer;
    size_t end = (index + 1) * STRIPS_AT_ONCE;
    for (size_t i = index * STRIPS_AT_ONCE; i < end && i < layer->n; i++) {
        const ThinStrip *strip = &layer->strips[i];
        for (uint32_t k = 0; k < strip->n_pieces && touches_band(strip, &job->drawing->band); k++) {
            size_t piece = strip->first_piece + k;
            Rgb color = piece_color(job->drawing, job->thin, piece);
            memcpy(layer->colors[piece], (float[]){color.r, color.g, color.b},
                   sizeof *layer->colors);
        }
    }
}

void thinvessels_color(const Drawing *drawing, const ThinVessels *thin)
{
    ThinJob job = {.drawing = drawing, .thin = thin};
    threads_for((thin->layer.n + STRIPS_AT_ONCE - 1) / STRIPS_AT_ONCE, drawing->params->threads,
                color_strips, &job);
}

/* ---- drawing over samples -------------------------------------------------------------------- */

/* Draws the strips over ROWS rows of samples. thincells_over compares depths along the view, the
 * depth plane has distances along the rays. */
static Status draw_rows(size_t index, int worker, void *context, Err *err)
{
    const ThinJob *job = context;
    const Band *band = &job->drawing->band;
    const Camera *camera = &job->drawing->view->camera;
    const int first = (int)index * ROWS,
              rows = band->rows - first < ROWS ? band->rows - first : ROWS;
    ThinCells *cells = &job->cells[worker];
    const CellBlock block = {0, band->first + first, camera->width, rows, 1};
    TRY(thincells_fill(&job->thin->layer, block, cells, err));
    for (int row = 0; row < rows && cells->fragments.n > 0; row++)
        for (int column = 0; column < camera->width; column++) {
            size_t pixel = (size_t)(first + row) * (size_t)camera->width + (size_t)column;
            if (thincells_are_empty(cells, column, row))
                continue;
            double depth = (double)job->frame->depth.values[pixel];
            double along = vec3_dot(camera_ray(camera, column, band->first + first + row).direction,
                                    camera->direction);
            thincells_over(cells, column, row, (float)(depth * along),
                           &job->frame->color.values[3 * pixel]);
        }
    return STATUS_OK;
}

Status thinvessels_draw(const Drawing *drawing, const ThinVessels *thin, Frame *frame, Err *err)
{
    const int workers = drawing->params->threads;
    ThinJob job = {.drawing = drawing, .thin = thin, .frame = frame};
    Status status;
    TRY_GOTO(mem_calloc(&job.cells, (size_t)workers, sizeof *job.cells, "thin vessels", err));
    TRY_GOTO(
        threads_try(((size_t)drawing->band.rows + ROWS - 1) / ROWS, workers, draw_rows, &job, err));
done:
    for (int i = 0; job.cells && i < workers; i++)
        thincells_release(&job.cells[i]);
    free(job.cells);
    return status;
}
