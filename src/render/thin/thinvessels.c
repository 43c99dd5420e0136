/* Samples miss what is narrower than their distance, or hit it by chance: a tree of 10^6 terminals
 * at 640 pixels becomes noise. A vessel of less than a pixel is drawn as a strip of its own width
 * instead, by the area that the strip has in each pixel.
 *
 * The strip is LINES lines side by side, or as many a pixel; the area that a line stands for in a
 * pixel is its length there times their distance. Areas of vessels that follow one another end to
 * end (a run) add up, since they lie side by side; those of different runs cover each other by
 * chance: the transparencies multiply, and the colour is the mean by area. What is behind a sampled
 * surface is left out, pixel by pixel, by the depth of the centre ray. Strips end flat, are not
 * sorted among themselves, and cast no shadows.
 *
 * The colour of a vessel is the mean of the shading model over the visible half of its wall, at
 * normals in the middle of SHADED strips of equal width. As the wall is less than a pixel wide, all
 * of it has the shadows of one place: the middle of the wall towards the viewer.
 *
 * Blocks of ROWS rows, which begin where bands may, are the unit of work; each goes through the
 * vessels that touch it in their order, so that the picture depends neither on the number of
 * threads nor on the bands. */
#include "render/thin/thinvessels.h"

#include "render/light/shade.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LINES = 4, SHADED = 3, ROWS = 8 };

/* ---- which are thin -------------------------------------------------------------------------- */

/* A vessel of a geometry: a primitive, or a segment of a field. */
typedef struct Vessel {
    Vec3 a, b;
    double radius_a, radius_b;
    uint32_t segment;
    bool has_length;
} Vessel;

static size_t count_vessels(const Geometry *geometry)
{
    return geometry->n_primitives ? geometry->n_primitives : geometry->n_segments;
}

static Vessel vessel_at(const Geometry *geometry, size_t i)
{
    if (geometry->n_primitives) {
        const Primitive *p = &geometry->primitives[i];
        return (Vessel){p->a,         p->b,
                        p->radius_mm, primitive_radius_b(p),
                        p->segment,   p->kind != PRIMITIVE_SPHERE};
    }
    const FieldSegment *s = &geometry->segments[i];
    return (Vessel){s->a, s->b, s->radius_mm, s->radius_mm, s->segment, true};
}

/* The greater width of the vessel in pixels; infinite if an end is not in front of the camera. */
static double widest(const Vessel *vessel, const CameraPoint *a, const CameraPoint *b)
{
    if (!(a->per_mm > 0) || !(b->per_mm > 0))
        return HUGE_VAL;
    return 2 * fmax(vessel->radius_a * a->per_mm, vessel->radius_b * b->per_mm);
}

static double width_of(const Geometry *geometry, const Camera *camera, size_t i)
{
    const Vessel vessel = vessel_at(geometry, i);
    const CameraPoint a = camera_point(camera, vessel.a), b = camera_point(camera, vessel.b);
    return widest(&vessel, &a, &b);
}

/* Below which width a vessel is thin. */
static double limit_px(double least_px)
{
    return least_px > 1 ? least_px : 1;
}

/* Vessels in chunks, which threads work on side by side. */
enum { CHUNK = 1 << 14 };

typedef struct Search {
    ThinVessels *thin;
    const Camera *camera;
    size_t n, n_chunks; /* vessels */
    double *most;       /* by chunk: the greatest width; owned */
    size_t *first;      /* by chunk: its number of strips, and then where they begin; owned */
} Search;

static size_t chunk_end(const Search *search, size_t chunk)
{
    return (chunk + 1) * CHUNK < search->n ? (chunk + 1) * CHUNK : search->n;
}

static void measure_chunk(size_t chunk, int worker, void *context)
{
    (void)worker;
    const Search *search = context;
    double most = 0;
    for (size_t i = chunk * CHUNK; i < chunk_end(search, chunk); i++)
        most = fmax(most, width_of(search->thin->whole, search->camera, i));
    search->most[chunk] = most;
}

static void mark_chunk(size_t chunk, int worker, void *context)
{
    (void)worker;
    const Search *search = context;
    const ThinVessels *thin = search->thin;
    size_t count = 0;
    for (size_t i = chunk * CHUNK; i < chunk_end(search, chunk); i++) {
        thin->is_thin[i] = width_of(thin->whole, search->camera, i) < thin->below_px;
        count += thin->is_thin[i] && vessel_at(thin->whole, i).has_length;
    }
    search->first[chunk] = count;
}

static ThinStrip strip_of(const Vessel *vessel, const Camera *camera, uint32_t number)
{
    const CameraPoint a = camera_point(camera, vessel->a), b = camera_point(camera, vessel->b);
    return (ThinStrip){
        .x = {(float)a.x, (float)b.x},
        .y = {(float)a.y, (float)b.y},
        .depth_mm = {(float)(a.depth_mm - vessel->radius_a),
                     (float)(b.depth_mm - vessel->radius_b)},
        .width = (float)(vessel->radius_a * a.per_mm + vessel->radius_b * b.per_mm),
        .vessel = number,
        .run = number,
    };
}

static void take_chunk(size_t chunk, int worker, void *context)
{
    (void)worker;
    const Search *search = context;
    const ThinVessels *thin = search->thin;
    ThinStrip *first = thin->strips + search->first[chunk], *strip = first;
    Vec3 end = {0};
    for (size_t i = chunk * CHUNK; i < chunk_end(search, chunk); i++) {
        const Vessel vessel = vessel_at(thin->whole, i);
        if (!thin->is_thin[i] || !vessel.has_length)
            continue;
        *strip = strip_of(&vessel, search->camera, (uint32_t)i);
        if (strip > first && vec3_distance(end, vessel.a) == 0)
            strip->run = strip[-1].run;
        strip++;
        end = vessel.b;
    }
}

/* Runs that go on in the next chunk are one. */
static void join_runs(const Search *search)
{
    const ThinVessels *thin = search->thin;
    for (size_t chunk = 1; chunk < search->n_chunks; chunk++) {
        size_t at = search->first[chunk];
        if (at == 0 || at == thin->n)
            continue;
        const ThinStrip *before = &thin->strips[at - 1], first = thin->strips[at];
        if (vec3_distance(vessel_at(thin->whole, before->vessel).b,
                          vessel_at(thin->whole, first.vessel).a) > 0)
            continue;
        for (; at < thin->n && thin->strips[at].run == first.run; at++)
            thin->strips[at].run = before->run;
    }
}

/* Sets below_px, and marks what is thin. */
static Status mark(Search *search, int threads, Err *err)
{
    ThinVessels *thin = search->thin;
    double most = 0;
    TRY(mem_calloc(&search->most, search->n_chunks, sizeof *search->most, "vessels", err));
    TRY(mem_calloc(&search->first, search->n_chunks, sizeof *search->first, "vessels", err));
    TRY(mem_calloc(&thin->is_thin, search->n, sizeof *thin->is_thin, "vessels", err));
    threads_for(search->n_chunks, threads, measure_chunk, search);
    for (size_t chunk = 0; chunk < search->n_chunks; chunk++)
        most = fmax(most, search->most[chunk]);
    thin->below_px = fmin(most, limit_px(thin->least_px));
    threads_for(search->n_chunks, threads, mark_chunk, search);
    return STATUS_OK;
}

/* Makes strips of what is marked. */
static Status take(Search *search, int threads, Err *err)
{
    ThinVessels *thin = search->thin;
    for (size_t chunk = 0; chunk < search->n_chunks; chunk++) {
        size_t count = search->first[chunk];
        search->first[chunk] = thin->n;
        thin->n += count;
    }
    TRY(mem_calloc(&thin->strips, thin->n, sizeof *thin->strips, "thin vessels", err));
    threads_for(search->n_chunks, threads, take_chunk, search);
    join_runs(search);
    return STATUS_OK;
}

void thinvessels_release(ThinVessels *thin)
{
    free(thin->is_thin);
    free(thin->strips);
    *thin = (ThinVessels){0};
}

Status thinvessels_find(const Geometry *whole, const Camera *camera, double least_px, int threads,
                        ThinVessels *thin, Err *err)
{
    ThinVessels made = {.whole = whole, .least_px = least_px};
    memcpy(&made.camera, camera, sizeof made.camera);
    size_t n = model_has(whole->model, MODEL_TRIANGLES) ? 0 : count_vessels(whole);
    Search search = {.thin = &made, .camera = camera, .n = n, .n_chunks = (n + CHUNK - 1) / CHUNK};
    Status status = mark(&search, threads, err);
    if (status == STATUS_OK)
        status = take(&search, threads, err);
    free(search.most);
    free(search.first);
    if (status == STATUS_OK)
        memcpy(thin, &made, sizeof made); /* and what is between the members of the camera */
    else
        thinvessels_release(&made);
    return status;
}

/* ---- the others ------------------------------------------------------------------------------ */

/* Numbers of the vessels that are not thin, by rising number, in *rest (owned). */
static Status list_rest(const ThinVessels *thin, uint32_t **rest, size_t *n, Err *err)
{
    const Geometry *whole = thin->whole;
    TRY(mem_calloc(rest, count_vessels(whole), sizeof **rest, "vessels", err));
    *n = 0;
    for (size_t i = 0; i < count_vessels(whole); i++)
        if (!thin->is_thin[i])
            (*rest)[(*n)++] = (uint32_t)i;
    return STATUS_OK;
}

static Status primitives_part(const Geometry *whole, const uint32_t *rest, size_t n, Geometry *part,
                              Err *err)
{
    Geometry made = *whole;
    made.ids = NULL;
    made.axes = NULL;
    TRY(mem_calloc(&made.primitives, n, sizeof *made.primitives, "primitives", err));
    size_t first_end = whole->n_primitives - whole->n_ends;
    made.n_ends = 0;
    for (size_t i = 0; i < n; i++) {
        made.primitives[i] = whole->primitives[rest[i]];
        made.n_ends += rest[i] >= first_end;
    }
    made.n_primitives = made.drawn = n;
    *part = made;
    return STATUS_OK;
}

static Status copy_ids(const Geometry *whole, Geometry *part, Err *err)
{
    TRY(mem_calloc(&part->ids, whole->n_ids, sizeof *part->ids, "ids", err));
    memcpy(part->ids, whole->ids, whole->n_ids * sizeof *part->ids);
    part->n_ids = whole->n_ids;
    return STATUS_OK;
}

Status thinvessels_rest(const ThinVessels *thin, Geometry *thick, Err *err)
{
    const Geometry *whole = thin->whole;
    uint32_t *rest = NULL;
    size_t n = 0;
    Geometry made = {0};
    TRY(list_rest(thin, &rest, &n, err));
    Status status = whole->n_primitives ? primitives_part(whole, rest, n, &made, err)
                                        : geometry_part(whole, rest, n, &made, err);
    if (status == STATUS_OK)
        status = copy_ids(whole, &made, err);
    free(rest);
    if (status == STATUS_OK)
        *thick = made;
    else
        geometry_release(&made);
    return status;
}

/* ---- their walls ----------------------------------------------------------------------------- */

/* The middle of a vessel as the camera sees it. */
typedef struct Wall {
    Vec3 middle;      /* of its axis */
    Vec3 direction;   /* of the line of sight there */
    Vec3 front, side; /* unit, square to the axis: towards the viewer, and across the view */
    double radius;
} Wall;

static Wall wall_of(const Vessel *vessel, const Camera *camera)
{
    Wall wall = {.middle = vec3_scale(vec3_add(vessel->a, vessel->b), 0.5),
                 .direction = camera->direction,
                 .radius = (vessel->radius_a + vessel->radius_b) / 2};
    Vec3 axis = vec3_normalized(vec3_sub(vessel->b, vessel->a));
    if (camera->projection == PROJECTION_PERSPECTIVE)
        wall.direction = vec3_normalized(vec3_sub(wall.middle, camera->location));
    Vec3 side = vec3_cross(axis, wall.direction), other;
    if (vec3_length(side) > 1e-9)
        wall.side = vec3_normalized(side);
    else
        vec3_across(axis, &wall.side, &other);
    wall.front = vec3_cross(axis, wall.side);
    if (vec3_dot(wall.front, wall.direction) > 0)
        wall.front = vec3_scale(wall.front, -1);
    return wall;
}

static Vec3 lone_place(const void *context, size_t number)
{
    const ThinVessels *thin = context;
    const Vessel vessel = vessel_at(thin->whole, thin->strips[number].vessel);
    const Wall wall = wall_of(&vessel, &thin->camera);
    return vec3_add_scaled(wall.middle, wall.front, wall.radius);
}

LonePlaces thinvessels_places(const ThinVessels *thin)
{
    return (LonePlaces){.n = thin->n, .at = lone_place, .context = thin};
}

/* ---- coverage -------------------------------------------------------------------------------- */

/* In place of fminf and fmaxf, which are calls: nothing here is NaN. */
static float least(float a, float b)
{
    return a < b ? a : b;
}

static float greatest(float a, float b)
{
    return a > b ? a : b;
}

/* What has been drawn over a pixel. */
typedef struct Cover {
    float clear;    /* the part that other runs than the last have left free */
    float run_part; /* the part that the last run covers */
    uint32_t run;   /* the last one */
    float area;     /* of all strips */
    float color[3]; /* sum of theirs, each times its area */
} Cover;

typedef struct ThinPicture {
    const ThinVessels *thin;
    const LonePlaces *lone;
    const Drawing *drawing;
    Frame *frame;
    Cover *covers;     /* of each worker: the block that it draws, row by row */
    size_t n_blocks;   /* of the band */
    NumberLists lists; /* of each block: the strips that touch it */
} ThinPicture;

/* A strip on its way through some rows of the picture. */
typedef struct Brush {
    const ThinPicture *picture;
    const ThinStrip *strip;
    Cover *covers;          /* of the rows */
    int first_row, end_row; /* rows of the picture */
    float line_width;       /* that a line stands for, pixels */
    bool has_color;
    Rgb color;
} Brush;

/* Sets the parts of the lights that reach the vessel; below 0 of those that cast no shadows. */
static void find_parts(const Brush *brush, float parts[VIEW_MAX_LIGHTS])
{
    const View *view = brush->picture->drawing->view;
    const LonePlaces *lone = brush->picture->lone;
    size_t number = (size_t)(brush->strip - brush->picture->thin->strips);
    for (size_t i = 0; i < view->n_lights; i++)
        parts[i] = lone && lone->reach[i]
                       ? (float)lone->reach[i][number] / (float)light_points(&view->lights[i])
                       : -1;
}

/* The mean colour of the half of the vessel's wall that is seen. */
static Rgb wall_color(const Brush *brush, const Vessel *vessel)
{
    const Drawing *drawing = brush->picture->drawing;
    const Wall wall = wall_of(vessel, &drawing->view->camera);
    float parts[VIEW_MAX_LIGHTS];
    Rgb sum = {0};
    find_parts(brush, parts);
    for (int k = 0; k < SHADED; k++) {
        double across = (2 * k + 1.0) / SHADED - 1;
        Vec3 normal =
            vec3_add_scaled(vec3_scale(wall.front, sqrt(1 - across * across)), wall.side, across);
        const ShadePoint at = {.finish = &drawing->appearance->finish,
                               .pigment = appearance_color(drawing->appearance, vessel->segment),
                               .point = vec3_add_scaled(wall.middle, normal, wall.radius),
                               .normal = normal,
                               .direction = wall.direction,
                               .open = 1,
                               .parts = parts};
        Rgb one = shade(drawing->view, &at, NULL, NULL);
        sum = (Rgb){sum.r + one.r / SHADED, sum.g + one.g / SHADED, sum.b + one.b / SHADED};
    }
    return sum;
}

static void find_color(Brush *brush)
{
    const View *view = brush->picture->drawing->view;
    const Vessel vessel = vessel_at(brush->picture->thin->whole, brush->strip->vessel);
    double depth = (double)(brush->strip->depth_mm[0] + brush->strip->depth_mm[1]) / 2;
    brush->color = wall_color(brush, &vessel);
    if (effects_present(&view->effects))
        brush->color =
            rgb_mixed(brush->color, view->background, fade_at(&view->effects.fade, depth));
    brush->has_color = true;
}

static void cover(Brush *brush, int column, int row, float length, float depth_mm)
{
    const Drawing *drawing = brush->picture->drawing;
    size_t width = (size_t)drawing->view->camera.width;
    size_t pixel = (size_t)(row - drawing->band.first) * width + (size_t)column;
    Cover *at = &brush->covers[(size_t)(row - brush->first_row) * width + (size_t)column];
    if (depth_mm > brush->picture->frame->depth.values[pixel])
        return;
    if (!brush->has_color)
        find_color(brush);
    float area = length * brush->line_width;
    if (at->run != brush->strip->run) {
        at->clear *= 1 - at->run_part;
        at->run_part = 0;
        at->run = brush->strip->run;
    }
    at->run_part = least(1, at->run_part + area);
    at->area += area;
    at->color[0] += area * brush->color.r;
    at->color[1] += area * brush->color.g;
    at->color[2] += area * brush->color.b;
}

/* Cuts the part [*from, *to] of a line down to where start + t * step lies in [low, high]. */
static bool clip(float start, float step, float low, float high, float *from, float *to)
{
    if (step == 0)
        return start >= low && start < high;
    float a = (low - start) / step, b = (high - start) / step;
    *from = greatest(*from, least(a, b));
    *to = least(*to, greatest(a, b));
    return *from < *to;
}

/* Where, as t, start + t * step leaves the cell of a number. */
static float leaves(float start, float step, int cell)
{
    if (step == 0)
        return INFINITY;
    return ((float)(step > 0 ? cell + 1 : cell) - start) / step;
}

static int cell_of(float at, int first, int end)
{
    int cell = (int)floorf(at);
    return cell < first ? first : cell >= end ? end - 1 : cell;
}

/* One line of a strip of this length, beside its axis by (aside_x, aside_y), from pixel to pixel.
 */
static void draw_line(Brush *brush, float length, float aside_x, float aside_y)
{
    const ThinStrip *strip = brush->strip;
    int width = brush->picture->drawing->view->camera.width;
    float x = strip->x[0] + aside_x, y = strip->y[0] + aside_y;
    float step_x = strip->x[1] - strip->x[0], step_y = strip->y[1] - strip->y[0];
    float t = 0, end = 1;
    if (!clip(x, step_x, 0, (float)width, &t, &end) ||
        !clip(y, step_y, (float)brush->first_row, (float)brush->end_row, &t, &end))
        return;
    int column = cell_of(x + t * step_x, 0, width);
    int row = cell_of(y + t * step_y, brush->first_row, brush->end_row);
    while (t < end && column >= 0 && column < width && row >= brush->first_row &&
           row < brush->end_row) {
        float out_x = leaves(x, step_x, column), out_y = leaves(y, step_y, row);
        float next = least(end, least(out_x, out_y));
        float middle = (t + next) / 2;
        if (next > t)
            cover(brush, column, row, (next - t) * length,
                  strip->depth_mm[0] + middle * (strip->depth_mm[1] - strip->depth_mm[0]));
        t = greatest(t, next);
        if (out_x <= out_y)
            column += step_x > 0 ? 1 : -1;
        else
            row += step_y > 0 ? 1 : -1;
    }
}

/* The width that a strip is drawn with, pixels. */
static float drawn_width(const ThinVessels *thin, const ThinStrip *strip)
{
    return greatest(strip->width, (float)thin->least_px);
}

static void draw_strip(Brush *brush)
{
    const ThinStrip *strip = brush->strip;
    float wide = drawn_width(brush->picture->thin, strip);
    float step_x = strip->x[1] - strip->x[0], step_y = strip->y[1] - strip->y[0];
    float length = (float)elementary_hypot((double)step_x, (double)step_y);
    if (!(length > 0))
        return;
    int lines = wide > 1 ? (int)ceilf(LINES * wide) : LINES;
    brush->line_width = wide / (float)lines;
    for (int k = 0; k < lines; k++) {
        float aside = ((float)k + 0.5f) / (float)lines - 0.5f;
        draw_line(brush, length, -step_y / length * aside * wide, step_x / length * aside * wide);
    }
}

static void put_over(float *color, const Cover *at)
{
    float clear = at->clear * (1 - at->run_part);
    for (int c = 0; c < 3 && at->area > 0; c++)
        color[c] = color[c] * clear + at->color[c] / at->area * (1 - clear);
}

static void draw_block(size_t index, int worker, void *context)
{
    const ThinPicture *picture = context;
    const Band *band = &picture->drawing->band;
    size_t width = (size_t)picture->drawing->view->camera.width;
    int first = (int)index * ROWS, end = first + ROWS < band->rows ? first + ROWS : band->rows;
    size_t pixels = (size_t)(end - first) * width;
    Cover *covers = &picture->covers[(size_t)worker * ROWS * width];
    float *colors = &picture->frame->color.values[3 * (size_t)first * width];
    for (size_t i = 0; i < pixels; i++)
        covers[i] = (Cover){.clear = 1, .run = UINT32_MAX};
    for (uint32_t i = picture->lists.first[index]; i < picture->lists.first[index + 1]; i++) {
        Brush brush = {.picture = picture,
                       .strip = &picture->thin->strips[picture->lists.items[i]],
                       .covers = covers,
                       .first_row = band->first + first,
                       .end_row = band->first + end};
        draw_strip(&brush);
    }
    for (size_t i = 0; i < pixels; i++)
        put_over(&colors[3 * i], &covers[i]);
}

/* ---- which strips touch which blocks --------------------------------------------------------- */

/* A block of a row, those above and below the band being its first and last. */
static size_t block_of(const ThinPicture *picture, float y)
{
    const Band *band = &picture->drawing->band;
    float within = least(greatest(y - (float)band->first, 0), (float)(band->rows - 1));
    return (size_t)within / ROWS;
}

/* The blocks that a strip touches: *first <= *last, or none. */
static bool blocks_of(const ThinPicture *picture, const ThinStrip *strip, size_t *first,
                      size_t *last)
{
    const Band *band = &picture->drawing->band;
    float reach = drawn_width(picture->thin, strip);
    float top = least(strip->y[0], strip->y[1]) - reach;
    float bottom = greatest(strip->y[0], strip->y[1]) + reach;
    *first = block_of(picture, top);
    *last = block_of(picture, bottom);
    return bottom > (float)band->first && top < (float)(band->first + band->rows);
}

/* Appends the numbers of the strips to the lists of their blocks; ends[b] is where that of block b
 * ends. Without items they are only counted. */
static void list_strips(ThinPicture *picture, uint32_t *ends)
{
    for (size_t i = 0; i < picture->thin->n; i++) {
        size_t first, last;
        if (!blocks_of(picture, &picture->thin->strips[i], &first, &last))
            continue;
        for (size_t block = first; block <= last; block++) {
            if (picture->lists.items)
                picture->lists.items[ends[block]] = (uint32_t)i;
            ends[block]++;
        }
    }
}

static Status sort_strips(ThinPicture *picture, Err *err)
{
    NumberLists *lists = &picture->lists;
    size_t n = picture->n_blocks;
    TRY(mem_calloc(&lists->first, n + 2, sizeof *lists->first, "thin vessels", err));
    list_strips(picture, lists->first + 2);
    for (size_t block = 2; block < n + 2; block++)
        lists->first[block] += lists->first[block - 1];
    TRY(mem_calloc(&lists->items, lists->first[n + 1], sizeof *lists->items, "thin vessels", err));
    list_strips(picture, lists->first + 1);
    return STATUS_OK;
}

Status thinvessels_draw(const ThinVessels *thin, const LonePlaces *lone, const Drawing *drawing,
                        Frame *frame, Err *err)
{
    ThinPicture picture = {.thin = thin, .lone = lone, .drawing = drawing, .frame = frame};
    int threads = drawing->params->threads;
    size_t a_worker = ROWS * (size_t)drawing->view->camera.width;
    picture.n_blocks = ((size_t)drawing->band.rows + ROWS - 1) / ROWS;
    Status status = sort_strips(&picture, err);
    if (status == STATUS_OK)
        status = mem_calloc(&picture.covers, (size_t)threads * a_worker, sizeof *picture.covers,
                            "thin vessels", err);
    if (status == STATUS_OK)
        threads_for(picture.n_blocks, threads, draw_block, &picture);
    numberlists_release(&picture.lists);
    free(picture.covers);
    return status;
}
