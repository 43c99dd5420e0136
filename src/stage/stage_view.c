/* The camera frames the geometry; ground and lights of the look, which are given in the camera's
 * axes and in sizes of the tree, are placed about it. */
#include "stage/stage.h"

#include "stage/framing.h"
#include <stdlib.h>

ViewParams view_defaults(void)
{
    return (ViewParams){.width = 1000,
                        .height = 1000,
                        .projection = PROJECTION_ORTHOGRAPHIC,
                        .view = VIEW_FRONT,
                        .angle_deg = 30,
                        .margin = 0.05};
}

/* A vector of right, up and towards the viewer, in the world. */
static Vec3 from_camera(const Camera *camera, Vec3 v)
{
    Vec3 world = vec3_scale(vec3_normalized(camera->right), v.x);
    world = vec3_add_scaled(world, vec3_normalized(camera->up), v.y);
    return vec3_add_scaled(world, camera->direction, -v.z);
}

/* The ground lies just beyond the last ball along its normal, and farther by the gap. */
static Ground place_ground(const LookGround *look, const Ball *balls, size_t n,
                           const Camera *camera, Box bounds)
{
    if (!look->present)
        return (Ground){0};
    Vec3 normal = look->in_world ? look->normal : from_camera(camera, look->normal);
    Ground ground = {.present = true,
                     .normal = vec3_normalized(normal),
                     .offset_mm = HUGE_VAL,
                     .color = look->color,
                     .finish = {.ambient = (float)look->ambient,
                                .diffuse = (float)look->diffuse,
                                .brilliance = 1,
                                .phong_size = 40,
                                .roughness = 0.05f}};
    for (size_t i = 0; i < n; i++)
        ground.offset_mm =
            fmin(ground.offset_mm, vec3_dot(ground.normal, balls[i].center) - balls[i].radius);
    ground.offset_mm -= look->gap * vec3_distance(bounds.low, bounds.high) / 2;
    return ground;
}

/* A light in the world. Parallel lights stand ten diagonals away, in front of everything they
 * light. */
static Light place_light(const LookLight *light, const Camera *camera, Box bounds, bool shadows)
{
    Vec3 right = vec3_normalized(camera->right), up = vec3_normalized(camera->up);
    Vec3 center = box_center(bounds), direction = light->direction;
    double diagonal = vec3_distance(bounds.low, bounds.high);
    if (!light->is_point)
        direction = vec3_normalized(direction);
    Vec3 offset = from_camera(camera, direction);
    Light placed = {
        .location = vec3_add_scaled(center, offset, light->is_point ? diagonal / 2 : 10 * diagonal),
        .target = center,
        .color = light->color,
        .parallel = !light->is_point,
        .casts_shadows = shadows};
    if (light->size > 0) {
        /* Square to the way to the tree, one side level in the picture where that can be. */
        Vec3 towards = vec3_normalized(offset), level = vec3_cross(up, towards);
        level = vec3_length(level) > 1e-6 ? vec3_normalized(level) : right;
        placed.samples = light->samples;
        placed.sides[0] = vec3_scale(level, light->size * diagonal / 2);
        placed.sides[1] = vec3_scale(vec3_cross(towards, level), light->size * diagonal / 2);
    }
    return placed;
}

Status stage_view(const Look *look, const ViewParams *params, const Geometry *geometry, View *view,
                  Err *err)
{
    View made = {.background = look->background, .n_lights = (size_t)look->n_lights};
    ViewParams near = *params; /* to the origin, as the geometry is */
    near.location = vec3_sub(params->location, geometry->origin);
    near.look_at = vec3_sub(params->look_at, geometry->origin);
    Ball *balls;
    size_t n;
    TRY(framing_balls(geometry, &balls, &n, err));
    Status status = framing_camera(balls, n, geometry->bounds, &near, &made.camera, err);
    if (status == STATUS_OK)
        made.ground = place_ground(&look->ground, balls, n, &made.camera, geometry->bounds);
    free(balls);
    TRY(status);
    for (size_t i = 0; i < made.n_lights; i++)
        made.lights[i] =
            place_light(&look->lights[i], &made.camera, geometry->bounds, params->shadows);
    TRY(view_check(&made, err));
    *view = made;
    return STATUS_OK;
}
