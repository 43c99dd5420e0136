/* The z-buffer engine: draws primitives as dense points with a depth buffer [the method of F.
 * Neumann et al., see N in docs/METHODS.md, section 3]. Nothing is intersected with rays.
 *
 * Each surface is sampled at points that are at most a quarter of a pixel apart along both of its
 * parameters, measured where the primitive is nearest to the camera. Every point of the surface
 * therefore is within half the diagonal of such a square, 0.177 pixels, of a sampled point.
 * Projection does not increase this distance. Only sampled points within 0.177 pixels of the centre
 * of a pixel are used, and the point nearest to the camera is kept. Where a surface covers the
 * centre of a pixel, the pixel therefore receives a point of that surface, and outlines are
 * accurate to 0.177 pixels.
 *
 * A row of tiles is the unit of work of a thread, with its own depth buffer. */
#include "render/engine.h"
#include "render/light/raycolor.h"
#include "render/raster/rasterbins.h"
#include <stdlib.h>

/* Distance of the points, pixels. Half of it takes four times as long, and outlines are twice as
 * accurate. */
static const double spacing_px = 0.25;
/* Maximum distance of a point from the centre of its pixel: just over spacing_px / sqrt 2. */
static const double capture_radius_px = 0.177;

/* The nearest point so far of one pixel. */
typedef struct ZPoint {
    double z; /* depth along the view axis; infinite if the pixel is empty */
    Vec3 normal;
    size_t primitive;
} ZPoint;

typedef struct ZBuffers {
    const Drawing *drawing;
    Frame *frame;
    const RasterBins *bins;
    ZPoint *points; /* per worker: of the pixels of a row of tiles */
} ZBuffers;

/* The state of drawing one primitive into one row of tiles. */
typedef struct ZBrush {
    const RasterView *view;
    ZPoint *points;
    int row; /* first row of pixels of the row of tiles */
    size_t primitive;
    double spacing_mm; /* between points */
} ZBrush;

/* Stores a point in the pixel that it lies in, if it is near the pixel's centre and in front of the
 * stored point. `at` and `normal` are in the frame of the view. */
static void put_point(const ZBrush *brush, Vec3 at, Vec3 normal)
{
    const RasterView *view = brush->view;
    double scale = view->eye.perspective ? 1 / at.z : 1;
    double x = (at.x * scale - view->left) * view->per_x;
    double y = (at.y * scale - view->top) * view->per_y;
    double column = floor(x + 0.5), row = floor(y + 0.5);
    double off_x = x - column, off_y = y - row;
    if (off_x * off_x + off_y * off_y > capture_radius_px * capture_radius_px || column < 0 ||
        column >= view->columns || row < brush->row || row >= brush->row + TILE_SIDE)
        return;
    ZPoint *point =
        &brush->points[(size_t)(row - brush->row) * (size_t)view->columns + (size_t)column];
    if (at.z < point->z)
        *point = (ZPoint){at.z, normal, brush->primitive};
}

/* Returns the number of steps of at most the spacing along a length. */
static int steps_through(const ZBrush *brush, double length)
{
    return (int)ceil(length / brush->spacing_mm) + 1;
}

/* Returns true if a ball may reach into the row of tiles, with a margin of one pixel. */
static bool touches_row(const ZBrush *brush, Vec3 center, double radius)
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

/* Draws points around a circle in the plane of two vectors. `normal` is the normal of all points;
 * NULL: the normals lead away from the centre. */
static void draw_circle(const ZBrush *brush, Vec3 center, const Vec3 plane[2], double radius,
                        int points, const Vec3 *normal)
{
    for (int i = 0; i < points; i++) {
        double angle = FULL_TURN * i / points;
        Vec3 out = vec3_add_scaled(vec3_scale(plane[0], elementary_cos(angle)), plane[1],
                                   elementary_sin(angle));
        put_point(brush, vec3_add_scaled(center, out, radius), normal ? *normal : out);
    }
}

/* Draws the disc of a cylinder's end, except its rim, which belongs to the wall. */
static void draw_disc(const ZBrush *brush, Vec3 center, const Vec3 plane[2], double radius,
                      Vec3 normal)
{
    int rings = steps_through(brush, radius);
    for (int ring = 0; ring < rings && touches_row(brush, center, radius); ring++) {
        double inner = radius * ring / rings;
        draw_circle(brush, center, plane, inner, steps_through(brush, FULL_TURN * inner), &normal);
    }
}

/* Draws circles around the axis, and the discs at both ends. */
static void draw_cylinder(const ZBrush *brush, Vec3 a, Vec3 b, double radius)
{
    Vec3 span = vec3_sub(b, a), axis = vec3_normalized(span), plane[2];
    /* 0.6: the angle between the axis and the other vector is at least 36 degrees. */
    plane[0] =
        vec3_normalized(vec3_cross(axis, fabs(axis.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0)));
    plane[1] = vec3_cross(axis, plane[0]);
    int along = steps_through(brush, vec3_length(span));
    int around = steps_through(brush, FULL_TURN * radius);
    for (int j = 0; j <= along; j++) {
        Vec3 center = vec3_add_scaled(a, span, (double)j / along);
        if (touches_row(brush, center, radius))
            draw_circle(brush, center, plane, radius, around, NULL);
    }
    draw_disc(brush, a, plane, radius, vec3_scale(axis, -1));
    draw_disc(brush, b, plane, radius, axis);
}

/* Draws rings about the z axis of the view. Each ring may extend over the whole height of the
 * sphere, so that rings outside the row are not skipped as in draw_cylinder; put_point drops the
 * points of other rows. */
static void draw_sphere(const ZBrush *brush, Vec3 center, double radius)
{
    int rings = steps_through(brush, PI * radius);
    for (int ring = 0; ring <= rings; ring++) {
        double angle = PI * ring / rings, sine = elementary_sin(angle);
        int points = steps_through(brush, FULL_TURN * radius * sine);
        for (int i = 0; i < points; i++) {
            double turn = FULL_TURN * i / points;
            Vec3 out = {elementary_cos(turn) * sine, elementary_sin(turn) * sine,
                        elementary_cos(angle)};
            put_point(brush, vec3_add_scaled(center, out, radius), out);
        }
    }
}

/* Draws a ruled joint by points of its rulings. The joint's frame is left-handed, as the frame of
 * the view is, so normals point inwards; finish_pixel turns them to the viewer. */
static void draw_joint(const ZBrush *brush, const JointFrame *joint)
{
    double larger = fmax(joint->radius, joint->radius + joint->radius_change);
    double length =
        vec3_length(joint->span) + vec3_length(joint->across_change) + fabs(joint->radius_change);
    int around = steps_through(brush, FULL_TURN * larger);
    int along = steps_through(brush, length);
    for (int i = 0; i < around; i++) {
        double angle = FULL_TURN * i / around, cosine = elementary_cos(angle),
               sine = elementary_sin(angle);
        Vec3 along_ruling = vec3_add_scaled(joint->span, joint->across_change, cosine);
        along_ruling = vec3_add_scaled(along_ruling, joint->side, sine * joint->radius_change);
        for (int j = 0; j <= along; j++) {
            double part = (double)j / along; /* position along the ruling, 0 to 1 */
            Vec3 along_circle =
                vec3_scale(vec3_add_scaled(joint->across, joint->across_change, part), -sine);
            along_circle = vec3_add_scaled(along_circle, joint->side,
                                           cosine * (joint->radius + joint->radius_change * part));
            Vec3 normal = vec3_cross(along_circle, along_ruling);
            double size = vec3_length(normal);
            if (size > 0)
                put_point(brush, joint_point(joint, cosine, sine, part),
                          vec3_scale(normal, 1 / size));
        }
    }
}

/* Draws the points of a primitive, with the spacing that its nearest depth requires. */
static void draw_primitive(const ZBuffers *buffers, const RasterItem *item, ZBrush *brush)
{
    const RasterView *view = brush->view;
    const Primitive *primitive = &buffers->drawing->geometry->primitives[item->primitive];
    double pixel = fmin(view->step_x, -view->step_y);
    /* In perspective, a step s at depth z moves the projected point by up to s sqrt(1 + p^2) / z, p
     * the distance of this point from the view axis at depth 1. At the corner p is largest. The
     * square of the root is used, which is on the safe side. */
    if (view->eye.perspective)
        pixel *= item_nearest(item) / (1 + view->left * view->left + view->top * view->top);
    brush->spacing_mm = pixel * spacing_px;
    brush->primitive = item->primitive;
    Vec3 a = viewpoint_frame_point(&view->eye, primitive->a);
    Vec3 b = viewpoint_frame_point(&view->eye, primitive->b);
    if (primitive->kind == PRIMITIVE_CYLINDER) {
        draw_cylinder(brush, a, b, primitive->radius_mm);
        if (primitive->round_a)
            draw_sphere(brush, a, primitive->radius_mm);
        if (primitive->round_b)
            draw_sphere(brush, b, primitive->radius_mm);
    } else if (primitive->kind == PRIMITIVE_SPHERE) {
        draw_sphere(brush, a, primitive->radius_mm);
    } else {
        const JointFrame joint = rasterview_joint(view, primitive);
        draw_joint(brush, &joint);
    }
}

/* Computes and stores the color, depth, normal and segment of the pixel in column i and row j of
 * the band, the rows that the caller asked for. */
static void finish_pixel(const ZBuffers *buffers, const ZPoint *point, int i, int j, int worker)
{
    const Drawing *drawing = buffers->drawing;
    const RasterView *view = &buffers->bins->view;
    Ray ray = camera_ray(&drawing->view->camera, i, drawing->band.first + j);
    Surfel surfel;
    const bool seen = point->z < HUGE_VAL;
    if (seen) {
        Vec3 normal = viewpoint_world_direction(&view->eye, point->normal);
        bool away = vec3_dot(normal, ray.direction) > 0;
        surfel = (Surfel){.t = point->z / vec3_dot(ray.direction, view->eye.axes[2]),
                          .normal = away ? vec3_scale(normal, -1) : normal,
                          .segment = drawing->geometry->primitives[point->primitive].segment};
    }
    raycolor_store(drawing, worker, i, j, seen ? &surfel : NULL, buffers->frame);
}

/* Draws a row of tiles. */
static Status draw_zbuffer_row(size_t number, int worker, void *context, Err *err)
{
    const ZBuffers *buffers = context;
    const Drawing *drawing = buffers->drawing;
    const RasterBins *bins = buffers->bins;
    const RasterView *view = &bins->view;
    const int width = view->columns, first = drawing->band.first + (int)number * TILE_SIDE;
    const size_t row = (size_t)first / TILE_SIDE;
    ZPoint *points = buffers->points + (size_t)worker * TILE_SIDE * (size_t)width;
    TRY(drawing_progress(drawing, worker, false, number * TILE_SIDE, err));
    for (int i = 0; i < TILE_SIDE * width; i++)
        points[i].z = HUGE_VAL;
    ZBrush brush = {.view = view, .points = points, .row = first};
    for (size_t i = bins->row_offsets[row]; i < bins->row_offsets[row + 1]; i++)
        draw_primitive(buffers, &bins->items[bins->row_items[i]], &brush);
    for (int j = 0; j < tile_extent(view->rows - first); j++)
        for (int i = 0; i < width; i++)
            finish_pixel(buffers, &points[j * width + i], i, first - drawing->band.first + j,
                         worker);
    return STATUS_OK;
}

/* Refuses a camera among the vessels: a primitive that reaches from behind the camera to its front
 * would need infinitely many points. In perspective, the spacing is proportional to the smallest
 * depth, which must be at least 1 % of the primitive's half depth. The primitive then has at most
 * 10^4 times as many points as its middle needs; this factor is the inverse square of the bound. */
static Status check_outside(const RasterBins *bins, Err *err)
{
    for (size_t i = 0; i < bins->row_offsets[bins->tile_rows]; i++) {
        const RasterItem *item = &bins->items[bins->row_items[i]];
        double half_depth = item_half_depth(item);
        if (item->z + half_depth > 0 &&
            item->z - half_depth < (bins->view.eye.perspective ? half_depth * 0.01 : 0))
            return err_set(err, STATUS_USAGE,
                           "`method` zbuffer needs a camera outside the vessels");
    }
    return STATUS_OK;
}

static void release_zbuffer(void *prepared)
{
    rasterbins_free(prepared);
}

static Status prepare_zbuffer(const struct TileEngine *tiles, const Drawing *drawing,
                              void **prepared, Err *err)
{
    (void)tiles;
    Status status;
    RasterBins *bins = NULL;
    /* With antialias 2, primitives are listed in the tiles up to half a pixel beyond their
     * outlines; points are used up to capture_radius_px from the centre of a pixel. */
    RasterView view = rasterview_of_camera(&drawing->view->camera, drawing->geometry->bounds, 2);
    TRY_GOTO(rasterbins_new(drawing->geometry, &view, drawing->params->threads, &bins, err));
    TRY_GOTO(check_outside(bins, err));
    *prepared = bins;
    return STATUS_OK;
done:
    rasterbins_free(bins);
    return status;
}

static Status draw_zbuffer(const Drawing *drawing, void *prepared, Frame *frame, Err *err)
{
    ZBuffers buffers = {.drawing = drawing, .frame = frame, .bins = prepared};
    size_t workers = (size_t)drawing->params->threads;
    TRY(mem_calloc(&buffers.points, workers * TILE_SIDE * (size_t)drawing->view->camera.width,
                   sizeof *buffers.points, "depths", err));
    Status status = threads_try(((size_t)drawing->band.rows + TILE_SIDE - 1) / TILE_SIDE,
                                (int)workers, draw_zbuffer_row, &buffers, err);
    free(buffers.points);
    return status;
}

static bool can_draw_zbuffer(const Drawing *drawing)
{
    return drawing->geometry->n_primitives > 0 && drawing->params->method == RENDER_ZBUFFER &&
           !drawing->params->shadows && !raycolor_is_needed(drawing->view, drawing->params);
}

const Engine zbuffer_engine = {.name = "zbuffer",
                               .supports = can_draw_zbuffer,
                               .prepare = prepare_zbuffer,
                               .rows = draw_zbuffer,
                               .free = release_zbuffer};
