/* Occlusion is found for all places at once [occlusion.c].
 *
 * Of the points of an area light a pixel asks a quarter, that of its set: pixels are of four sets,
 * as they lie in squares of two by two. It takes the answers of the pixels around it that lie on
 * the same surface, in the proportions 1 : 2 : 1 across and down, by which each set has the same
 * weight, so that a plane has the mean of all four, without grain. The points are looked from,
 * those of one set after those of another, as lights are that cast hard shadows. */
#include "render/light/bandvisibility.h"

#include "render/cast/caster.h"
#include "render/light/occlusion.h"
#include "render/light/shade.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rows of a strip, whose planes are forgotten when its places are made; columns and rows of a
 * square; and what threads take at a time: so few that the questions to a set stay in the cache. */
enum { SETS = 4, STRIP = 256, SQUARE = VISIBILITY_BLOCK, PLACES_AT_ONCE = 8192 };

/* In Share.reach: the pixel sees the ground. */
enum { ON_GROUND = 1 << 15, POINTS_SEEN = ON_GROUND - 1 };

/* Numbers from .. to of places of one set. */
typedef struct Run {
    size_t from, to;
    int set;
} Run;

/* Places are numbered strip by strip, in a strip set by set, and in a set square by square of
 * SQUARE x SQUARE pixels, so that those that follow one another ask about the same few tiles of a
 * light. Without area lights all are of set 0, so that neighbours follow one another. */
typedef struct Share {
    const Drawing *drawing;
    const VisibilitySources *from;
    PixelVisibility *light;
    bool is_soft;     /* whether area lights are asked */
    uint32_t *pixels; /* owned; of each number; only where area lights are asked, as `reach` */
    size_t n;         /* numbers */
    Run *runs;        /* owned; at most PLACES_AT_ONCE numbers each */
    size_t n_runs;
    int number;      /* of the light at hand */
    Box asked;       /* about all places, if area lights are asked, from PixelVisibility.origin */
    uint16_t *reach; /* owned; of each pixel, how many points of that it sees, and ON_GROUND; of one
                      * that sees nothing 0 */
} Share;

static size_t squares_in(int pixels)
{
    return ((size_t)pixels + SQUARE - 1) / SQUARE;
}

static int set_of(int column, int row)
{
    return (row & 1) * 2 + (column & 1);
}

/* The set of a pixel of the picture. */
static int set_of_pixel(const Share *share, int column, int row)
{
    return share->is_soft ? set_of(column, row) : 0;
}

/* ---- places ---------------------------------------------------------------------------------- */

/* The places of a strip. */
typedef struct PlaceJob {
    const Share *share;
    int first, rows; /* of the strip, in the band */
    Frame planes;
    double pixel_mm;        /* what a pixel is wide, in perspective at 1 mm */
    uint32_t (*next)[SETS]; /* of each square, the next number of each set */
    Box *boxes;             /* of each square, about its places, from PixelVisibility.origin */
} PlaceJob;

/* The pixels of a square, in the band. */
typedef struct Square {
    int first_column, end_column, first_row, end_row;
} Square;

/* A square of some of the light's rows. */
static Square square_at(const PixelVisibility *light, size_t number, int first, int rows)
{
    size_t across = squares_in(light->width);
    int column = (int)(number % across) * SQUARE;
    int row = first + (int)(number / across) * SQUARE;
    int end_column = column + SQUARE, end_row = row + SQUARE;
    return (Square){column, end_column < light->width ? end_column : light->width, row,
                    end_row < first + rows ? end_row : first + rows};
}

static size_t pixel_at(const PixelVisibility *light, int column, int row)
{
    return (size_t)row * (size_t)light->width + (size_t)column;
}

/* The pixel of the job's planes. */
static size_t plane_pixel(const PlaceJob *job, int column, int row)
{
    return pixel_at(job->share->light, column, row - job->first);
}

/* Lines of sight of a row of pixels, from PixelVisibility.origin: all begin a step apart, or in
 * perspective at one point, and lead a step apart. */
typedef struct SightRow {
    bool perspective;
    Vec3 from, from_step;                        /* that of the first pixel, and a step */
    Vec3 way, way_step;                          /* likewise; in perspective not unit */
    double above, above_step, along, along_step; /* the ground: the same across its normal */
} SightRow;

static SightRow sight_of_row(const Share *share, int row)
{
    const View *view = share->drawing->view;
    const Camera *camera = &view->camera;
    const Ground *ground = &view->ground;
    Vec3 step = vec3_scale(camera->right, 1.0 / camera->width);
    Vec3 first = vec3_add(vec3_scale(camera->right, 0.5 / camera->width - 0.5),
                          vec3_scale(camera->up, 0.5 - (row + 0.5) / camera->height));
    SightRow sight = {.perspective = camera->projection == PROJECTION_PERSPECTIVE,
                      .from = vec3_sub(camera->location, share->light->origin),
                      .way = vec3_normalized(camera->direction)};
    if (sight.perspective) {
        sight.way = vec3_add(camera->direction, first);
        sight.way_step = step;
    } else {
        sight.from = vec3_add(sight.from, first);
        sight.from_step = step;
    }
    sight.above = vec3_dot(ground->normal, vec3_add(sight.from, share->light->origin));
    sight.above -= ground->offset_mm;
    sight.above_step = vec3_dot(ground->normal, sight.from_step);
    sight.along = vec3_dot(ground->normal, sight.way);
    sight.along_step = vec3_dot(ground->normal, sight.way_step);
    return sight;
}

static inline double sight_length(const SightRow *sight, int column)
{
    return sight->perspective ? vec3_length(vec3_add_scaled(sight->way, sight->way_step, column))
                              : 1;
}

/* How far the ground is along a line of sight; infinite where it is not seen. */
static inline double ground_distance(const SightRow *sight, int column)
{
    double length = sight_length(sight, column);
    double along = sight->along + column * sight->along_step;
    double t = -(sight->above + column * sight->above_step) * length / along;
    bool seen = fabs(along) >= 1e-10 * length && t > NEAREST_SEEN_MM && t <= SCENE_FARTHEST_MM;
    return seen ? t : HUGE_VAL;
}

/* Marks the pixels of the square in PixelVisibility.numbers by their SurfaceKind, or NO_HIT, adds
 * the depth of the ground where it is nearest, and counts those that see something. */
static void count_places(size_t number, int worker, void *context)
{
    (void)worker;
    const PlaceJob *job = context;
    const PixelVisibility *light = job->share->light;
    const Square square = square_at(light, number, job->first, job->rows);
    const bool has_ground = job->share->drawing->view->ground.present;
    for (int row = square.first_row; row < square.end_row; row++) {
        const SightRow sight = sight_of_row(job->share, light->first_row + row);
        for (int column = square.first_column; column < square.end_column; column++) {
            float *depth = &job->planes.depth.values[plane_pixel(job, column, row)];
            double t = has_ground ? ground_distance(&sight, column) : HUGE_VAL;
            bool on_ground = t < (double)*depth;
            uint32_t *kind = &light->point_index[pixel_at(light, column, row)];
            *kind = NO_HIT;
            if (!on_ground && !isfinite(*depth))
                continue;
            if (on_ground)
                *depth = (float)t;
            *kind = on_ground ? SURFACE_GROUND : SURFACE_VESSEL;
            job->next[number][set_of_pixel(job->share, column, light->first_row + row)]++;
        }
    }
}

static inline ShadingPoint place_of(const PlaceJob *job, const SightRow *sight, int column, int row)
{
    const PixelVisibility *light = job->share->light;
    const View *view = job->share->drawing->view;
    size_t pixel = plane_pixel(job, column, row);
    double t = (double)job->planes.depth.values[pixel];
    Vec3 from = vec3_add_scaled(sight->from, sight->from_step, column);
    Vec3 way = vec3_add_scaled(sight->way, sight->way_step, column);
    Vec3 at = vec3_add_scaled(from, way, t / sight_length(sight, column));
    ShadingPoint place = {.position = {(float)at.x, (float)at.y, (float)at.z},
                          .pixel_mm =
                              (float)(sight->perspective ? t * job->pixel_mm : job->pixel_mm),
                          .surface = (SurfaceKind)light->point_index[pixel_at(light, column, row)]};
    if (place.surface == SURFACE_VESSEL) {
        memcpy(place.normal, &job->planes.normal.values[3 * pixel], sizeof place.normal);
    } else {
        Vec3 normal = view->ground.normal;
        double turn = sight->along + column * sight->along_step > 0 ? -1 : 1;
        place.normal[0] = (float)(normal.x * turn);
        place.normal[1] = (float)(normal.y * turn);
        place.normal[2] = (float)(normal.z * turn);
    }
    return place;
}

static void set_places(size_t number, int worker, void *context)
{
    (void)worker;
    const PlaceJob *job = context;
    const Share *share = job->share;
    const PixelVisibility *light = share->light;
    const Square square = square_at(light, number, job->first, job->rows);
    Box box = box_empty();
    for (int row = square.first_row; row < square.end_row; row++) {
        const SightRow sight = sight_of_row(share, light->first_row + row);
        for (int column = square.first_column; column < square.end_column; column++) {
            size_t pixel = pixel_at(light, column, row);
            if (share->is_soft)
                share->reach[pixel] = light->point_index[pixel] == SURFACE_GROUND ? ON_GROUND : 0;
            if (light->point_index[pixel] == NO_HIT)
                continue;
            uint32_t to = job->next[number][set_of_pixel(share, column, light->first_row + row)]++;
            light->points[to] = place_of(job, &sight, column, row);
            light->point_index[pixel] = to;
            if (!share->is_soft)
                continue;
            share->pixels[to] = (uint32_t)pixel;
            box = box_with_ball(box, shadingpoint_position(&light->points[to]), 0);
        }
    }
    job->boxes[number] = box;
}

static void add_runs(Share *share, int set, size_t from, size_t end)
{
    for (; from < end; from += PLACES_AT_ONCE) {
        size_t to = end - from < PLACES_AT_ONCE ? end : from + PLACES_AT_ONCE;
        share->runs[share->n_runs++] = (Run){from, to, set};
    }
}

/* Turns counts into first numbers: set by set, square by square. Runs end with a row of squares, so
 * that they are the same in all bands. */
static void number_squares(Share *share, size_t across, size_t rows, uint32_t (*next)[SETS])
{
    for (int set = 0; set < SETS; set++)
        for (size_t row = 0; row < rows; row++) {
            size_t first = share->n;
            for (size_t square = row * across; square < (row + 1) * across; square++) {
                uint32_t count = next[square][set];
                next[square][set] = (uint32_t)share->n;
                share->n += count;
            }
            add_runs(share, set, first, share->n);
        }
}

/* Numbers the places of a strip behind those of the strips above it. */
static Status add_strip(Share *share, PlaceJob *job, Err *err)
{
    Drawing strip = *share->drawing;
    size_t across = squares_in(share->light->width), squares = across * squares_in(job->rows);
    int threads = share->drawing->params->threads;
    strip.band = (Band){.first = share->light->first_row + job->first, .rows = job->rows};
    TRY(share->from->draw_planes(&strip, share->from->context, &job->planes, err));
    memset(job->next, 0, squares * sizeof *job->next);
    threads_for(squares, threads, count_places, job);
    number_squares(share, across, squares_in(job->rows), job->next);
    threads_for(squares, threads, set_places, job);
    for (size_t i = 0; i < squares; i++)
        share->asked = box_union(share->asked, job->boxes[i]);
    return STATUS_OK;
}

/* Room for a place of each pixel, of which what is not used is never touched. */
static Status make_places(Share *share, Err *err)
{
    PixelVisibility *light = share->light;
    size_t pixels = (size_t)light->width * (size_t)light->rows;
    const Camera *camera = &share->drawing->view->camera;
    PlaceJob job = {.share = share, .pixel_mm = pixelvisibility_pixel_mm(camera, 1)};
    Status status;
    TRY(mem_alloc(&light->point_index, pixels, sizeof *light->point_index, "places", err));
    TRY(mem_alloc(&light->points, pixels, sizeof *light->points, "places", err));
    if (share->is_soft) {
        TRY(mem_alloc(&share->pixels, pixels, sizeof *share->pixels, "places", err));
        TRY(mem_alloc(&share->reach, pixels, sizeof *share->reach, "places", err));
    }
    TRY(mem_calloc(&share->runs, SETS * squares_in(light->rows) + pixels / PLACES_AT_ONCE,
                   sizeof *share->runs, "places", err));
    share->asked = box_empty();
    TRY_GOTO(mem_calloc(&job.next, squares_in(light->width) * squares_in(STRIP), sizeof *job.next,
                        "places", err));
    TRY_GOTO(mem_calloc(&job.boxes, squares_in(light->width) * squares_in(STRIP), sizeof *job.boxes,
                        "places", err));
    for (job.first = 0; job.first < light->rows; job.first += STRIP) {
        job.rows = light->rows - job.first < STRIP ? light->rows - job.first : STRIP;
        TRY_GOTO(add_strip(share, &job, err));
        frame_release(&job.planes);
    }
done:
    frame_release(&job.planes);
    free(job.next);
    free(job.boxes);
    return status;
}

/* ---- what neighbours share ------------------------------------------------------------------- */

/* How many points the pixels about one that lie on its surface see, in the proportions 1 : 2 : 1,
 * and the sum of these. */
static int sum_about(const Share *share, int column, int row, int *parts)
{
    const PixelVisibility *light = share->light;
    const ShadingPoint place = light->points[light->point_index[pixel_at(light, column, row)]];
    int first = column > 0 ? column - 1 : 0;
    int last = column + 1 < light->width ? column + 1 : column;
    int sum = 0, weights = 0;
    for (int j = row > 0 ? row - 1 : 0; j <= row + 1 && j < light->rows; j++) {
        const uint32_t *numbers = &light->point_index[pixel_at(light, 0, j)];
        const uint16_t *reach = &share->reach[pixel_at(light, 0, j)];
        for (int i = first; i <= last; i++) {
            if (numbers[i] == NO_HIT ||
                !shadingpoints_share_surface(&place, &light->points[numbers[i]]))
                continue;
            int weight = (i == column ? 2 : 1) * (j == row ? 2 : 1);
            sum += weight * (reach[i] & POINTS_SEEN);
            weights += weight;
        }
    }
    *parts = weights;
    return sum;
}

/* ---- area lights ----------------------------------------------------------------------------- */

/* Of the points of an area light, row by row, those of a set lie in its squares of two by two as
 * the pixels of the set do in theirs. */
static bool point_is_of(const Light *light, int point, int set)
{
    return set_of(point % light->samples, point / light->samples) == set;
}

/* Where a place is, mm from PixelVisibility.origin, a little off the surface, which depths of
 * single precision miss. */
static Vec3 off_surface(const Share *share, const ShadingPoint *place)
{
    Vec3 normal = {(double)place->normal[0], (double)place->normal[1], (double)place->normal[2]};
    Vec3 at = shadingpoint_position(place);
    Vec3 eye = vec3_sub(share->drawing->view->camera.location, share->light->origin);
    Vec3 sight = vec3_sub(at, eye);
    float off = sqrtf((float)vec3_dot(at, at)) + sqrtf((float)vec3_dot(sight, sight));
    return vec3_add_scaled(at, normal, 1e-6 * (double)off);
}

/* Whether the place faces the middle of the light at hand. */
static bool is_facing(const Share *share, const ShadingPoint *place, Vec3 point)
{
    const Light *light = &share->drawing->view->lights[share->number];
    Vec3 normal = {(double)place->normal[0], (double)place->normal[1], (double)place->normal[2]};
    Vec3 towards = vec3_sub(light->location, light->parallel ? light->target : point);
    const double least = MIN_LIT_COSINE * MIN_LIT_COSINE;
    double along = vec3_dot(normal, towards);
    /* In one go, as in shadingpoints_share_surface. */
    return (along > 0) & (along * along >= least * vec3_dot(towards, towards));
}

static void set_reach(const Share *share, size_t number, int seen)
{
    uint16_t *reach = &share->reach[share->pixels[number]];
    *reach = (uint16_t)((*reach & ON_GROUND) | seen);
}

/* How many points of the set reach the place, by rays. */
static int points_seen(const Share *share, const ShadingPoint *place, int set, int worker)
{
    const Drawing *drawing = share->drawing;
    const Light *light = &drawing->view->lights[share->number];
    Vec3 point = vec3_add(share->light->origin, off_surface(share, place));
    int seen = 0;
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
    const Run *run = &share->runs[index];
    for (size_t number = run->from; number < run->to; number++)
        set_reach(share, number,
                  points_seen(share, &share->light->points[number], run->set, worker));
}

/* The points of a set of the light at hand, each looked from, and what the threads ask them. */
typedef struct SetLook {
    const Share *share;
    int set, n_points;
    int *points;    /* owned, as all that follows */
    void **shadows; /* of each point */
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
        const ShadingPoint *place = &share->light->points[from + i];
        Vec3 at = off_surface(share, place);
        places.x[i] = at.x;
        places.y[i] = at.y;
        places.z[i] = at.z;
        wanted |= (uint64_t)is_facing(share, place, vec3_add(share->light->origin, at)) << i;
    }
    for (int k = 0; k < look->n_points; k++)
        share->from->light_views->ask(look->queues[worker * look->n_points + k], kernels, &places,
                                      wanted, answer);
    return wanted;
}

static void look_at_run(size_t index, int worker, void *context)
{
    const SetLook *look = context;
    const Share *share = look->share;
    const Run *run = &share->runs[index];
    uint8_t shadowed[PLACES_AT_ONCE];
    uint16_t hidden[PLACES_AT_ONCE];
    uint64_t wanted[PLACES_AT_ONCE / TILE_SAMPLES];
    size_t n = run->to - run->from;
    if (run->set != look->set)
        return;
    for (size_t i = 0; i < n; i += TILE_SAMPLES)
        wanted[i / TILE_SAMPLES] = ask_places(look, run->from + i, run->to, worker, (uint32_t)i);
    memset(hidden, 0, n * sizeof *hidden);
    for (int k = 0; k < look->n_points; k++) {
        memset(shadowed, 0, n);
        Status status =
            share->from->light_views->answer(look->queues[worker * look->n_points + k],
                                             share->drawing->params->kernels, shadowed, NULL);
        if (status != STATUS_OK)
            look->status[worker] = status;
        for (size_t i = 0; i < n; i++)
            hidden[i] = (uint16_t)(hidden[i] + shadowed[i]);
    }
    for (size_t i = 0; i < n; i++) {
        bool asked = wanted[i / TILE_SAMPLES] >> i % TILE_SAMPLES & 1;
        set_reach(share, run->from + i, asked ? look->n_points - hidden[i] : 0);
    }
}

/* What stopped a worker. */
static Status check_looks(const SetLook *look, Err *err)
{
    for (int i = 0; i < look->share->drawing->params->threads; i++)
        if (look->status[i] != STATUS_OK)
            return err_set(err, look->status[i], "out of memory: no room for soft shadows");
    return STATUS_OK;
}

/* The frame that places are asked about in. */
static Viewpoint frame_of(const Share *share)
{
    return (Viewpoint){
        share->light->origin, {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)}, .perspective = false};
}

/* A view from one point of the set. */
static void look_from_point(size_t index, int worker, void *context)
{
    const SetLook *look = context;
    const Share *share = look->share;
    const Light point =
        light_at_point(&share->drawing->view->lights[share->number], look->points[index]);
    const Viewpoint frame = frame_of(share);
    const Box asked = {vec3_add(share->asked.low, share->light->origin),
                       vec3_add(share->asked.high, share->light->origin)};
    const bool anywhere = share->from->off_pixel || share->n == 0;
    RenderParams alone = *share->drawing->params;
    Drawing drawing = *share->drawing;
    alone.threads = 1;
    drawing.params = &alone;
    Status status = share->from->light_views->look(
        &drawing, &point, &frame, anywhere ? NULL : &asked, &look->shadows[index], NULL);
    if (status != STATUS_OK)
        look->status[worker] = status;
}

/* Looks from the points of the set, for all threads to ask. */
static Status make_looks(SetLook *look, Err *err)
{
    const Share *share = look->share;
    const Light *light = &share->drawing->view->lights[share->number];
    size_t workers = (size_t)share->drawing->params->threads, n = (size_t)light_points(light);
    TRY(mem_calloc(&look->points, n, sizeof *look->points, "lights", err));
    TRY(mem_calloc(&look->shadows, n, sizeof *look->shadows, "lights", err));
    TRY(mem_calloc(&look->status, workers, sizeof *look->status, "lights", err));
    for (int k = 0; k < light_points(light); k++)
        if (point_is_of(light, k, look->set))
            look->points[look->n_points++] = k;
    threads_for((size_t)look->n_points, (int)workers, look_from_point, look);
    TRY(check_looks(look, err));
    n = workers * (size_t)look->n_points;
    TRY(mem_calloc(&look->queues, n, sizeof *look->queues, "lights", err));
    for (size_t i = 0; i < n; i++)
        TRY(share->from->light_views->queue_new(look->shadows[i % (size_t)look->n_points],
                                                share->drawing->hidden, &look->queues[i], err));
    return STATUS_OK;
}

static void release_looks(SetLook *look)
{
    const LightViews *views = look->share->from->light_views;
    size_t workers = (size_t)look->share->drawing->params->threads;
    for (size_t i = 0; look->queues && i < workers * (size_t)look->n_points; i++)
        views->queue_free(look->queues[i]);
    for (int k = 0; look->shadows && k < look->n_points; k++)
        views->free(look->shadows[k]);
    free(look->queues);
    free(look->points);
    free(look->shadows);
    free(look->status);
}

/* Asks the points of the set for the lone places. */
static Status look_at_lone(const SetLook *look, Err *err)
{
    const Share *share = look->share;
    const Viewpoint frame = frame_of(share);
    for (int k = 0; share->from->off_pixel && k < look->n_points; k++)
        TRY(offpixel_query(share->drawing, share->from->light_views, look->shadows[k], &frame,
                           (size_t)share->number, share->from->off_pixel, err));
    return STATUS_OK;
}

static Status look_from_set(const Share *share, int set, Err *err)
{
    SetLook look = {.share = share, .set = set};
    Status status = make_looks(&look, err);
    if (status == STATUS_OK) {
        threads_for(share->n_runs, share->drawing->params->threads, look_at_run, &look);
        status = check_looks(&look, err);
    }
    if (status == STATUS_OK)
        status = look_at_lone(&look, err);
    release_looks(&look);
    return status;
}

/* Sets how many points of the light at hand each place sees. */
static Status find_reach(Share *share, Err *err)
{
    const Drawing *drawing = share->drawing;
    const LightViews *views = share->from->light_views;
    const Light *light = &drawing->view->lights[share->number];
    if (!views || !lightviews_can(views, drawing->geometry, drawing->view, light)) {
        threads_for(share->n_runs, drawing->params->threads, cast_to_light, share);
        if (share->from->off_pixel)
            offpixel_trace(drawing, (size_t)share->number, share->from->off_pixel);
        return STATUS_OK;
    }
    for (int set = 0; set < SETS; set++)
        TRY(look_from_set(share, set, err));
    return STATUS_OK;
}

/* Of each pixel in a row of a square the sum that sum_about adds up, as if the pixel and its eight
 * neighbours all showed one surface, and whether that sum is right: all nine see as many points, or
 * all nine see the ground, which is one surface. */
typedef struct RowSums {
    uint16_t sums[SQUARE];
    uint16_t is_one[SQUARE];
} RowSums;

/* Sets them for n pixels from `at` on, none of which lies at the band's edge. */
static void sum_row(const uint16_t *at, int width, int n, RowSums *row)
{
    const uint16_t *up = at - width, *down = at + width;
    for (int i = 0; i < n; i++) {
        const uint16_t about[3][3] = {{up[i - 1], up[i], up[i + 1]},
                                      {at[i - 1], at[i], at[i + 1]},
                                      {down[i - 1], down[i], down[i + 1]}};
        unsigned differ = 0, all = ON_GROUND, sum = 0;
        for (int k = 0; k < 9; k++) {
            unsigned seen = about[k / 3][k % 3];
            differ |= seen ^ at[i];
            all &= seen;
            sum += (seen & POINTS_SEEN) << (k / 3 % 2 + k % 3 % 2);
        }
        row->sums[i] = (uint16_t)sum;
        row->is_one[i] = (uint16_t)((differ == 0) | (all != 0));
    }
}

/* The part of the light's points that reaches each pixel of a square, by what its neighbours on its
 * surface see of them. */
static void gather_square(size_t index, int worker, void *context)
{
    (void)worker;
    const Share *share = context;
    const PixelVisibility *light = share->light;
    const Square square = square_at(light, index, 0, light->rows);
    const int first = square.first_column > 0 ? square.first_column : 1;
    const int end = square.end_column < light->width ? square.end_column : light->width - 1;
    const float points = (float)light_points(&share->drawing->view->lights[share->number]);
    for (int row = square.first_row; row < square.end_row; row++) {
        bool within = row > 0 && row < light->rows - 1;
        RowSums sums;
        if (within)
            sum_row(&share->reach[pixel_at(light, first, row)], light->width, end - first, &sums);
        for (int column = square.first_column; column < square.end_column; column++) {
            size_t pixel = pixel_at(light, column, row);
            int i = column - first, sum, parts = 16;
            if (light->point_index[pixel] == NO_HIT)
                continue;
            if (within && column >= first && column < end && sums.is_one[i])
                sum = sums.sums[i];
            else
                sum = sum_about(share, column, row, &parts);
            light->lights[share->number][pixel] = (float)(sum * SETS) / ((float)parts * points);
        }
    }
}

static Status share_lights(Share *share, Err *err)
{
    const View *view = share->drawing->view;
    PixelVisibility *light = share->light;
    size_t pixels = (size_t)light->width * (size_t)light->rows;
    int threads = share->drawing->params->threads;
    for (size_t i = 0; i < view->n_lights; i++) {
        if (!light_is_soft(&view->lights[i]))
            continue;
        TRY(mem_alloc(&light->lights[i], pixels, sizeof *light->lights[i], "lights", err));
        share->number = (int)i;
        TRY(find_reach(share, err));
        threads_for(squares_in(light->width) * squares_in(light->rows), threads, gather_square,
                    share);
    }
    return STATUS_OK;
}

/* ---- all of it ------------------------------------------------------------------------------- */

bool pixelvisibility_is_needed(const View *view, const RenderParams *params)
{
    return params->want_color && params->method != RENDER_TRACE &&
           !(view->effects.xray.per_mm > 0) &&
           (params->occlusion > 0 || (params->shadows && view_has_soft_shadows(view)));
}

Status pixelvisibility_compute(const Drawing *drawing, const VisibilitySources *from,
                               PixelVisibility **out, Err *err)
{
    const RenderParams *params = drawing->params;
    Share share = {.drawing = drawing,
                   .from = from,
                   .is_soft = params->shadows && view_has_soft_shadows(drawing->view)};
    Status status;
    TRY(mem_calloc(&share.light, 1, sizeof *share.light, "places", err));
    share.light->samples_per_side = 1;
    share.light->width = drawing->view->camera.width;
    share.light->first_row = drawing->band.first;
    share.light->rows = drawing->band.rows;
    share.light->origin =
        params->occlusion > 0 ? from->occluders->origin : box_center(drawing->geometry->bounds);
    TRY_GOTO(make_places(&share, err));
    if (params->occlusion > 0)
        TRY_GOTO(occlusion_compute(drawing, from->occluders, share.light, err));
    if (share.is_soft)
        TRY_GOTO(share_lights(&share, err));
    *out = share.light;
    share.light = NULL;
done:
    pixelvisibility_free(share.light);
    free(share.pixels);
    free(share.runs);
    free(share.reach);
    return status;
}
