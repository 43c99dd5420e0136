/* Where the camera stands. A picture that frames the tree holds the ball of every node exactly; the
 * distance of an orthographic camera changes nothing but the depths it reports, so it stands one
 * diagonal of the tree's box in front of its centre. */
#include "stage/framing.h"

static const double degrees_pi = 3.14159265358979323846 / 180;

void view_axes(NamedView view, Vec3 *direction, Vec3 *up)
{
    static const struct {
        Vec3 direction, up;
    } axes[] = {
        [VIEW_FRONT] = {{0, 0, -1}, {0, 1, 0}},
        [VIEW_TOP] = {{0, -1, 0}, {0, 0, -1}},
        [VIEW_LEFT] = {{1, 0, 0}, {0, 1, 0}},
        [VIEW_ISO] = {{-1, -1, -1}, {0, 1, 0}},
    };
    *direction = vec3_normalized(axes[view].direction);
    *up = axes[view].up;
}

/* Right and up of unit length, square to the direction. */
static Status camera_axes(const ViewParams *params, Vec3 center, Vec3 *direction, Vec3 *right,
                          Vec3 *up, Err *err)
{
    Vec3 sky;
    view_axes(params->view, direction, &sky);
    if (params->has_location) {
        Vec3 target = params->has_look_at ? params->look_at : center;
        Vec3 span = vec3_sub(target, params->location);
        if (!isfinite(vec3_length(span)))
            return err_set(err, STATUS_USAGE,
                           "`location` and `look_at` (%s) are farther apart than 1e150 mm",
                           params->has_look_at ? "given" : "the middle of the tree");
        if (!(vec3_length(span) > 0))
            return err_set(err, STATUS_USAGE,
                           "`location` and `look_at` are the same point, so the camera has no "
                           "direction; give two different points");
        *direction = vec3_normalized(span);
        sky = vec3(0, 1, 0);
    }
    if (params->has_up)
        sky = params->up;
    Vec3 across = vec3_cross(*direction, sky);
    if (!(vec3_length(across) > 1e-9 * vec3_length(sky)) && !params->has_up) {
        sky = vec3(0, 0, -1); /* looking along the y axis */
        across = vec3_cross(*direction, sky);
    }
    if (!(vec3_length(across) > 1e-9 * vec3_length(sky)))
        return err_set(err, STATUS_USAGE,
                       "`up` points along the camera's direction; give a vector that does not");
    *right = vec3_normalized(across);
    *up = vec3_cross(*right, *direction);
    return STATUS_OK;
}

Status framing_balls(const Geometry *geometry, Ball **balls, size_t *n, Err *err)
{
    size_t count = 0;
    Ball *made;
    TRY(mem_calloc(&made, 2 * (geometry->n_primitives + geometry->n_segments), sizeof *made,
                   "balls", err));
    for (size_t i = 0; i < geometry->n_primitives; i++) {
        const Primitive *primitive = &geometry->primitives[i];
        bool joint = primitive->kind == PRIMITIVE_JOINT;
        made[count++] = (Ball){primitive->a, primitive->radius_mm};
        made[count++] = (Ball){primitive->b, joint ? primitive->radius_b_mm : primitive->radius_mm};
    }
    for (size_t i = 0; i < geometry->n_segments; i++) {
        const FieldSegment *segment = &geometry->segments[i];
        made[count++] = (Ball){segment->a, 2 * segment->radius_mm};
        made[count++] = (Ball){segment->b, 2 * segment->radius_mm};
    }
    *balls = made;
    *n = count;
    return STATUS_OK;
}

typedef struct Extent {
    double low_x, high_x, low_y, high_y;
} Extent;

static Extent extent_along(const Ball *balls, size_t n, Vec3 right, Vec3 up)
{
    Extent extent = {INFINITY, -INFINITY, INFINITY, -INFINITY};
    for (size_t i = 0; i < n; i++) {
        double x = vec3_dot(balls[i].center, right), y = vec3_dot(balls[i].center, up);
        extent.low_x = fmin(extent.low_x, x - balls[i].radius);
        extent.high_x = fmax(extent.high_x, x + balls[i].radius);
        extent.low_y = fmin(extent.low_y, y - balls[i].radius);
        extent.high_y = fmax(extent.high_y, y + balls[i].radius);
    }
    return extent;
}

/* The least distance from `center`, against the direction, at which a pinhole whose half-width and
 * half-height at unit distance are tan_x and tan_y sees every ball whole. */
static double framing_distance(const Ball *balls, size_t n, Vec3 center, Vec3 direction, Vec3 right,
                               Vec3 up, double tan_x, double tan_y)
{
    double slant_x = sqrt(1 + tan_x * tan_x), slant_y = sqrt(1 + tan_y * tan_y);
    double distance = 0;
    for (size_t i = 0; i < n; i++) {
        Vec3 from = vec3_sub(balls[i].center, center);
        double towards = -vec3_dot(from, direction), r = balls[i].radius;
        double wide = (fabs(vec3_dot(from, right)) + r * slant_x) / tan_x;
        double high = (fabs(vec3_dot(from, up)) + r * slant_y) / tan_y;
        distance = fmax(distance, towards + fmax(wide, high));
    }
    return distance;
}

Status framing_camera(const Ball *balls, size_t n, Box bounds, const ViewParams *params,
                      Camera *camera, Err *err)
{
    Vec3 center = box_center(bounds), direction = {0}, right = {0}, up = {0};
    TRY(camera_axes(params, center, &direction, &right, &up, err));
    double diagonal = vec3_distance(bounds.low, bounds.high);
    double aspect = (double)params->width / params->height;
    double used = 1 - 2 * params->margin; /* part of the picture that the tree may fill */
    *camera = (Camera){.projection = params->projection,
                       .direction = direction,
                       .width = params->width,
                       .height = params->height};
    if (params->projection == PROJECTION_ORTHOGRAPHIC) {
        Extent extent = extent_along(balls, n, right, up);
        double wide = extent.high_x - extent.low_x, high = extent.high_y - extent.low_y;
        double height =
            params->height_mm > 0 ? params->height_mm : fmax(high, wide / aspect) / used;
        Vec3 middle = vec3_scale(right, (extent.low_x + extent.high_x) / 2);
        middle = vec3_add_scaled(middle, up, (extent.low_y + extent.high_y) / 2);
        middle = vec3_add_scaled(middle, direction, vec3_dot(center, direction) - diagonal);
        camera->location = params->has_location ? params->location : middle;
        camera->right = vec3_scale(right, height * aspect);
        camera->up = vec3_scale(up, height);
        return STATUS_OK;
    }
    double tan_x = tan(params->angle_deg * degrees_pi / 2), tan_y = tan_x / aspect;
    double distance =
        framing_distance(balls, n, center, direction, right, up, tan_x * used, tan_y * used);
    camera->location =
        params->has_location ? params->location : vec3_add_scaled(center, direction, -distance);
    camera->right = vec3_scale(right, 2 * tan_x);
    camera->up = vec3_scale(up, 2 * tan_y);
    return STATUS_OK;
}
