#include "scene/scene.h"

#include <stdlib.h>

/* POV-Ray ignores what lies farther than this along a ray (MAX_DISTANCE). */
static const double farthest_mm = 1e7;

Ray camera_ray(const Camera *camera, double i, double j)
{
    double x0 = (i + 0.5) / camera->width - 0.5;
    double y0 = ((camera->height - 1) - (j - 0.5)) / camera->height - 0.5;
    Vec3 across = vec3_add(vec3_scale(camera->right, x0), vec3_scale(camera->up, y0));
    if (camera->projection == PROJECTION_ORTHOGRAPHIC)
        return (Ray){vec3_add(camera->location, across), vec3_normalized(camera->direction)};
    return (Ray){camera->location, vec3_normalized(vec3_add(camera->direction, across))};
}

bool ground_hit(const Ground *ground, Ray ray, double near_mm, double far_mm, double *t)
{
    if (!ground->present)
        return false;
    double along = vec3_dot(ground->normal, ray.direction);
    if (fabs(along) < 1e-10)
        return false;
    double distance = -(vec3_dot(ground->normal, ray.origin) - ground->offset_mm) / along;
    if (!(distance > near_mm && distance < far_mm && distance <= farthest_mm))
        return false;
    *t = distance;
    return true;
}

void scene_depth_range(const Scene *scene, double *near_mm, double *far_mm)
{
    const Camera *camera = &scene->camera;
    Vec3 center = box_center(scene->bounds);
    double radius = vec3_distance(center, scene->bounds.high);
    Vec3 to_center = vec3_sub(center, camera->location);
    double distance = camera->projection == PROJECTION_ORTHOGRAPHIC
                          ? vec3_dot(to_center, camera->direction)
                          : vec3_length(to_center);
    *near_mm = fmax(0, distance - radius);
    *far_mm = distance + radius;
}

/* A scene is far from the origin beyond this many times its size. */
static const double far_sizes = 16;

static double largest_of(Vec3 v)
{
    return fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
}

void scene_move_to_origin(Scene *scene)
{
    Vec3 center = box_center(scene->bounds);
    double size = largest_of(vec3_sub(scene->bounds.high, scene->bounds.low));
    if (!(largest_of(center) > far_sizes * size))
        return;
    Vec3 move = {-round(center.x), -round(center.y), -round(center.z)};
    Vec3 *const places[] = {&scene->camera.location, &scene->bounds.low, &scene->bounds.high};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++)
        *places[i] = vec3_add(*places[i], move);
    scene->ground.offset_mm += vec3_dot(scene->ground.normal, move);
    for (size_t i = 0; i < scene->n_lights; i++) {
        scene->lights[i].location = vec3_add(scene->lights[i].location, move);
        scene->lights[i].target = vec3_add(scene->lights[i].target, move);
    }
    for (size_t i = 0; i < scene->n_primitives; i++) {
        scene->primitives[i].a = vec3_add(scene->primitives[i].a, move);
        scene->primitives[i].b = vec3_add(scene->primitives[i].b, move);
    }
    for (size_t i = 0; i < scene->n_segments; i++) {
        scene->segments[i].a = vec3_add(scene->segments[i].a, move);
        scene->segments[i].b = vec3_add(scene->segments[i].b, move);
    }
    scene->origin = vec3_sub(scene->origin, move);
}

bool blend_joins(const Blend *blend, uint32_t i, uint32_t other)
{
    if (!blend->first)
        return true;
    size_t low = blend->first[i], high = blend->first[i + 1];
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (blend->neighbors[middle] < other)
            low = middle + 1;
        else
            high = middle;
    }
    return low < blend->first[i + 1] && blend->neighbors[low] == other;
}

JointFrame primitive_joint(const Primitive *primitive)
{
    return joint_frame((const Vec3[2]){primitive->a, primitive->b},
                       (const Vec3[2]){primitive->axis_a, primitive->axis_b},
                       (const double[2]){primitive->radius_mm, primitive->radius_b_mm});
}

bool primitive_joint_is_solid(const Primitive *joint)
{
    Vec3 span = vec3_sub(joint->b, joint->a);
    double sine = vec3_length(vec3_cross(joint->axis_a, joint->axis_b));
    double slack = 1e-9 * (joint->radius_mm + joint->radius_b_mm);
    return vec3_dot(span, joint->axis_a) >= joint->radius_b_mm * sine - slack &&
           vec3_dot(span, joint->axis_b) >= joint->radius_mm * sine - slack;
}

void scene_release(Scene *scene)
{
    free(scene->lights);
    free(scene->primitives);
    free(scene->segments);
    free(scene->blend.first);
    free(scene->blend.neighbors);
    *scene = (Scene){0};
}

static Status check_tube(Vec3 a, Vec3 b, double radius, uint32_t id, Err *err)
{
    if (!vec3_finite(a) || !vec3_finite(b) || !(radius > 0) || !isfinite(radius))
        return err_set(err, STATUS_INPUT,
                       "the segment of node %u has a place or radius that is not a finite number",
                       id);
    if (vec3_length(a) + radius > farthest_mm || vec3_length(b) + radius > farthest_mm)
        return err_set(err, STATUS_INPUT,
                       "the segment of node %u lies farther than %g mm from the origin", id,
                       farthest_mm);
    return STATUS_OK;
}

Status scene_check(const Scene *scene, Err *err)
{
    const Camera *camera = &scene->camera;
    for (size_t i = 0; i < scene->n_primitives; i++) {
        const Primitive *primitive = &scene->primitives[i];
        TRY(check_tube(primitive->a, primitive->b, primitive->radius_mm, primitive->id, err));
        if (primitive->kind == PRIMITIVE_JOINT)
            TRY(check_tube(primitive->b, primitive->a, primitive->radius_b_mm, primitive->id, err));
    }
    for (size_t i = 0; i < scene->n_segments; i++) {
        const FieldSegment *segment = &scene->segments[i];
        TRY(check_tube(segment->a, segment->b, segment->radius_mm, segment->id, err));
    }
    if (vec3_length(camera->location) > farthest_mm)
        return err_set(err, STATUS_INPUT, "the camera is farther than %g mm from the origin",
                       farthest_mm);
    if (!vec3_finite(camera->location) || !vec3_finite(camera->right) || !vec3_finite(camera->up) ||
        !(vec3_length(camera->direction) > 0) || !(vec3_length(camera->right) > 0) ||
        !(vec3_length(camera->up) > 0))
        return err_set(err, STATUS_INPUT, "the camera has no direction or no extent");
    if (scene->ground.present && !isfinite(scene->ground.offset_mm))
        return err_set(err, STATUS_INPUT, "the ground has no place");
    return STATUS_OK;
}
