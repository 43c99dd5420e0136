/* Every surface is covered with points a quarter of a pixel apart in both of its directions, at
 * the scale of the pixel where the primitive is nearest to the camera. Each point of the surface
 * has one of them within half the diagonal of a cell, 0.177 pixels, and a projection brings them
 * no farther apart. So a point that falls within that distance of a pixel's middle is kept if it
 * is the nearest to the camera there, others are not looked at: where a surface covers the
 * middle of a pixel the pixel has a point of it, and outlines are right to 0.177 pixels.
 *
 * A row of tiles is the unit of work, with a depth buffer of its own. */
#include "render/raster/zbuffer.h"

#include "render/light/raycolor.h"
#include "render/light/shade.h"
#include "render/planes.h"
#include "render/raster/rasterbins.h"
#include <stdlib.h>

static const double pixels_apart = 0.25;
static const double caught = 0.177; /* pixels; just over 0.25 / sqrt 2 */

typedef struct Point {
    double z; /* depth along the view; infinite: nothing */
    Vec3 normal;
    size_t primitive;
} Point;

typedef struct Buffers {
    const Drawing *drawing;
    Frame *frame;
    const RasterBins *bins;
    Point **points; /* one buffer a worker */
} Buffers;

/* What is being drawn of one primitive in one row of tiles. */
typedef struct Brush {
    const RasterView *view;
    Point *points;
    int row; /* pixels above it in the whole picture */
    size_t primitive;
    double apart; /* mm between points */
} Brush;

static void put_point(const Brush *brush, Vec3 at, Vec3 normal)
{
    const RasterView *view = brush->view;
    double scale = view->eye.perspective ? 1 / at.z : 1;
    double x = (at.x * scale - view->left) * view->per_x;
    double y = (at.y * scale - view->top) * view->per_y;
    double column = floor(x + 0.5), row = floor(y + 0.5);
    double off_x = x - column, off_y = y - row;
    if (off_x * off_x + off_y * off_y > caught * caught || column < 0 || column >= view->columns ||
        row < brush->row || row >= brush->row + TILE_SIDE)
        return;
    Point *point =
        &brush->points[(size_t)(row - brush->row) * (size_t)view->columns + (size_t)column];
    if (at.z < point->z)
        *point = (Point){at.z, normal, brush->primitive};
}

/* How many steps lead through a length. */
static int steps_through(const Brush *brush, double length)
{
    return (int)ceil(length / brush->apart) + 1;
}

/* Whether a ball reaches into the row. */
static bool touches_row(const Brush *brush, Vec3 center, double radius)
{
    const RasterView *view = brush->view;
    double low = center.y - radius, high = center.y + radius;
    if (view->eye.perspective) {
        low /= low < 0 ? center.z - radius : center.z + radius;
        high /= high < 0 ? center.z + radius : center.z - radius;
    }
    double above = (high - view->top) * view->per_y, below = (low - view->top) * view->per_y;
    return below >= brush->row - 1 && above <= brush->row + TILE_SIDE;
}

/* Two directions square to an axis and to each other. */
static void square_to(Vec3 axis, Vec3 *e, Vec3 *f)
{
    Vec3 other = fabs(axis.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    *e = vec3_normalized(vec3_cross(axis, other));
    *f = vec3_cross(axis, *e);
}

/* Directions around a circle. */
static Vec3 around(Vec3 e, Vec3 f, int i, int n)
{
    double angle = FULL_TURN * i / n;
    return vec3_add_scaled(vec3_scale(e, elementary_cos(angle)), f, elementary_sin(angle));
}

static void draw_cylinder(const Brush *brush, Vec3 a, Vec3 b, double radius)
{
    Vec3 e, f, span = vec3_sub(b, a), axis = vec3_normalized(span);
    square_to(axis, &e, &f);
    int along = steps_through(brush, vec3_length(span));
    int turn = steps_through(brush, FULL_TURN * radius);
    for (int j = 0; j <= along; j++) {
        Vec3 center = vec3_add_scaled(a, span, (double)j / along);
        for (int i = 0; i < turn && touches_row(brush, center, radius); i++) {
            Vec3 out = around(e, f, i, turn);
            put_point(brush, vec3_add_scaled(center, out, radius), out);
        }
    }
    int rings = steps_through(brush, radius); /* the rim is the wall's */
    for (int end = 0; end < 2; end++) {
        Vec3 center = end ? b : a, normal = vec3_scale(axis, end ? 1 : -1);
        for (int ring = 0; ring < rings && touches_row(brush, center, radius); ring++) {
            double part = radius * ring / rings;
            int points = steps_through(brush, FULL_TURN * part);
            for (int i = 0; i < points; i++)
                put_point(brush, vec3_add_scaled(center, around(e, f, i, points), part), normal);
        }
    }
}

static void draw_sphere(const Brush *brush, Vec3 center, double radius)
{
    int rings = steps_through(brush, PI * radius);
    for (int ring = 0; ring <= rings; ring++) {
        double angle = PI * ring / rings, part = elementary_sin(angle);
        int points = steps_through(brush, FULL_TURN * radius * part);
        for (int i = 0; i < points; i++) {
            Vec3 out = vec3_scale(around(vec3(1, 0, 0), vec3(0, 1, 0), i, points), part);
            out.z = elementary_cos(angle);
            put_point(brush, vec3_add_scaled(center, out, radius), out);
        }
    }
}

/* The frame of the view is left-handed and so is the joint in it: its normal points inwards,
 * which does not matter as it is turned to face the viewer. */
static void draw_joint(const Brush *brush, const JointFrame *joint)
{
    double larger = fmax(joint->radius, joint->radius + joint->radius_change);
    double length =
        vec3_length(joint->span) + vec3_length(joint->across_change) + fabs(joint->radius_change);
    int turn = steps_through(brush, FULL_TURN * larger);
    int along = steps_through(brush, length);
    for (int i = 0; i < turn; i++) {
        double angle = FULL_TURN * i / turn, cosine = elementary_cos(angle),
               sine = elementary_sin(angle);
        Vec3 run = vec3_add_scaled(joint->span, joint->across_change, cosine);
        run = vec3_add_scaled(run, joint->side, sine * joint->radius_change);
        for (int j = 0; j <= along; j++) {
            double l = (double)j / along;
            Vec3 way = vec3_scale(vec3_add_scaled(joint->across, joint->across_change, l), -sine);
            way = vec3_add_scaled(way, joint->side,
                                  cosine * (joint->radius + joint->radius_change * l));
            Vec3 normal = vec3_cross(way, run);
            double size = vec3_length(normal);
            if (size > 0)
                put_point(brush, joint_point(joint, cosine, sine, l), vec3_scale(normal, 1 / size));
        }
    }
}

static void draw_primitive(const Buffers *buffers, const RasterItem *item, Brush *brush)
{
    const RasterView *view = brush->view;
    const Primitive *primitive = &buffers->drawing->geometry->primitives[item->primitive];
    double pixel = fmin(view->step_x, -view->step_y);
    if (view->eye.perspective) /* a step across a slanting line of sight is foreshortened */
        pixel *= item_nearest(item) / (1 + view->left * view->left + view->top * view->top);
    brush->apart = pixel * pixels_apart;
    brush->primitive = item->primitive;
    Vec3 a = viewpoint_place(&view->eye, primitive->a);
    Vec3 b = viewpoint_place(&view->eye, primitive->b);
    if (primitive->kind == PRIMITIVE_CYLINDER) {
        draw_cylinder(brush, a, b, primitive->radius_mm);
        if (primitive->round_a)
            draw_sphere(brush, a, primitive->radius_mm);
        if (primitive->round_b)
            draw_sphere(brush, b, primitive->radius_mm);
    } else if (primitive->kind == PRIMITIVE_SPHERE) {
        draw_sphere(brush, a, primitive->radius_mm);
    } else {
        JointFrame joint = primitive_joint(primitive);
        joint.base = a;
        joint.span = viewpoint_to_frame(&view->eye, joint.span);
        joint.side = viewpoint_to_frame(&view->eye, joint.side);
        joint.across = viewpoint_to_frame(&view->eye, joint.across);
        joint.across_change = viewpoint_to_frame(&view->eye, joint.across_change);
        draw_joint(brush, &joint);
    }
}

/* Depth, normal, id and colour of a pixel. */
static void finish_pixel(const Buffers *buffers, const Point *point, int i, int j)
{
    const Drawing *drawing = buffers->drawing;
    const Geometry *geometry = drawing->geometry;
    const Camera *camera = &drawing->view->camera;
    const RasterView *view = &buffers->bins->view;
    Frame *frame = buffers->frame;
    size_t pixel = (size_t)j * (size_t)camera->width + (size_t)i;
    bool seen = point->z < HUGE_VAL;
    Ray ray = camera_ray(camera, i, drawing->band.first + j);
    double t = seen ? point->z / vec3_dot(ray.direction, view->eye.axes[2]) : HUGE_VAL;
    Vec3 normal = seen ? viewpoint_to_world(&view->eye, point->normal) : vec3(0, 0, 0);
    if (vec3_dot(normal, ray.direction) > 0)
        normal = vec3_scale(normal, -1);
    uint32_t segment = seen ? geometry->primitives[point->primitive].segment : 0;
    planes_store(frame, pixel, t, normal, seen ? geometry->ids[segment] : 0);
    if (!frame->color.values)
        return;
    Rgb color = drawing->view->background;
    if (seen) {
        const ShadingInput at = {.finish = &drawing->appearance->finish,
                                 .pigment = appearance_color(drawing->appearance, segment),
                                 .point = ray_at(ray, t),
                                 .normal = normal,
                                 .direction = ray.direction,
                                 .open = 1};
        color = shade(drawing->view, &at, NULL, NULL);
    }
    planes_store_color(frame, pixel, color);
}

static void draw_row(size_t number, int worker, void *context)
{
    const Buffers *buffers = context;
    const Drawing *drawing = buffers->drawing;
    const RasterBins *bins = buffers->bins;
    const RasterView *view = &bins->view;
    Point *points = buffers->points[worker];
    int first = drawing->band.first + (int)number * TILE_SIDE;
    size_t row = (size_t)first / TILE_SIDE;
    if (worker == 0)
        band_progress(&drawing->band, drawing->params, view->rows, false,
                      (double)number * TILE_SIDE / drawing->band.rows);
    for (int i = 0; i < TILE_SIDE * view->columns; i++)
        points[i].z = HUGE_VAL;
    Brush brush = {.view = view, .points = points, .row = first};
    for (size_t i = bins->row_offsets[row]; i < bins->row_offsets[row + 1]; i++)
        draw_primitive(buffers, &bins->items[bins->row_items[i]], &brush);
    for (int j = 0; j < tile_extent(view->rows - first); j++)
        for (int i = 0; i < view->columns; i++)
            finish_pixel(buffers, &points[j * view->columns + i], i,
                         first - drawing->band.first + j);
}

static Status check_outside(const RasterBins *bins, Err *err)
{
    for (size_t i = 0; i < bins->row_offsets[bins->tile_rows]; i++) {
        const RasterItem *item = &bins->items[bins->row_items[i]];
        double deep = item_depth(item);
        if (item->z + deep > 0 && item->z - deep < (bins->view.eye.perspective ? deep * 0.01 : 0))
            return err_set(err, STATUS_USAGE,
                           "`method` zbuffer needs a camera that is not among the vessels");
    }
    return STATUS_OK;
}

static void release_bins(void *prepared)
{
    rasterbins_free(prepared);
}

static Status prepare(const Drawing *drawing, void **prepared, Err *err)
{
    RasterBins *bins;
    /* Points up to half a pixel off are caught. */
    RasterView view = rasterview_of_camera(&drawing->view->camera, drawing->geometry->bounds, 2);
    TRY(rasterbins_new(drawing->geometry, &view, drawing->params->threads, &bins, err));
    Status status = check_outside(bins, err);
    if (status == STATUS_OK)
        *prepared = bins;
    else
        rasterbins_free(bins);
    return status;
}

static Status draw_rows(const Drawing *drawing, void *prepared, Frame *frame, Err *err)
{
    Status status;
    Buffers buffers = {.drawing = drawing, .frame = frame, .bins = prepared};
    int workers = drawing->params->threads;
    size_t n = (size_t)TILE_SIDE * (size_t)drawing->view->camera.width;
    TRY_GOTO(mem_calloc(&buffers.points, (size_t)workers, sizeof *buffers.points, "rows", err));
    for (int i = 0; i < workers; i++)
        TRY_GOTO(mem_calloc(&buffers.points[i], n, sizeof *buffers.points[i], "depths", err));
    threads_for(((size_t)drawing->band.rows + TILE_SIDE - 1) / TILE_SIDE, workers, draw_row,
                &buffers);
done:
    for (int i = 0; buffers.points && i < workers; i++)
        free(buffers.points[i]);
    free(buffers.points);
    return status;
}

static bool can_draw(const Drawing *drawing)
{
    return drawing->geometry->n_primitives > 0 && drawing->params->method == RENDER_ZBUFFER &&
           !raycolor_is_needed(drawing->view, drawing->params);
}

static bool never(const Drawing *drawing)
{
    (void)drawing;
    return false;
}

const Engine zbuffer_engine = {.name = "zbuffer",
                               .can = can_draw,
                               .needs_rays = never,
                               .prepare = prepare,
                               .rows = draw_rows,
                               .free = release_bins};
