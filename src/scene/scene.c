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

JointFrame primitive_joint(const Primitive *primitive)
{
    return joint_frame((const Vec3[2]){primitive->a, primitive->b},
                       (const Vec3[2]){primitive->axis_a, primitive->axis_b},
                       (const double[2]){primitive->radius_mm, primitive->radius_b_mm});
}

void scene_release(Scene *scene)
{
    free(scene->lights);
    free(scene->primitives);
    free(scene->segments);
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
    if (!vec3_finite(camera->location) || !vec3_finite(camera->right) || !vec3_finite(camera->up) ||
        !(vec3_length(camera->direction) > 0) || !(vec3_length(camera->right) > 0) ||
        !(vec3_length(camera->up) > 0))
        return err_set(err, STATUS_INPUT, "the camera has no direction or no extent");
    if (vec3_length(camera->location) > farthest_mm)
        return err_set(err, STATUS_INPUT, "the camera is farther than %g mm from the origin",
                       farthest_mm);
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
    return STATUS_OK;
}
