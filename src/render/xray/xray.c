/* The x-ray engine: the color of a pixel follows from the length of its ray inside vessels, by the
 * law of Beer and Lambert.
 *
 * Primitives are processed row by row of pixels. The projection of a primitive lies in the convex
 * hull of two discs of the picture, and only the pixels of this hull are intersected with the
 * primitive. The stretches (intervals of a ray inside a primitive) of each pixel are then united,
 * so that overlaps count once.
 *
 * Other models are crossed from surface to surface by the search for first hits: a stretch ends
 * where the next hit is seen from inside. A stretch that is shorter than caster_nearest_mm does not
 * count. */
#include "render/xray/xray.h"

#include "render/cast/caster.h"
#include "render/engine.h"
#include "render/planes.h"
#include <math.h>
#include <stdlib.h>

/* The convex hull of two discs of equal radius, in pixels of the picture, that contains the
 * projection of a primitive. */
typedef struct XrayHull {
    double ax, ay, bx, by, radius;
} XrayHull;

/* The workspace of one thread: the stretches of a row. */
typedef struct XrayRow {
    ARRAY(RayInterval) found;  /* primitive by primitive */
    ARRAY(uint32_t) column;    /* per stretch found */
    IndexLists by_column;      /* indices of the stretches of each column */
    ARRAY(RayInterval) sorted; /* the stretches of one column */
} XrayRow;

/* All arrays are owned. */
typedef struct XrayBand {
    const Drawing *drawing;
    Frame *frame;
    XrayHull *hulls;        /* per primitive */
    PrimitiveFrame *frames; /* per primitive */
    IndexLists strips;      /* per strip of STRIP rows: the primitives that it may show */
    XrayRow *rows;          /* per worker */
} XrayBand;

/* Rows of pixels of a strip, for which the primitives are listed. Fewer rows list each primitive
 * more often, more rows test more primitives in vain; the picture does not depend on it. */
enum { STRIP = 16 };

/* ---- where primitives are -------------------------------------------------------------------- */

/* Returns a point relative to the camera's location: x to the right and y up, in pixels (at depth 1
 * in perspective), and z ahead, in mm. */
static Vec3 seen_from(const Camera *camera, Vec3 point)
{
    Vec3 from = vec3_sub(point, camera->location);
    double right = vec3_dot(from, camera->right) / vec3_dot(camera->right, camera->right);
    double up = vec3_dot(from, camera->up) / vec3_dot(camera->up, camera->up);
    return vec3(right * camera->width, up * camera->height, vec3_dot(from, camera->direction));
}

/* Returns half the extent of a ball along one axis of the picture of a perspective camera, and
 * moves *x to the middle of the extent. The picture is at depth 1. Returns infinity if the ball may
 * reach beside or behind the camera: farther than 1.5 radians from the view axis.
 *
 * x        position of the ball's center on this axis, pixels.
 * z        its depth, mm.
 * scale    pixels per mm at depth 1. */
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

/* Returns the radius, in pixels, of a disc that contains the projection of a ball, and sets its
 * center. */
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

/* Sets the hull and the frame of primitive i. */
static void find_hull(size_t i, int worker, void *context)
{
    (void)worker;
    XrayBand *band = context;
    const Geometry *geometry = band->drawing->geometry;
    const Camera *camera = &band->drawing->view->camera;
    XrayHull *hull = &band->hulls[i];
    double a = disc_about(camera, geometry_ball(geometry, 2 * i), &hull->ax, &hull->ay);
    double b = disc_about(camera, geometry_ball(geometry, 2 * i + 1), &hull->bx, &hull->by);
    hull->radius = fmax(a, b) + 1e-3; /* pixels: a margin for rounding */
    band->frames[i] = primitive_frame(&geometry->primitives[i]);
}

/* Finds the columns that the hull may cover in a row. Returns false if there is none. */
static bool columns_in(const XrayHull *hull, double row, int width, int *first, int *last)
{
    *first = 0;
    *last = width - 1;
    if (!isfinite(hull->radius))
        return true;
    double low = 0, high = 1, rise = hull->by - hull->ay, run = hull->bx - hull->ax;
    double r = hull->radius;
    if (rise != 0) {
        double t0 = (row - r - hull->ay) / rise, t1 = (row + r - hull->ay) / rise;
        low = fmax(low, fmin(t0, t1));
        high = fmin(high, fmax(t0, t1));
    } else if (fabs(row - hull->ay) > r) {
        return false;
    }
    if (!(low <= high))
        return false;
    double x0 = hull->ax + low * run, x1 = hull->ax + high * run;
    double left = ceil(fmin(x0, x1) - r), right = floor(fmax(x0, x1) + r);
    *first = (int)fmin(fmax(left, 0), width);
    *last = (int)fmax(fmin(right, width - 1), -1);
    return *first <= *last;
}

/* Finds the strips of the band that the hull of primitive i may cover. Returns false if there is
 * none. */
static bool strips_of(const XrayBand *band, size_t i, size_t *first, size_t *last)
{
    const XrayHull *hull = &band->hulls[i];
    const Band *rows = &band->drawing->band;
    double low = fmin(hull->ay, hull->by) - hull->radius - rows->first;
    double high = fmax(hull->ay, hull->by) + hull->radius - rows->first;
    bool bounded = isfinite(hull->radius);
    if (bounded && (high < 0 || low > rows->rows - 1))
        return false;
    *first = bounded ? (size_t)fmax(low, 0) / STRIP : 0;
    *last = (size_t)(bounded ? fmin(high, rows->rows - 1) : rows->rows - 1) / STRIP;
    return true;
}

/* Lists the primitives of each strip of rows: counts them, allocates the lists, then fills them. */
static Status make_strips(XrayBand *band, Err *err)
{
    const size_t n = ((size_t)band->drawing->band.rows + STRIP - 1) / STRIP;
    const size_t n_primitives = band->drawing->geometry->n_primitives;
    size_t first, last;
    TRY(indexlists_begin(&band->strips, n, "strips", err));
    for (size_t i = 0; i < n_primitives; i++)
        for (size_t k = strips_of(band, i, &first, &last) ? first : n; k < n && k <= last; k++)
            indexlists_count(&band->strips, k);
    TRY(indexlists_allot(&band->strips, "strips", err));
    for (size_t i = 0; i < n_primitives; i++)
        for (size_t k = strips_of(band, i, &first, &last) ? first : n; k < n && k <= last; k++)
            indexlists_put(&band->strips, k, (uint32_t)i);
    return STATUS_OK;
}

/* ---- rows ------------------------------------------------------------------------------------ */

/* Stores the color of a pixel whose ray has this length inside vessels: the part exp(-per_mm
 * length) of the background shines through. */
static void store_color(const XrayBand *band, size_t pixel, double length_mm)
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

/* Adds the stretches of primitive i in a row of pixels: up to three per pixel. */
static Status add_primitive(const XrayBand *band, XrayRow *own, size_t i, int row, Err *err)
{
    const Drawing *drawing = band->drawing;
    int first, last;
    if (!columns_in(&band->hulls[i], row, drawing->view->camera.width, &first, &last))
        return STATUS_OK;
    TRY(ARRAY_RESERVE(&own->found, 3 * (size_t)(last - first + 1), "stretches", err));
    TRY(ARRAY_RESERVE(&own->column, 3 * (size_t)(last - first + 1), "stretches", err));
    for (int column = first; column <= last; column++) {
        int n = primitive_inside(&drawing->geometry->primitives[i], &band->frames[i],
                                 camera_ray(&drawing->view->camera, column, row),
                                 own->found.items + own->found.n);
        own->found.n += (size_t)n;
        for (int k = 0; k < n; k++)
            own->column.items[own->column.n++] = (uint32_t)column;
    }
    return STATUS_OK;
}

/* Sorts the stretches of a row by columns, and stores the colors. */
static Status store_columns(const XrayBand *band, XrayRow *own, size_t row, Err *err)
{
    const size_t width = (size_t)band->drawing->view->camera.width;
    const ItemKeys columns = {own->column.items, own->column.n, 1};
    TRY(indexlists_sort(&own->by_column, width, columns, "stretches", err));
    own->sorted.n = 0;
    TRY(ARRAY_RESERVE(&own->sorted, own->found.n, "stretches", err));
    for (size_t x = 0; x < width; x++) {
        const uint32_t *list = own->by_column.items + own->by_column.first[x];
        const size_t n = indexlists_length(&own->by_column, x);
        for (size_t k = 0; k < n; k++)
            own->sorted.items[k] = own->found.items[list[k]];
        store_color(band, row * width + x, intervals_length(own->sorted.items, n));
    }
    return STATUS_OK;
}

/* Draws a row by the primitives of its strip: finds the stretches of each column within vessels,
 * and stores the colors of their lengths. */
static Status draw_primitives(const XrayBand *band, XrayRow *own, size_t row, Err *err)
{
    const uint32_t *range = &band->strips.first[row / STRIP];
    own->found.n = own->column.n = 0;
    for (uint32_t i = range[0]; i < range[1]; i++)
        TRY(add_primitive(band, own, band->strips.items[i], band->drawing->band.first + (int)row,
                          err));
    return store_columns(band, own, row, err);
}

/* Returns the length of the ray inside surfaces, from its crossings. If the first crossing is from
 * inside, the ray starts inside. */
static double length_by_hits(Caster *caster, int worker, Ray ray)
{
    Surfel surfel;
    double length = 0, start = 0, travelled = 0;
    bool inside = true;
    for (Ray rest = ray; caster_first(caster, worker, rest, &surfel);
         rest.origin = ray_at(ray, travelled)) {
        travelled += surfel.t;
        if (surfel.from_inside && inside)
            length += travelled - start;
        inside = !surfel.from_inside;
        start = travelled;
    }
    return length;
}

/* Draws a row. Models without primitives have no closed form of the length; their rays are traced
 * from hit to hit. Called in parallel. */
static Status draw_row(size_t row, int worker, void *context, Err *err)
{
    const XrayBand *band = context;
    const Drawing *drawing = band->drawing;
    const Camera *camera = &drawing->view->camera;
    TRY(drawing_progress(drawing, worker, false, row, err));
    if (model_has(drawing->geometry->model, MODEL_PRIMITIVES))
        return draw_primitives(band, &band->rows[worker], row, err);
    for (int x = 0; x < camera->width; x++)
        store_color(band, row * (size_t)camera->width + (size_t)x,
                    length_by_hits(drawing->caster, worker,
                                   camera_ray(camera, x, drawing->band.first + (int)row)));
    return STATUS_OK;
}

static void release_band(XrayBand *band)
{
    for (int i = 0; band->rows && i < band->drawing->params->threads; i++) {
        ARRAY_RELEASE(&band->rows[i].found);
        ARRAY_RELEASE(&band->rows[i].column);
        ARRAY_RELEASE(&band->rows[i].sorted);
        indexlists_release(&band->rows[i].by_column);
    }
    free(band->rows);
    free(band->hulls);
    free(band->frames);
    indexlists_release(&band->strips);
}

static Status draw_rows(const Drawing *drawing, void *prepared, Frame *frame, Err *err)
{
    (void)prepared;
    const int threads = drawing->params->threads;
    const size_t n = drawing->geometry->n_primitives;
    XrayBand band = {.drawing = drawing, .frame = frame};
    Status status;
    TRY_GOTO(mem_calloc(&band.hulls, n, sizeof *band.hulls, "primitives", err));
    TRY_GOTO(mem_calloc(&band.frames, n, sizeof *band.frames, "primitives", err));
    TRY_GOTO(mem_calloc(&band.rows, (size_t)threads, sizeof *band.rows, "workers", err));
    threads_for(n, threads, find_hull, &band);
    TRY_GOTO(make_strips(&band, err));
    TRY_GOTO(threads_try((size_t)drawing->band.rows, threads, draw_row, &band, err));
done:
    release_band(&band);
    return status;
}

static bool supports_xray(const Drawing *drawing)
{
    return drawing->view->effects.xray.per_mm > 0 && drawing->params->want_color;
}

static bool needs_rays(const Drawing *drawing)
{
    return !model_has(drawing->geometry->model, MODEL_PRIMITIVES);
}

const Engine xray_engine = {
    .name = "xray", .supports = supports_xray, .needs_rays = needs_rays, .rows = draw_rows};
