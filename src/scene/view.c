/* Computes rays, projections and directions of a view: camera, lights and ground. All three have
 * the meaning that they have in POV-Ray. camera_ray and ground_hit repeat POV-Ray's arithmetic
 * operation by operation, so that rays of both programs are the same to the last bit. */
#include "scene/view.h"

#include "scene/geometry.h"
#include <math.h>

/* Returns the position of a pixel as a fraction of the picture's width and height, from its middle,
 * right and up. */
static Vec3 across(const Camera *camera, double i, double j)
{
    double x0 = (i + 0.5) / camera->width - 0.5;
    double y0 = ((camera->height - 1) - (j - 0.5)) / camera->height - 0.5;
    return vec3_add(vec3_scale(camera->right, x0), vec3_scale(camera->up, y0));
}

Ray camera_ray(const Camera *camera, double i, double j)
{
    Vec3 offset = across(camera, i, j);
    if (camera->projection == PROJECTION_ORTHOGRAPHIC)
        return (Ray){vec3_add(camera->location, offset), vec3_normalized(camera->direction)};
    return (Ray){camera->location, vec3_normalized(vec3_add(camera->direction, offset))};
}

CameraPoint camera_point(const Camera *camera, Vec3 point)
{
    Vec3 from = vec3_sub(point, camera->location);
    double width = vec3_length(camera->right), height = vec3_length(camera->up);
    double z = vec3_dot(from, camera->direction);
    bool perspective = camera->projection == PROJECTION_PERSPECTIVE;
    double scale = perspective ? 1 / z : 1;
    if (perspective && !(z > 0))
        return (CameraPoint){0};
    return (CameraPoint){
        .x = (vec3_dot(from, camera->right) / (width * width) * scale + 0.5) * camera->width,
        .y = (0.5 - vec3_dot(from, camera->up) / (height * height) * scale) * camera->height,
        .depth_mm = perspective ? vec3_length(from) : z,
        .per_mm = camera->width / width * scale};
}

Camera camera_of_pixel(const Camera *camera, int i, int j)
{
    Camera one = *camera;
    Vec3 offset = across(camera, i, j);
    one.width = one.height = 1;
    one.right = vec3_scale(camera->right, 1.0 / camera->width);
    one.up = vec3_scale(camera->up, 1.0 / camera->height);
    if (camera->projection == PROJECTION_ORTHOGRAPHIC)
        one.location = vec3_add(camera->location, offset);
    else
        one.direction = vec3_add(camera->direction, offset);
    return one;
}

void camera_sample_offsets(int n, double *offsets)
{
    double step = 1.0 / n, offset = -(0.5 - step * 0.5);
    for (int i = 0; i < n; i++) {
        offsets[i] = offset;
        offset += step;
    }
}

void camera_depth_range(const Camera *camera, Box box, double *near_mm, double *far_mm)
{
    Vec3 center = box_center(box);
    double radius = vec3_distance(center, box.high);
    Vec3 to_center = vec3_sub(center, camera->location);
    double distance = camera->projection == PROJECTION_ORTHOGRAPHIC
                          ? vec3_dot(to_center, camera->direction)
                          : vec3_length(to_center);
    *near_mm = fmax(0, distance - radius);
    *far_mm = distance + radius;
}

View view_moved(const View *view, Vec3 by)
{
    View moved = *view;
    moved.camera.location = vec3_add(view->camera.location, by);
    for (size_t i = 0; i < view->n_lights; i++) {
        moved.lights[i].location = vec3_add(view->lights[i].location, by);
        moved.lights[i].target = vec3_add(view->lights[i].target, by);
    }
    moved.ground.offset_mm += vec3_dot(view->ground.normal, by);
    return moved;
}

/* Returns the view rotated about an axis through the origin. */
static View turned_view(const View *view, Vec3 axis, double angle)
{
    View turned = *view;
    Camera *camera = &turned.camera;
    Vec3 *vectors[] = {&camera->location, &camera->right, &camera->up, &camera->direction,
                       &turned.ground.normal};
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
        *vectors[i] = vec3_rotated(*vectors[i], axis, angle);
    for (size_t i = 0; i < view->n_lights; i++) {
        Light *light = &turned.lights[i];
        light->location = vec3_rotated(light->location, axis, angle);
        light->target = vec3_rotated(light->target, axis, angle);
        light->sides[0] = vec3_rotated(light->sides[0], axis, angle);
        light->sides[1] = vec3_rotated(light->sides[1], axis, angle);
    }
    return turned;
}

View view_turned(const View *view, Vec3 center, Vec3 axis, double angle)
{
    View about = view_moved(view, vec3_scale(center, -1));
    View turned = turned_view(&about, vec3_normalized(axis), angle);
    return view_moved(&turned, center);
}

/* Returns the direction and the distance from `point` to a location. */
static LightDirection direction_to(Vec3 location, Vec3 point)
{
    Vec3 to_light = vec3_sub(location, point);
    double distance = vec3_length(to_light);
    return (LightDirection){vec3_scale(to_light, 1 / distance), distance};
}

LightDirection light_direction(const Light *light, Vec3 point)
{
    if (!light->parallel)
        return direction_to(light->location, point);
    Vec3 towards = vec3_normalized(vec3_sub(light->location, light->target));
    return (LightDirection){towards, vec3_dot(vec3_sub(light->location, point), towards)};
}

bool light_is_soft(const Light *light)
{
    return light->casts_shadows && light->samples > 1;
}

bool view_has_soft_shadows(const View *view)
{
    for (size_t i = 0; i < view->n_lights; i++)
        if (light_is_soft(&view->lights[i]))
            return true;
    return false;
}

int light_points(const Light *light)
{
    return light->samples > 1 ? light->samples * light->samples : 1;
}

Light light_at_point(const Light *light, int k)
{
    Light point = *light;
    int n = light->samples;
    if (n < 2)
        return point;
    double u = k % n / (n - 1.0) - 0.5, v = k / n / (n - 1.0) - 0.5;
    if (light->round) { /* as POV-Ray's `circular` (trace.cpp of 3.7.0.10) */
        u += 0.001;
        v += 0.001;
        double factor = fmax(fabs(u), fabs(v)) / sqrt(u * u + v * v);
        u *= factor;
        v *= factor;
    }
    Vec3 at = vec3_add_scaled(light->location, light->sides[0], u);
    point.location = vec3_add_scaled(at, light->sides[1], v);
    point.parallel = false;
    point.samples = 1;
    return point;
}

LightDirection light_direction_to_point(const Light *light, int k, Vec3 point)
{
    Light source = light_at_point(light, k);
    return light_direction(&source, point);
}

bool ground_hit(const Ground *ground, Ray ray, double near_mm, double far_mm, double *t)
{
    if (!ground->present)
        return false;
    double along = vec3_dot(ground->normal, ray.direction);
    if (fabs(along) < 1e-10) /* parallel to the ground, by POV-Ray's limit */
        return false;
    double distance = -(vec3_dot(ground->normal, ray.origin) - ground->offset_mm) / along;
    if (!(distance > near_mm && distance < far_mm && distance <= SCENE_FARTHEST_MM))
        return false;
    *t = distance;
    return true;
}

Status view_check(const View *view, Err *err)
{
    const Camera *camera = &view->camera;
    if (vec3_length(camera->location) > SCENE_FARTHEST_MM)
        return err_set(err, STATUS_INPUT, "the camera is farther than %g mm from the origin",
                       SCENE_FARTHEST_MM);
    if (!vec3_finite(camera->location) || !vec3_finite(camera->right) || !vec3_finite(camera->up) ||
        !(vec3_length(camera->direction) > 0) || !(vec3_length(camera->right) > 0) ||
        !(vec3_length(camera->up) > 0))
        return err_set(err, STATUS_INPUT,
                       "the camera has a direction or a picture side of length 0, or a vector that "
                       "is not finite");
    if (view->ground.present && !isfinite(view->ground.offset_mm))
        return err_set(err, STATUS_INPUT,
                       "the position of the ground plane is not a finite number");
    return STATUS_OK;
}
