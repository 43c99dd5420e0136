/* Pixels are of four sets, as they lie in squares of two by two. A pixel asks a quarter of the
 * beams [beams.c], and of the points of an area light, that of its set, and takes the answers of
 * the pixels around it that lie on the same surface: in the proportions 1 : 2 : 1 across and down,
 * by which each set has the same weight, so that a plane has the mean of all four, without grain.
 * Beams of a neighbour count by their cosine to the surface here: that is what light changes most
 * by on a thin vessel.
 *
 * Views of some directions at a time are made, and asked by runs of pixels of one set. Answers are
 * bytes, so that a picture's need little memory, and are summed in one order. */
#include "render/sky/share.h"

#include "render/cast/caster.h"
#include "render/light/shade.h"
#include "render/sky/beamkernels.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SETS = 4, MOST_A_SET = 256, VIEWS_BYTES = 96 << 20, MOST_VIEWS = 32 };

/* The pixels of a set that see something, row by row; a pixel's number is its index in `pixels`. */
typedef struct Share {
    const Drawing *drawing;
    SharedLight *light;
    const BeamKernels *kernels;
    const Beams *beams;
    uint32_t *pixels, *numbers; /* owned; of each number its pixel, of each pixel its number */
    size_t first[SETS + 1];     /* numbers of set i are [first[i], first[i + 1]) */
    int asked, stride;          /* beams of a set, and bytes of answers to a pixel */
    uint8_t *answers;           /* owned; of each number */
    float *directions[3];       /* owned; of set i [i * stride, i * stride + asked) */
    BeamView *views;            /* owned */
    int first_view, n_views;    /* direction numbers at hand */
    Status *failed;             /* of each view */
    float *cosines;             /* owned; one row of SETS * stride a worker */
    BeamQueries *queries;       /* owned; one a worker */
    int number;                 /* of the light at hand */
    uint16_t *reach;            /* owned; of each number, how many points of that it sees */
} Share;

static int set_of(int column, int row)
{
    return (row & 1) * 2 + (column & 1);
}

/* ---- places ---------------------------------------------------------------------------------- */

typedef struct PlaceJob {
    const Drawing *drawing;
    const Frame *planes;
    SharedLight *light;
} PlaceJob;

static Vec3 facing(Vec3 normal, Vec3 direction)
{
    return vec3_dot(normal, direction) > 0 ? vec3_scale(normal, -1) : normal;
}

static PixelPlace place_at(const PlaceJob *job, int column, int row, size_t pixel)
{
    const View *view = job->drawing->view;
    Ray ray = camera_ray(&view->camera, column, row);
    double t = (double)job->planes->depth.values[pixel];
    const float *normal = &job->planes->normal.values[3 * pixel];
    if (ground_hit(&view->ground, ray, NEAREST_SEEN_MM, t, &t))
        return sharedlight_place(job->light, PLACE_GROUND, ray_at(ray, t),
                                 facing(view->ground.normal, ray.direction),
                                 sharedlight_pixel_mm(&view->camera, t));
    if (!isfinite(t))
        return (PixelPlace){.kind = PLACE_NONE};
    return sharedlight_place(job->light, PLACE_VESSEL, ray_at(ray, t),
                             vec3((double)normal[0], (double)normal[1], (double)normal[2]),
                             sharedlight_pixel_mm(&view->camera, t));
}

static void find_places(size_t row, int worker, void *context)
{
    (void)worker;
    const PlaceJob *job = context;
    const SharedLight *light = job->light;
    for (int column = 0; column < light->width; column++) {
        size_t pixel = row * (size_t)light->width + (size_t)column;
        light->places[pixel] = place_at(job, column, light->first + (int)row, pixel);
    }
}

/* Lists the pixels that see something, set by set. */
static Status list_pixels(Share *share, Err *err)
{
    const SharedLight *light = share->light;
    size_t n = (size_t)light->width * (size_t)light->rows, taken = 0;
    TRY(mem_calloc(&share->pixels, n, sizeof *share->pixels, "places", err));
    TRY(mem_calloc(&share->numbers, n, sizeof *share->numbers, "places", err));
    for (int set = 0; set < SETS; set++) {
        share->first[set] = taken;
        for (int row = (set / 2 ^ light->first) & 1; row < light->rows; row += 2)
            for (int column = set & 1; column < light->width; column += 2) {
                size_t pixel = (size_t)row * (size_t)light->width + (size_t)column;
                if (light->places[pixel].kind == PLACE_NONE)
                    continue;
                share->numbers[pixel] = (uint32_t)taken;
                share->pixels[taken++] = (uint32_t)pixel;
            }
    }
    share->first[SETS] = taken;
    return STATUS_OK;
}

/* ---- the sky --------------------------------------------------------------------------------- */

/* Whether the ground hides the direction from a place that is not of it. */
static bool is_grounded(const Share *share, const PixelPlace *place, Vec3 direction)
{
    const Ground *ground = &share->drawing->view->ground;
    if (!ground->present || place->kind == PLACE_GROUND)
        return false;
    Vec3 point = vec3_add(share->light->origin,
                          vec3((double)place->at[0], (double)place->at[1], (double)place->at[2]));
    double above = vec3_dot(ground->normal, point) - ground->offset_mm;
    return above * vec3_dot(ground->normal, direction) < 0;
}

/* Asks one view about a run of numbers. */
static void ask_view(const Share *share, const BeamView *view, int column, size_t from, size_t to,
                     BeamQueries *queries)
{
    const float widest = sqrtf(3.14159265f / (float)(SETS * share->asked));
    const Vec3 towards = view->axes[2];
    const float d[3] = {(float)towards.x, (float)towards.y, (float)towards.z};
    size_t numbers[BEAMS_AT_ONCE];
    queries->n = 0;
    for (size_t number = from; number < to; number++) {
        const PixelPlace *place = &share->light->places[share->pixels[number]];
        uint8_t *answer = &share->answers[number * (size_t)share->stride + (size_t)column];
        float cosine = d[0] * place->normal[0] + d[1] * place->normal[1] + d[2] * place->normal[2];
        *answer = cosine > 0 ? 0 : BEAM_UNASKED;
        if (!(cosine > 0) || is_grounded(share, place, towards))
            continue;
        int i = queries->n++;
        numbers[i] = number;
        for (int c = 0; c < 3; c++)
            queries->at[c][i] = place->at[c];
        queries->widening[i] = cosine < widest ? cosine : widest;
    }
    share->kernels->open(view, share->beams->wide, queries);
    for (int i = 0; i < queries->n; i++)
        share->answers[numbers[i] * (size_t)share->stride + (size_t)column] =
            (uint8_t)(BEAM_FREE * queries->open[i] + 0.5f);
}

/* Runs of numbers: those of a set are in as many as it takes. */
static size_t runs_of(const Share *share, int set)
{
    return (share->first[set + 1] - share->first[set] + BEAMS_AT_ONCE - 1) / BEAMS_AT_ONCE;
}

static size_t all_runs(const Share *share)
{
    size_t sum = 0;
    for (int set = 0; set < SETS; set++)
        sum += runs_of(share, set);
    return sum;
}

static void find_run(const Share *share, size_t index, int *set, size_t *from, size_t *to)
{
    for (*set = 0; index >= runs_of(share, *set); ++*set)
        index -= runs_of(share, *set);
    *from = share->first[*set] + index * BEAMS_AT_ONCE;
    *to = share->first[*set + 1];
    *to = *to - *from > BEAMS_AT_ONCE ? *from + BEAMS_AT_ONCE : *to;
}

static void ask_run(size_t index, int worker, void *context)
{
    const Share *share = context;
    int set;
    size_t from, to;
    find_run(share, index, &set, &from, &to);
    for (int i = 0; i < share->n_views; i++) {
        int direction = share->first_view + i;
        if (direction % SETS == set)
            ask_view(share, &share->views[i], direction / SETS, from, to, &share->queries[worker]);
    }
}

static void make_view(size_t index, int worker, void *context)
{
    (void)worker;
    const Share *share = context;
    int direction = share->first_view + (int)index, n = SETS * share->asked;
    share->failed[index] =
        beamview_make(share->beams, beams_direction(n, direction), &share->views[index], NULL);
}

static Status ask_sky(Share *share, Err *err)
{
    int threads = share->drawing->params->threads, n = SETS * share->asked;
    size_t room = VIEWS_BYTES / (beamview_bytes(share->beams) + 1);
    int most = room < (size_t)threads ? threads : room < MOST_VIEWS ? (int)room : MOST_VIEWS;
    TRY(mem_calloc(&share->views, (size_t)most, sizeof *share->views, "occlusion", err));
    TRY(mem_calloc(&share->failed, (size_t)most, sizeof *share->failed, "occlusion", err));
    Status status = STATUS_OK;
    for (int k = 0; k < n && status == STATUS_OK; k += most) {
        share->first_view = k;
        share->n_views = n - k < most ? n - k : most;
        threads_for((size_t)share->n_views, threads, make_view, share);
        for (int i = 0; i < share->n_views && status == STATUS_OK; i++)
            status = share->failed[i];
        if (status == STATUS_OK)
            threads_for(all_runs(share), threads, ask_run, share);
    }
    for (int i = 0; i < most; i++)
        beamview_release(&share->views[i]);
    if (status != STATUS_OK)
        return err_set(err, status, "out of memory: no room for occlusion");
    return STATUS_OK;
}

/* ---- what neighbours share ------------------------------------------------------------------- */

/* A pixel of the three by three about another that is on its surface, and its weight there. */
typedef struct Neighbour {
    uint32_t number;
    int set;
    float part;
} Neighbour;

static int neighbours_of(const Share *share, uint32_t pixel, Neighbour found[9])
{
    const SharedLight *light = share->light;
    int column = (int)(pixel % (uint32_t)light->width), row = (int)(pixel / (uint32_t)light->width);
    int n = 0;
    for (int j = row - 1; j <= row + 1; j++)
        for (int i = column - 1; i <= column + 1; i++) {
            if (i < 0 || i >= light->width || j < 0 || j >= light->rows)
                continue;
            size_t other = (size_t)j * (size_t)light->width + (size_t)i;
            if (places_are_of_one(&light->places[pixel], &light->places[other]))
                found[n++] = (Neighbour){share->numbers[other], set_of(i, light->first + j),
                                         (float)((i == column ? 2 : 1) * (j == row ? 2 : 1))};
        }
    return n;
}

static void gather_open(const Share *share, uint32_t pixel, float *cosines)
{
    const float *const directions[3] = {share->directions[0], share->directions[1],
                                        share->directions[2]};
    Neighbour found[9];
    int n = neighbours_of(share, pixel, found);
    float sums[2] = {0, 0};
    share->kernels->cosines(directions, share->light->places[pixel].normal, SETS * share->stride,
                            cosines);
    for (int i = 0; i < n; i++)
        share->kernels->sum(cosines + found[i].set * share->stride,
                            share->answers + (size_t)found[i].number * (size_t)share->stride,
                            share->stride, found[i].part, sums);
    share->light->open[pixel] = sums[1] > 0 ? sums[0] / (BEAM_FREE * sums[1]) : 1;
}

static void gather_run(size_t index, int worker, void *context)
{
    const Share *share = context;
    size_t end = share->first[SETS], from = index * BEAMS_AT_ONCE;
    for (size_t number = from; number < end && number < from + BEAMS_AT_ONCE; number++)
        gather_open(share, share->pixels[number],
                    share->cosines + (size_t)worker * SETS * (size_t)share->stride);
}

static Status prepare_sky(Share *share, Err *err)
{
    int rays = share->drawing->params->occlusion, workers = share->drawing->params->threads;
    share->asked = 2 * rays < MOST_A_SET ? 2 * rays : MOST_A_SET;
    share->stride = (share->asked + SUMMED - 1) / SUMMED * SUMMED;
    size_t stride = (size_t)share->stride, n = share->first[SETS];
    TRY(mem_calloc(&share->answers, n, stride, "occlusion", err));
    memset(share->answers, BEAM_UNASKED, n * stride);
    for (int c = 0; c < 3; c++)
        TRY(mem_calloc(&share->directions[c], SETS * stride, sizeof(float), "occlusion", err));
    for (int k = 0; k < SETS * share->asked; k++) {
        Vec3 direction = beams_direction(SETS * share->asked, k);
        size_t place = (size_t)(k % SETS) * stride + (size_t)(k / SETS);
        share->directions[0][place] = (float)direction.x;
        share->directions[1][place] = (float)direction.y;
        share->directions[2][place] = (float)direction.z;
    }
    TRY(mem_calloc(&share->cosines, (size_t)workers * SETS * stride, sizeof(float), "occlusion",
                   err));
    return mem_calloc(&share->queries, (size_t)workers, sizeof *share->queries, "occlusion", err);
}

static Status share_sky(Share *share, Err *err)
{
    SharedLight *light = share->light;
    size_t pixels = (size_t)light->width * (size_t)light->rows;
    TRY(mem_calloc(&light->open, pixels, sizeof *light->open, "occlusion", err));
    TRY(prepare_sky(share, err));
    TRY(ask_sky(share, err));
    threads_for((share->first[SETS] + BEAMS_AT_ONCE - 1) / BEAMS_AT_ONCE,
                share->drawing->params->threads, gather_run, share);
    return STATUS_OK;
}

/* ---- area lights ----------------------------------------------------------------------------- */

static bool is_soft(const Light *light)
{
    return light->casts_shadows && light->samples > 1;
}

/* Of the points of an area light, row by row, those of a set lie in its squares of two by two as
 * the pixels of the set do in theirs. */
static bool point_is_of(const Light *light, int point, int set)
{
    return set_of(point % light->samples, point / light->samples) == set;
}

/* How many points of the set reach the place; rays begin a little off the surface, which depths of
 * single precision miss. */
static uint16_t points_seen(const Share *share, const PixelPlace *place, int set, int worker)
{
    const Drawing *drawing = share->drawing;
    const Light *light = &drawing->view->lights[share->number];
    Vec3 normal = {(double)place->normal[0], (double)place->normal[1], (double)place->normal[2]};
    Vec3 at = {(double)place->at[0], (double)place->at[1], (double)place->at[2]};
    Vec3 point = vec3_add(share->light->origin, at);
    uint16_t seen = 0;
    double off = 1e-6 * (vec3_length(at) + vec3_distance(point, drawing->view->camera.location));
    point = vec3_add_scaled(point, normal, off);
    if (vec3_dot(normal, light_way(light, point).towards) < LEAST_LIT_COSINE)
        return 0;
    for (int k = 0; k < light_points(light); k++) {
        if (!point_is_of(light, k, set))
            continue;
        LightWay way = light_way_to_point(light, k, point);
        if (!caster_shadow(drawing->caster, worker, &drawing->view->ground, point, way.towards,
                           way.distance))
            seen++;
    }
    return seen;
}

static void ask_light(size_t index, int worker, void *context)
{
    const Share *share = context;
    int set;
    size_t from, to;
    find_run(share, index, &set, &from, &to);
    for (size_t number = from; number < to; number++)
        share->reach[number] =
            points_seen(share, &share->light->places[share->pixels[number]], set, worker);
}

static void gather_reach(size_t index, int worker, void *context)
{
    (void)worker;
    const Share *share = context;
    const Light *light = &share->drawing->view->lights[share->number];
    size_t end = share->first[SETS], from = index * BEAMS_AT_ONCE;
    for (size_t number = from; number < end && number < from + BEAMS_AT_ONCE; number++) {
        uint32_t pixel = share->pixels[number];
        Neighbour found[9];
        int n = neighbours_of(share, pixel, found);
        float sum = 0, all = 0;
        for (int i = 0; i < n; i++) {
            sum += found[i].part * (float)share->reach[found[i].number];
            all += found[i].part;
        }
        share->light->parts[share->number][pixel] = sum * SETS / (all * (float)light_points(light));
    }
}

static Status share_lights(Share *share, Err *err)
{
    const View *view = share->drawing->view;
    SharedLight *light = share->light;
    size_t n = share->first[SETS], pixels = (size_t)light->width * (size_t)light->rows;
    int threads = share->drawing->params->threads;
    TRY(mem_calloc(&share->reach, n, sizeof *share->reach, "lights", err));
    for (size_t i = 0; i < view->n_lights; i++) {
        if (!is_soft(&view->lights[i]))
            continue;
        TRY(mem_calloc(&light->parts[i], pixels, sizeof *light->parts[i], "lights", err));
        share->number = (int)i;
        threads_for(all_runs(share), threads, ask_light, share);
        threads_for((n + BEAMS_AT_ONCE - 1) / BEAMS_AT_ONCE, threads, gather_reach, share);
    }
    return STATUS_OK;
}

/* ---- all of it ------------------------------------------------------------------------------- */

bool share_is_wanted(const View *view, const RenderParams *params)
{
    bool soft = false;
    for (size_t i = 0; i < view->n_lights; i++)
        soft |= is_soft(&view->lights[i]);
    return params->want_color && params->method != RENDER_TRACE &&
           (params->occlusion > 0 || (params->shadows && soft));
}

static void release(Share *share)
{
    free(share->pixels);
    free(share->numbers);
    free(share->answers);
    for (int c = 0; c < 3; c++)
        free(share->directions[c]);
    free(share->views);
    free(share->failed);
    free(share->cosines);
    free(share->queries);
    free(share->reach);
}

static Status make_places(Share *share, const Frame *planes, Err *err)
{
    SharedLight *light = share->light;
    const Drawing *drawing = share->drawing;
    TRY(mem_calloc(&light->places, (size_t)light->width * (size_t)light->rows,
                   sizeof *light->places, "places", err));
    PlaceJob job = {drawing, planes, light};
    threads_for((size_t)light->rows, drawing->params->threads, find_places, &job);
    return list_pixels(share, err);
}

Status share_light(const Drawing *drawing, const Frame *planes, const Beams *beams,
                   SharedLight **out, Err *err)
{
    const RenderParams *params = drawing->params;
    Share share = {
        .drawing = drawing, .beams = beams, .kernels = beamkernels[kernels_kind(params->kernels)]};
    Status status;
    TRY(mem_calloc(&share.light, 1, sizeof *share.light, "places", err));
    share.light->width = drawing->view->camera.width;
    share.light->first = drawing->band.first;
    share.light->rows = drawing->band.rows;
    share.light->origin =
        params->occlusion > 0 ? beams->origin : box_center(drawing->geometry->bounds);
    TRY_GOTO(make_places(&share, planes, err));
    if (params->occlusion > 0)
        TRY_GOTO(share_sky(&share, err));
    if (params->shadows)
        TRY_GOTO(share_lights(&share, err));
    *out = share.light;
    share.light = NULL;
done:
    sharedlight_free(share.light);
    release(&share);
    return status;
}
