/* Occlusion is found for all places at once [skylight.c].
 *
 * Of the points of an area light a pixel asks a quarter, that of its set: pixels are of four sets,
 * as they lie in squares of two by two. It takes the answers of the pixels around it that lie on
 * the same surface, in the proportions 1 : 2 : 1 across and down, by which each set has the same
 * weight, so that a plane has the mean of all four, without grain. The points are looked from,
 * those of one set after those of another, as lights are that cast hard shadows. */
#include "render/sky/share.h"

#include "render/cast/caster.h"
#include "render/light/shade.h"
#include "render/sky/skylight.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SETS = 4, SQUARE = 32, PLACES_AT_ONCE = 512 };

/* Places are numbered set by set, and in a set square by square of SQUARE x SQUARE pixels, so that
 * those that follow one another ask about the same few tiles of a light. */
typedef struct Share {
    const Drawing *drawing;
    SharedLight *light;
    const LightViews *views; /* NULL: lights are asked by rays */
    uint32_t *pixels;        /* owned; of each number */
    size_t first[SETS + 1];  /* numbers of set i are [first[i], first[i + 1]) */
    int number;              /* of the light at hand */
    uint16_t *reach;         /* owned; of each number, how many points of that it sees */
} Share;

static size_t squares_in(int pixels)
{
    return ((size_t)pixels + SQUARE - 1) / SQUARE;
}

static int set_of(int column, int row)
{
    return (row & 1) * 2 + (column & 1);
}

/* ---- places ---------------------------------------------------------------------------------- */

typedef struct PlaceJob {
    const Share *share;
    Frame *planes;
    uint32_t (*next)[SETS]; /* of each square, the next number of each set */
} PlaceJob;

/* The pixels of a square, in the band. */
typedef struct Square {
    int first_column, end_column, first_row, end_row;
} Square;

static Square square_of(const SharedLight *light, size_t number)
{
    size_t across = squares_in(light->width);
    int column = (int)(number % across) * SQUARE, row = (int)(number / across) * SQUARE;
    int end_column = column + SQUARE, end_row = row + SQUARE;
    return (Square){column, end_column < light->width ? end_column : light->width, row,
                    end_row < light->rows ? end_row : light->rows};
}

/* Marks the pixels of the square that see something in SharedLight.numbers by their PlaceKind, adds
 * the depth of the ground where it is nearest, and counts them. */
static void count_places(size_t number, int worker, void *context)
{
    (void)worker;
    const PlaceJob *job = context;
    const SharedLight *light = job->share->light;
    const View *view = job->share->drawing->view;
    const Square square = square_of(light, number);
    for (int row = square.first_row; row < square.end_row; row++)
        for (int column = square.first_column; column < square.end_column; column++) {
            size_t pixel = (size_t)row * (size_t)light->width + (size_t)column;
            float *depth = &job->planes->depth.values[pixel];
            double t = (double)*depth;
            bool on_ground =
                view->ground.present &&
                ground_hit(&view->ground, camera_ray(&view->camera, column, light->first + row),
                           NEAREST_SEEN_MM, t, &t);
            if (!isfinite(t))
                continue;
            *depth = (float)t;
            light->numbers[pixel] = on_ground ? PLACE_GROUND : PLACE_VESSEL;
            job->next[number][set_of(column, light->first + row)]++;
        }
}

static PixelPlace place_of(const PlaceJob *job, int column, int row)
{
    const SharedLight *light = job->share->light;
    const View *view = job->share->drawing->view;
    size_t pixel = (size_t)row * (size_t)light->width + (size_t)column;
    const float *of_vessel = &job->planes->normal.values[3 * pixel];
    PlaceKind kind = (PlaceKind)light->numbers[pixel];
    double t = (double)job->planes->depth.values[pixel];
    Ray ray = camera_ray(&view->camera, column, light->first + row);
    Vec3 normal = view->ground.normal;
    if (kind == PLACE_VESSEL)
        normal = vec3((double)of_vessel[0], (double)of_vessel[1], (double)of_vessel[2]);
    else if (vec3_dot(normal, ray.direction) > 0)
        normal = vec3_scale(normal, -1);
    return sharedlight_place(light, kind, ray_at(ray, t), normal,
                             sharedlight_pixel_mm(&view->camera, t));
}

static void set_places(size_t number, int worker, void *context)
{
    (void)worker;
    const PlaceJob *job = context;
    const SharedLight *light = job->share->light;
    const Square square = square_of(light, number);
    for (int row = square.first_row; row < square.end_row; row++)
        for (int column = square.first_column; column < square.end_column; column++) {
            size_t pixel = (size_t)row * (size_t)light->width + (size_t)column;
            if (light->numbers[pixel] == PLACE_NONE)
                continue;
            uint32_t to = job->next[number][set_of(column, light->first + row)]++;
            light->places[to] = place_of(job, column, row);
            light->numbers[pixel] = to;
            job->share->pixels[to] = (uint32_t)pixel;
        }
}

/* Turns counts into first numbers: set by set, square by square. */
static void number_squares(Share *share, size_t n, uint32_t (*next)[SETS])
{
    uint32_t taken = 0;
    for (int set = 0; set < SETS; set++) {
        share->first[set] = taken;
        for (size_t square = 0; square < n; square++) {
            uint32_t count = next[square][set];
            next[square][set] = taken;
            taken += count;
        }
    }
    share->first[SETS] = taken;
}

static Status make_places(Share *share, Frame *planes, Err *err)
{
    SharedLight *light = share->light;
    size_t pixels = (size_t)light->width * (size_t)light->rows;
    size_t squares = squares_in(light->width) * squares_in(light->rows);
    int threads = share->drawing->params->threads;
    PlaceJob job = {share, planes, NULL};
    Status status;
    TRY(mem_calloc(&light->numbers, pixels, sizeof *light->numbers, "places", err));
    memset(light->numbers, 0xff, pixels * sizeof *light->numbers); /* PLACE_NONE */
    TRY_GOTO(mem_calloc(&job.next, squares, sizeof *job.next, "places", err));
    threads_for(squares, threads, count_places, &job);
    number_squares(share, squares, job.next);
    size_t n = share->first[SETS];
    TRY_GOTO(mem_calloc(&light->places, n, sizeof *light->places, "places", err));
    TRY_GOTO(mem_calloc(&share->pixels, n, sizeof *share->pixels, "places", err));
    threads_for(squares, threads, set_places, &job);
done:
    free(job.next);
    return status;
}

/* ---- what neighbours share ------------------------------------------------------------------- */

/* Runs of numbers: those of a set are in as many as it takes. */
static size_t runs_of(const Share *share, int set)
{
    return (share->first[set + 1] - share->first[set] + PLACES_AT_ONCE - 1) / PLACES_AT_ONCE;
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
    *from = share->first[*set] + index * PLACES_AT_ONCE;
    *to = share->first[*set + 1];
    *to = *to - *from > PLACES_AT_ONCE ? *from + PLACES_AT_ONCE : *to;
}

/* The place of one of the three by three pixels about another's, on its surface, and its weight. */
typedef struct Neighbour {
    uint32_t number;
    int set, part;
} Neighbour;

static int neighbours_of(const Share *share, uint32_t number, Neighbour found[9])
{
    const SharedLight *light = share->light;
    uint32_t pixel = share->pixels[number];
    int column = (int)(pixel % (uint32_t)light->width), row = (int)(pixel / (uint32_t)light->width);
    int n = 0;
    for (int j = row - 1; j <= row + 1; j++)
        for (int i = column - 1; i <= column + 1; i++) {
            if (i < 0 || i >= light->width || j < 0 || j >= light->rows)
                continue;
            uint32_t other = light->numbers[(size_t)j * (size_t)light->width + (size_t)i];
            if (other != PLACE_NONE &&
                places_are_of_one(&light->places[number], &light->places[other]))
                found[n++] = (Neighbour){other, set_of(i, light->first + j),
                                         (i == column ? 2 : 1) * (j == row ? 2 : 1)};
        }
    return n;
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

/* Where a place is, mm from SharedLight.origin, a little off the surface, which depths of single
 * precision miss. */
static Vec3 off_surface(const Share *share, const PixelPlace *place)
{
    Vec3 normal = {(double)place->normal[0], (double)place->normal[1], (double)place->normal[2]};
    Vec3 at = {(double)place->at[0], (double)place->at[1], (double)place->at[2]};
    Vec3 eye = vec3_sub(share->drawing->view->camera.location, share->light->origin);
    return vec3_add_scaled(at, normal, 1e-6 * (vec3_length(at) + vec3_distance(at, eye)));
}

/* Whether the place faces the middle of the light at hand. */
static bool is_facing(const Share *share, const PixelPlace *place, Vec3 point)
{
    const Light *light = &share->drawing->view->lights[share->number];
    Vec3 normal = {(double)place->normal[0], (double)place->normal[1], (double)place->normal[2]};
    return vec3_dot(normal, light_way(light, point).towards) >= LEAST_LIT_COSINE;
}

/* How many points of the set reach the place, by rays. */
static uint16_t points_seen(const Share *share, const PixelPlace *place, int set, int worker)
{
    const Drawing *drawing = share->drawing;
    const Light *light = &drawing->view->lights[share->number];
    Vec3 point = vec3_add(share->light->origin, off_surface(share, place));
    uint16_t seen = 0;
    if (!is_facing(share, place, point))
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

static void cast_to_light(size_t index, int worker, void *context)
{
    const Share *share = context;
    int set;
    size_t from, to;
    find_run(share, index, &set, &from, &to);
    for (size_t number = from; number < to; number++)
        share->reach[number] = points_seen(share, &share->light->places[number], set, worker);
}

/* The points of a set of the light at hand, each looked from, and what the threads ask them. */
typedef struct SetLook {
    const Share *share;
    int set, n_points;
    void **shadows; /* owned, as all that follows; of each point */
    void **queues;  /* n_points a worker */
    Status *status; /* one a worker */
} SetLook;

/* Asks all points about up to TILE_SAMPLES places from a number on, and returns which, as bits. */
static uint64_t ask_places(const SetLook *look, size_t from, size_t to, int worker, uint32_t answer)
{
    const Share *share = look->share;
    const TileKernels *kernels = tilekernels[kernels_kind(share->drawing->params->kernels)];
    SeenPlaces places = {.x = {0}};
    uint64_t wanted = 0;
    for (size_t i = 0; i < TILE_SAMPLES && from + i < to; i++) {
        const PixelPlace *place = &share->light->places[from + i];
        Vec3 at = off_surface(share, place);
        places.x[i] = at.x;
        places.y[i] = at.y;
        places.z[i] = at.z;
        wanted |= (uint64_t)is_facing(share, place, vec3_add(share->light->origin, at)) << i;
    }
    for (int k = 0; k < look->n_points; k++)
        share->views->ask(look->queues[worker * look->n_points + k], kernels, &places, wanted,
                          answer);
    return wanted;
}

static void look_at_run(size_t index, int worker, void *context)
{
    const SetLook *look = context;
    const Share *share = look->share;
    uint8_t shadowed[LIGHT_MOST_PLACES];
    uint64_t wanted[LIGHT_BATCH];
    size_t from = share->first[look->set] + index * LIGHT_MOST_PLACES;
    size_t to = share->first[look->set + 1], n = to - from;
    n = n < LIGHT_MOST_PLACES ? n : LIGHT_MOST_PLACES;
    for (size_t i = 0; i < n; i += TILE_SAMPLES)
        wanted[i / TILE_SAMPLES] = ask_places(look, from + i, to, worker, (uint32_t)i);
    for (int k = 0; k < look->n_points; k++) {
        memset(shadowed, 0, sizeof shadowed);
        Status status = share->views->answer(look->queues[worker * look->n_points + k],
                                             share->drawing->params->kernels, shadowed, NULL);
        if (status != STATUS_OK)
            look->status[worker] = status;
        for (size_t i = 0; i < n; i++)
            if (wanted[i / TILE_SAMPLES] >> i % TILE_SAMPLES & 1 && !shadowed[i])
                share->reach[from + i]++;
    }
}

/* Looks from the points of the set, for all threads to ask. */
static Status make_looks(SetLook *look, Err *err)
{
    const Share *share = look->share;
    const LightViews *views = share->views;
    const Light *light = &share->drawing->view->lights[share->number];
    const Viewpoint frame = {
        share->light->origin, {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)}, .perspective = false};
    size_t workers = (size_t)share->drawing->params->threads, n = (size_t)light_points(light);
    TRY(mem_calloc(&look->shadows, n, sizeof *look->shadows, "lights", err));
    TRY(mem_calloc(&look->status, workers, sizeof *look->status, "lights", err));
    for (int k = 0; k < light_points(light); k++) {
        const Light point = light_at_point(light, k);
        if (point_is_of(light, k, look->set))
            TRY(views->look(share->drawing, &point, &frame, &look->shadows[look->n_points++], err));
    }
    n = workers * (size_t)look->n_points;
    TRY(mem_calloc(&look->queues, n, sizeof *look->queues, "lights", err));
    for (size_t i = 0; i < n; i++)
        TRY(views->queue_new(look->shadows[i % (size_t)look->n_points], &look->queues[i], err));
    return STATUS_OK;
}

static void release_looks(SetLook *look)
{
    const LightViews *views = look->share->views;
    size_t workers = (size_t)look->share->drawing->params->threads;
    for (size_t i = 0; look->queues && i < workers * (size_t)look->n_points; i++)
        views->queue_free(look->queues[i]);
    for (int k = 0; look->shadows && k < look->n_points; k++)
        views->free(look->shadows[k]);
    free(look->queues);
    free(look->shadows);
    free(look->status);
}

static Status look_from_set(const Share *share, int set, Err *err)
{
    SetLook look = {.share = share, .set = set};
    size_t n = share->first[set + 1] - share->first[set];
    int workers = share->drawing->params->threads;
    Status status = make_looks(&look, err);
    if (status == STATUS_OK)
        threads_for((n + LIGHT_MOST_PLACES - 1) / LIGHT_MOST_PLACES, workers, look_at_run, &look);
    for (int i = 0; i < workers && status == STATUS_OK; i++)
        if (look.status[i] != STATUS_OK)
            status = err_set(err, look.status[i], "out of memory: no room for soft shadows");
    release_looks(&look);
    return status;
}

/* Sets how many points of the light at hand each place sees. */
static Status find_reach(Share *share, Err *err)
{
    const Drawing *drawing = share->drawing;
    const Light *light = &drawing->view->lights[share->number];
    memset(share->reach, 0, share->first[SETS] * sizeof *share->reach);
    if (!share->views || !lightviews_can(share->views, drawing->geometry, drawing->view, light)) {
        threads_for(all_runs(share), drawing->params->threads, cast_to_light, share);
        return STATUS_OK;
    }
    for (int set = 0; set < SETS; set++)
        TRY(look_from_set(share, set, err));
    return STATUS_OK;
}

/* Whether all pixels about the place's, whatever surface they see, see as many points as it. */
static bool is_even(const Share *share, uint32_t number)
{
    const SharedLight *light = share->light;
    uint32_t pixel = share->pixels[number];
    int column = (int)(pixel % (uint32_t)light->width), row = (int)(pixel / (uint32_t)light->width);
    if (column == 0 || column == light->width - 1 || row == 0 || row == light->rows - 1)
        return false;
    const uint32_t *numbers = &light->numbers[pixel];
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            uint32_t other = numbers[j * light->width + i];
            if (other != PLACE_NONE && share->reach[other] != share->reach[number])
                return false;
        }
    return true;
}

/* The part of the light's points that reaches the place, by what its neighbours on its surface see
 * of them. */
static float gather_part(const Share *share, uint32_t number, int points)
{
    Neighbour found[9];
    if (is_even(share, number))
        return (float)(share->reach[number] * SETS) / (float)points;
    int n = neighbours_of(share, number, found);
    int sum = 0, all = 0;
    for (int i = 0; i < n; i++) {
        sum += found[i].part * share->reach[found[i].number];
        all += found[i].part;
    }
    return (float)(sum * SETS) / (float)(all * points);
}

static void gather_reach(size_t index, int worker, void *context)
{
    (void)worker;
    const Share *share = context;
    int points = light_points(&share->drawing->view->lights[share->number]);
    float *parts = share->light->parts[share->number];
    size_t end = share->first[SETS], from = index * PLACES_AT_ONCE;
    for (size_t number = from; number < end && number < from + PLACES_AT_ONCE; number++)
        parts[number] = gather_part(share, (uint32_t)number, points);
}

static Status share_lights(Share *share, Err *err)
{
    const View *view = share->drawing->view;
    SharedLight *light = share->light;
    size_t n = share->first[SETS];
    int threads = share->drawing->params->threads;
    TRY(mem_calloc(&share->reach, n, sizeof *share->reach, "lights", err));
    for (size_t i = 0; i < view->n_lights; i++) {
        if (!is_soft(&view->lights[i]))
            continue;
        TRY(mem_calloc(&light->parts[i], n, sizeof *light->parts[i], "lights", err));
        share->number = (int)i;
        TRY(find_reach(share, err));
        threads_for((n + PLACES_AT_ONCE - 1) / PLACES_AT_ONCE, threads, gather_reach, share);
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
           !(view->effects.xray.per_mm > 0) && (params->occlusion > 0 || (params->shadows && soft));
}

Status share_light(const Drawing *drawing, const LightViews *views, Frame *planes,
                   const Beams *beams, SharedLight **out, Err *err)
{
    const RenderParams *params = drawing->params;
    Share share = {.drawing = drawing, .views = views};
    Status status;
    TRY(mem_calloc(&share.light, 1, sizeof *share.light, "places", err));
    share.light->side = 1;
    share.light->width = drawing->view->camera.width;
    share.light->first = drawing->band.first;
    share.light->rows = drawing->band.rows;
    share.light->origin =
        params->occlusion > 0 ? beams->origin : box_center(drawing->geometry->bounds);
    TRY_GOTO(make_places(&share, planes, err));
    if (params->occlusion > 0)
        TRY_GOTO(skylight_find(drawing, beams, share.pixels, share.first[SETS], share.light, err));
    if (params->shadows)
        TRY_GOTO(share_lights(&share, err));
    *out = share.light;
    share.light = NULL;
done:
    sharedlight_free(share.light);
    free(share.pixels);
    free(share.reach);
    return status;
}
