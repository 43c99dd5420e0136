/* A camera is moved by changing the parameters that define it, so that a window can print the
 * options that draw its picture again. Rotation is about the camera's own axes: the object under
 * the mouse follows the mouse, in any orientation. */
#include "stage/subject.h"

static const double least_angle = 0.01, largest_height_mm = 1e7, least_height_mm = 1e-6;

typedef struct OrbitAxes {
    Vec3 right, up, back; /* unit; `back` points from look_at to the camera */
    double distance;
} OrbitAxes;

static OrbitAxes axes_of(const ViewParams *params)
{
    Vec3 back = vec3_sub(params->location, params->look_at);
    OrbitAxes axes = {.distance = vec3_length(back)};
    axes.back = vec3_scale(back, 1 / axes.distance);
    axes.right = vec3_normalized(vec3_cross(params->up, axes.back));
    axes.up = vec3_cross(axes.back, axes.right);
    return axes;
}

static void set_axes(ViewParams *params, OrbitAxes axes)
{
    params->location = vec3_add_scaled(params->look_at, axes.back, axes.distance);
    params->up = axes.up;
}

/* Returns the width of a perspective picture at unit distance. */
static double width_per_distance(const ViewParams *params)
{
    return 2 * elementary_tan(params->angle_deg * DEGREE / 2);
}

/* Returns the height in mm that the picture shows at look_at. */
static double height_mm(const ViewParams *params, double distance)
{
    if (params->projection == PROJECTION_ORTHOGRAPHIC)
        return params->height_mm;
    return width_per_distance(params) * distance * params->height / params->width;
}

void orbit_begin(ViewParams *params, const Camera *camera, const Geometry *geometry)
{
    Vec3 center = box_center(geometry->bounds);
    double along = vec3_dot(vec3_sub(center, camera->location), camera->direction);
    if (!(along > 0))
        along = vec3_distance(geometry->bounds.low, geometry->bounds.high);
    params->location = vec3_add(camera->location, geometry->origin);
    params->look_at = vec3_add_scaled(params->location, camera->direction, along);
    params->up = vec3_normalized(camera->up);
    params->has_location = params->has_look_at = params->has_up = true;
    params->projection = camera->projection;
    if (camera->projection == PROJECTION_ORTHOGRAPHIC)
        params->height_mm = vec3_length(camera->up);
}

void orbit_turn(ViewParams *params, double right, double up)
{
    OrbitAxes axes = axes_of(params);
    axes.back = vec3_rotated(axes.back, axes.up, -right);
    axes.right = vec3_rotated(axes.right, axes.up, -right);
    axes.back = vec3_normalized(vec3_rotated(axes.back, axes.right, up));
    axes.up = vec3_normalized(vec3_cross(axes.back, axes.right));
    set_axes(params, axes);
}

void orbit_zoom(ViewParams *params, double factor)
{
    if (params->projection == PROJECTION_ORTHOGRAPHIC) {
        params->height_mm =
            fmin(fmax(params->height_mm / factor, least_height_mm), largest_height_mm);
        return;
    }
    OrbitAxes axes = axes_of(params);
    axes.distance = fmin(fmax(axes.distance / factor, least_height_mm), largest_height_mm / 2);
    set_axes(params, axes);
}

void orbit_pan(ViewParams *params, double right, double up)
{
    OrbitAxes axes = axes_of(params);
    double height = height_mm(params, axes.distance);
    Vec3 move = vec3_scale(axes.right, -right * height);
    move = vec3_add_scaled(move, axes.up, -up * height);
    params->location = vec3_add(params->location, move);
    params->look_at = vec3_add(params->look_at, move);
}

void orbit_project(ViewParams *params, Projection projection, const Geometry *geometry)
{
    if (params->projection == projection)
        return;
    OrbitAxes axes = axes_of(params);
    double height = height_mm(params, axes.distance);
    if (projection == PROJECTION_PERSPECTIVE) {
        params->angle_deg = fmax(params->angle_deg, least_angle);
        axes.distance = height * params->width / params->height / width_per_distance(params);
    } else {
        /* In front of everything. */
        params->height_mm = height;
        Vec3 center = vec3_add(box_center(geometry->bounds), geometry->origin);
        axes.distance = vec3_distance(center, params->look_at) +
                        vec3_distance(geometry->bounds.low, geometry->bounds.high);
    }
    params->projection = projection;
    set_axes(params, axes);
}

void orbit_frame_turn(ViewParams *params, const Geometry *geometry)
{
    const Subject subject = subject_of(params, geometry);
    const Framed framed = framed_of(&subject, params->domain);
    Vec3 center = box_center(geometry->bounds), direction, up;
    bool perspective = params->projection == PROJECTION_PERSPECTIVE;
    view_axes(params, &direction, &up);
    Vec3 right = vec3_normalized(vec3_cross(direction, up));
    up = vec3_cross(right, direction);
    double aspect = (double)params->width / params->height, used = 1 - 2 * params->margin;
    double tan_x = elementary_tan(params->angle_deg * DEGREE / 2) * used, tan_y = tan_x / aspect;
    double slant_x = sqrt(1 + tan_x * tan_x), slant_y = sqrt(1 + tan_y * tan_y);
    double height = 0, distance = 0;
    for (size_t i = 0; i < framed_segments(&framed); i++) {
        Ball ends[2];
        for (int k = framed_ends(&framed, i, ends); k-- > 0;) {
            Vec3 from = vec3_sub(ends[k].center, center);
            double along = fabs(vec3_dot(from, up)), r = ends[k].radius;
            double off = vec3_length(vec3_cross(from, up));
            height = fmax(height, 2 * fmax(along + r, (off + r) / aspect) / used);
            distance = fmax(distance, off + (along + r * slant_y) / tan_y);
            distance = fmax(distance, (off + r) * slant_x / tan_x);
        }
    }
    if (!perspective) {
        Box all = box_union(framed.box, geometry->bounds);
        distance = vec3_distance(all.low, all.high);
        params->height_mm = height;
    }
    params->look_at = vec3_add(center, geometry->origin);
    params->location = vec3_add_scaled(params->look_at, direction, -distance);
    params->up = up;
    params->has_location = params->has_look_at = params->has_up = true;
}
