/* Of primitives the stretches that rays have inside them are found primitive by primitive: a row of
 * samples takes those primitives whose hull, that of two balls, comes near it, and of each only the
 * samples that its outline can reach. What a sample has got is then united, so that overlaps count
 * once. Everything else is crossed from surface to surface by the search for first hits: a stretch
 * ends where the next hit is seen from inside. What is thinner than the least distance at which the
 * search sees (caster.h) does not count. */
#include "render/xray/xray.h"

#include "render/cast/caster.h"
#include "render/planes.h"
#include <math.h>
#include <stdlib.h>

/* The hull of two discs in the plane of the band, in pixels, that hides a primitive. */
typedef struct Shadow {
    double ax, ay, bx, by, radius;
} Shadow;

/* A stretch of the ray of a column. */
typedef struct ColumnStretch {
    int column;
    Stretch stretch;
} ColumnStretch;

/* What one thread works with. */
typedef struct Worker {
    ColumnStretch *found; /* owned, as all that follows: of a row, primitive by primitive */
    Stretch *sorted;      /* the same column by column */
    size_t *first;        /* of each column, and one more */
    size_t n, found_capacity, sorted_capacity;
    Status status;
    Err err;
} Worker;

typedef struct XrayBand {
    const Drawing *drawing;
    Frame *frame;
    Shadow *shadows; /* owned, as all that follows; of each primitive */
    PrimitiveFrame *frames;
    /* Of each strip of STRIP rows: its primitives, items[first[strip] .. first[strip + 1]) */
    size_t *first;
    uint32_t *items;
    Worker *workers;
} XrayBand;

enum { STRIP = 16 };

/* ---- where primitives are -------------------------------------------------------------------- */

/* From the camera's location: right and up in pictures, over the distance in perspective, and
 * ahead. */
static Vec3 seen_from(const Camera *camera, Vec3 point)
{
    Vec3 from = vec3_sub(point, camera->location);
    double right = vec3_dot(from, camera->right) / vec3_dot(camera->right, camera->right);
    double up = vec3_dot(from, camera->up) / vec3_dot(camera->up, camera->up);
    return vec3(right * camera->width, up * camera->height, vec3_dot(from, camera->direction));
}

/* Half the breadth that a ball has at most in the band, whose middle *x becomes, along an axis
 * of it on which it is x pixels off and one mm is `scale` pixels, at the depth z; in perspective
 * for a picture at depth 1. */
static double breadth(double *x, double z, double radius_mm, double scale)
{
    double across = *x / scale, far = elementary_hypot(across, z);
    double angle = elementary_atan2(across, z), half = elementary_asin(fmin(radius_mm / far, 1));
    if (!(fabs(angle) + half < 1.5))
        return HUGE_VAL;
    double low = elementary_tan(angle - half) * scale, high = elementary_tan(angle + half) * scale;
    *x = (low + high) / 2;
    return (high - low) / 2;
}

/* The disc about a ball in the picture: its middle in *x and *y; returns its radius. */
static double disc_about(const Camera *camera, Ball ball, double *x, double *y)
{
    Vec3 seen = seen_from(camera, ball.center);
    double scale_x = camera->width / vec3_length(camera->right);
    double scale_y = camera->height / vec3_length(camera->up), radius;
    *x = seen.x;
    *y = seen.y;
    if (camera->projection == PROJECTION_PERSPECTIVE)
        radius = elementary_hypot(breadth(x, seen.z, ball.radius, scale_x),
                                  breadth(y, seen.z, ball.radius, scale_y));
    else
        radius = ball.radius * fmax(scale_x, scale_y);
    *x += camera->width / 2.0 - 0.5;
    *y = camera->height / 2.0 - 0.5 - *y;
    return radius;
}

static void find_shadow(size_t i, int worker, void *context)
{
    (void)worker;
    XrayBand *band = context;
    const Geometry *geometry = band->drawing->geometry;
    const Camera *camera = &band->drawing->view->camera;
    Shadow *shadow = &band->shadows[i];
    double a = disc_about(camera, geometry_ball(geometry, 2 * i), &shadow->ax, &shadow->ay);
    double b = disc_about(camera, geometry_ball(geometry, 2 * i + 1), &shadow->bx, &shadow->by);
    shadow->radius = fmax(a, b) + 1e-3;
    band->frames[i] = primitive_frame(&geometry->primitives[i]);
}

/* The columns that the shadow may cover in a row: false if none. */
static bool columns_in(const Shadow *shadow, double row, int width, int *first, int *last)
{
    *first = 0;
    *last = width - 1;
    if (!isfinite(shadow->radius))
        return true;
    double low = 0, high = 1, rise = shadow->by - shadow->ay, run = shadow->bx - shadow->ax;
    double r = shadow->radius;
    if (rise != 0) {
        double t0 = (row - r - shadow->ay) / rise, t1 = (row + r - shadow->ay) / rise;
        low = fmax(low, fmin(t0, t1));
        high = fmin(high, fmax(t0, t1));
    } else if (fabs(row - shadow->ay) > r) {
        return false;
    }
    if (!(low <= high))
        return false;
    double x0 = shadow->ax + low * run, x1 = shadow->ax + high * run;
    double left = ceil(fmin(x0, x1) - r), right = floor(fmax(x0, x1) + r);
    *first = (int)fmin(fmax(left, 0), width);
    *last = (int)fmax(fmin(right, width - 1), -1);
    return *first <= *last;
}

/* The strips of the band that the shadow may cover: false if none. */
static bool strips_of(const XrayBand *band, size_t i, size_t *first, size_t *last)
{
    const Shadow *shadow = &band->shadows[i];
    const Band *rows = &band->drawing->band;
    double low = fmin(shadow->ay, shadow->by) - shadow->radius - rows->first;
    double high = fmax(shadow->ay, shadow->by) + shadow->radius - rows->first;
    bool bounded = isfinite(shadow->radius);
    if (bounded && (high < 0 || low > rows->rows - 1))
        return false;
    *first = bounded ? (size_t)fmax(low, 0) / STRIP : 0;
    *last = (size_t)(bounded ? fmin(high, rows->rows - 1) : rows->rows - 1) / STRIP;
    return true;
}

/* Lists the primitives of each strip: counts them, then places them from the last one on. */
static Status make_strips(XrayBand *band, Err *err)
{
    size_t n = ((size_t)band->drawing->band.rows + STRIP - 1) / STRIP, first, last;
    size_t n_primitives = band->drawing->geometry->n_primitives;
    TRY(mem_calloc(&band->first, n + 1, sizeof *band->first, "strips", err));
    for (size_t i = 0; i < n_primitives; i++)
        for (size_t k = strips_of(band, i, &first, &last) ? first : n; k < n && k <= last; k++)
            band->first[k]++;
    for (size_t k = 1; k <= n; k++)
        band->first[k] += band->first[k - 1];
    TRY(mem_calloc(&band->items, band->first[n], sizeof *band->items, "strips", err));
    for (size_t i = n_primitives; i-- > 0;)
        for (size_t k = strips_of(band, i, &first, &last) ? first : n; k < n && k <= last; k++)
            band->items[--band->first[k]] = (uint32_t)i;
    return STATUS_OK;
}

/* ---- rows ------------------------------------------------------------------------------------ */

/* The lengths become light. */
static void store(const XrayBand *band, size_t pixel, double length_mm)
{
    const View *view = band->drawing->view;
    const Xray *xray = &view->effects.xray;
    const Rgb paper = view->background, dark = xray->color;
    double through = elementary_exp(-xray->per_mm * length_mm);
    planes_store_color(band->frame, pixel,
                       (Rgb){(float)((double)dark.r + (double)(paper.r - dark.r) * through),
                             (float)((double)dark.g + (double)(paper.g - dark.g) * through),
                             (float)((double)dark.b + (double)(paper.b - dark.b) * through)});
}

static Status add_primitive(const XrayBand *band, Worker *own, size_t i, int row, Err *err)
{
    const Drawing *drawing = band->drawing;
    int first, last;
    if (!columns_in(&band->shadows[i], row, drawing->view->camera.width, &first, &last))
        return STATUS_OK;
    TRY(mem_reserve(&own->found, &own->found_capacity, own->n + 3 * (size_t)(last - first + 1),
                    sizeof *own->found, "stretches", err));
    for (int column = first; column <= last; column++) {
        Stretch stretches[3];
        int n = primitive_stretches(&drawing->geometry->primitives[i], &band->frames[i],
                                    camera_ray(&drawing->view->camera, column, row), stretches);
        for (int k = 0; k < n; k++)
            own->found[own->n++] = (ColumnStretch){column, stretches[k]};
    }
    return STATUS_OK;
}

/* Sorts what was found by columns. */
static Status sort_columns(Worker *own, int width, Err *err)
{
    TRY(mem_reserve(&own->sorted, &own->sorted_capacity, own->n + 1, sizeof *own->sorted,
                    "stretches", err));
    for (int x = 0; x <= width; x++)
        own->first[x] = 0;
    for (size_t i = 0; i < own->n; i++)
        own->first[own->found[i].column]++;
    for (int x = 1; x <= width; x++)
        own->first[x] += own->first[x - 1];
    for (size_t i = own->n; i-- > 0;)
        own->sorted[--own->first[own->found[i].column]] = own->found[i].stretch;
    return STATUS_OK;
}

static Status draw_primitives(const XrayBand *band, Worker *own, size_t row, Err *err)
{
    const Drawing *drawing = band->drawing;
    int width = drawing->view->camera.width;
    own->n = 0;
    for (size_t i = band->first[row / STRIP]; i < band->first[row / STRIP + 1]; i++)
        TRY(add_primitive(band, own, band->items[i], drawing->band.first + (int)row, err));
    TRY(sort_columns(own, width, err));
    for (int x = 0; x < width; x++)
        store(band, row * (size_t)width + (size_t)x,
              stretches_length(own->sorted + own->first[x], own->first[x + 1] - own->first[x]));
    return STATUS_OK;
}

/* How much of the ray lies inside surfaces, by their crossings. A first one from inside tells that
 * the ray starts there. */
static double length_by_hits(Caster *caster, int worker, Ray ray)
{
    Surfel surfel;
    double length = 0, start = 0, travelled = 0;
    bool inside = true;
    for (Ray rest = ray; caster_first(caster, worker, rest, &surfel);
         rest.origin = ray_at(ray, travelled)) {
        travelled += surfel.t;
        if (surfel.leaves && inside)
            length += travelled - start;
        inside = !surfel.leaves;
        start = travelled;
    }
    return length;
}

static void draw_row(size_t row, int number, void *context)
{
    const XrayBand *band = context;
    const Drawing *drawing = band->drawing;
    const Camera *camera = &drawing->view->camera;
    Worker *own = &band->workers[number];
    if (number == 0)
        band_progress(&drawing->band, drawing->params, camera->height, false,
                      (double)row / drawing->band.rows);
    if (own->status != STATUS_OK)
        return;
    if (model_has(drawing->geometry->model, MODEL_PRIMITIVES)) {
        own->status = draw_primitives(band, own, row, &own->err);
        return;
    }
    for (int x = 0; x < camera->width; x++)
        store(band, row * (size_t)camera->width + (size_t)x,
              length_by_hits(drawing->caster, number,
                             camera_ray(camera, x, drawing->band.first + (int)row)));
}

/* ---- bands ----------------------------------------------------------------------------------- */

static Status make_workers(XrayBand *band, Err *err)
{
    int n = band->drawing->params->threads;
    TRY(mem_calloc(&band->workers, (size_t)n, sizeof *band->workers, "workers", err));
    for (int i = 0; i < n; i++)
        TRY(mem_calloc(&band->workers[i].first, (size_t)band->drawing->view->camera.width + 1,
                       sizeof(size_t), "columns", err));
    return STATUS_OK;
}

static void free_band(XrayBand *band)
{
    for (int i = 0; band->workers && i < band->drawing->params->threads; i++) {
        free(band->workers[i].found);
        free(band->workers[i].sorted);
        free(band->workers[i].first);
    }
    free(band->workers);
    free(band->shadows);
    free(band->frames);
    free(band->first);
    free(band->items);
}

static Status draw_rows(const Drawing *drawing, void *prepared, Frame *frame, Err *err)
{
    (void)prepared;
    const int threads = drawing->params->threads;
    size_t n = drawing->geometry->n_primitives;
    XrayBand band = {.drawing = drawing, .frame = frame};
    Status status;
    TRY_GOTO(mem_calloc(&band.shadows, n, sizeof *band.shadows, "primitives", err));
    TRY_GOTO(mem_calloc(&band.frames, n, sizeof *band.frames, "primitives", err));
    TRY_GOTO(make_workers(&band, err));
    threads_for(n, threads, find_shadow, &band);
    TRY_GOTO(make_strips(&band, err));
    threads_for((size_t)drawing->band.rows, threads, draw_row, &band);
    for (int i = 0; i < threads && status == STATUS_OK; i++) {
        status = band.workers[i].status;
        if (status != STATUS_OK && err)
            *err = band.workers[i].err;
    }
done:
    free_band(&band);
    return status;
}

static bool can(const Drawing *drawing)
{
    return drawing->view->effects.xray.per_mm > 0 && drawing->params->want_color;
}

static bool needs_rays(const Drawing *drawing)
{
    return !model_has(drawing->geometry->model, MODEL_PRIMITIVES);
}

const Engine xray_engine = {
    .name = "xray", .can = can, .needs_rays = needs_rays, .rows = draw_rows};
