/* A tree becomes a scene in three steps: the geometry of its model, the camera that frames it, and
 * the look's lights turned from the camera's axes to the world's.
 *
 * No two surfaces of a primitive model coincide, because which of two coincident surfaces is seen
 * is nobody's to say; hence places.c. `rounded` puts one sphere at a place, of the largest radius
 * that meets there. */
#include "stage/stage.h"

#include "stage/blend.h"
#include "stage/framing.h"
#include "stage/joints.h"
#include "stage/places.h"
#include <stdlib.h>

StageParams stage_defaults(void)
{
    return (StageParams){.model = SCENE_ROUNDED,
                         .width = 1000,
                         .height = 1000,
                         .projection = PROJECTION_ORTHOGRAPHIC,
                         .view = VIEW_FRONT,
                         .angle_deg = 30,
                         .margin = 0.05};
}

/* number[i] becomes that of the cylinder of the segment that ends at node i, or -1. */
static void add_cylinders(const Tree *tree, const Paint *paint, const Places *places, Scene *scene,
                          int32_t *number)
{
    for (size_t i = 0; i < tree->n; i++) {
        number[i] = -1;
        if (!places_draw(places, tree, i))
            continue;
        number[i] = (int32_t)scene->n_primitives;
        scene->primitives[scene->n_primitives++] = (Primitive){.kind = PRIMITIVE_CYLINDER,
                                                               .a = tree->position[tree->parent[i]],
                                                               .b = tree->position[i],
                                                               .radius_mm = tree->radius_mm[i],
                                                               .id = (uint32_t)tree->id[i],
                                                               .color = paint_of(paint, i)};
    }
}

/* thickest[i] becomes the thickest segment that meets at node i, if that stands for its place, or
 * -1; of equals, the one that ends there. */
static void find_thickest(const Tree *tree, const Places *places, int32_t *thickest)
{
    for (size_t i = 0; i < tree->n; i++)
        thickest[i] = segment_can_be_drawn(tree, i) ? (int32_t)i : -1;
    for (size_t i = 0; i < tree->n; i++) {
        if (!segment_can_be_drawn(tree, i))
            continue;
        int32_t *best = &thickest[places->place[tree->parent[i]]];
        if (*best < 0 || tree->radius_mm[i] > tree->radius_mm[*best])
            *best = (int32_t)i;
    }
    for (size_t i = 0; i < tree->n; i++)
        if (places->place[i] != (int32_t)i)
            thickest[i] = -1;
}

/* Whether the point is an end of the cylinder, which becomes round. */
static bool round_end(Primitive *cylinder, Vec3 at)
{
    bool is_a = vec3_distance(cylinder->a, at) == 0, is_b = vec3_distance(cylinder->b, at) == 0;
    cylinder->round_a |= is_a;
    cylinder->round_b |= is_b;
    return is_a || is_b;
}

/* The sphere of a place stands for the thickest segment there. Those that are ends of the segment's
 * cylinder come last. */
static void add_spheres(const Tree *tree, const Paint *paint, const int32_t *thickest,
                        const int32_t *cylinder, Scene *scene)
{
    for (int ends = 0; ends < 2; ends++)
        for (size_t i = 0; i < tree->n; i++) {
            if (thickest[i] < 0)
                continue;
            size_t segment = (size_t)thickest[i];
            bool is_end = cylinder[segment] >= 0 &&
                          round_end(&scene->primitives[cylinder[segment]], tree->position[i]);
            if (is_end != ends)
                continue;
            scene->n_ends += is_end;
            scene->primitives[scene->n_primitives++] =
                (Primitive){.kind = PRIMITIVE_SPHERE,
                            .a = tree->position[i],
                            .b = tree->position[i],
                            .radius_mm = tree->radius_mm[segment],
                            .id = (uint32_t)tree->id[segment],
                            .color = paint_of(paint, segment)};
        }
}

static Status add_solids(const Tree *tree, const Paint *paint, const Places *places, Scene *scene,
                         Err *err)
{
    int32_t *cylinder = NULL, *thickest = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&cylinder, tree->n, sizeof *cylinder, "nodes", err));
    TRY_GOTO(mem_calloc(&thickest, tree->n, sizeof *thickest, "nodes", err));
    add_cylinders(tree, paint, places, scene, cylinder);
    if (scene->model == SCENE_ROUNDED) {
        find_thickest(tree, places, thickest);
        add_spheres(tree, paint, thickest, cylinder, scene);
    }
done:
    free(cylinder);
    free(thickest);
    return status;
}

/* number[i] becomes the index of the segment that ends at node i, or -1. */
static void add_field(const Tree *tree, const Paint *paint, Scene *scene, int32_t *number)
{
    for (size_t i = 0; i < tree->n; i++) {
        number[i] = -1;
        if (!segment_can_be_drawn(tree, i))
            continue;
        number[i] = (int32_t)scene->n_segments;
        scene->segments[scene->n_segments++] = (FieldSegment){.a = tree->position[tree->parent[i]],
                                                              .b = tree->position[i],
                                                              .radius_mm = tree->radius_mm[i],
                                                              .id = (uint32_t)tree->id[i],
                                                              .color = paint_of(paint, i)};
    }
}

static Status add_potential(const Tree *tree, const Paint *paint, bool graph, Scene *scene,
                            Err *err)
{
    int32_t *number = NULL;
    TRY(mem_calloc(&scene->segments, tree->n, sizeof *scene->segments, "segments", err));
    TRY(mem_calloc(&number, tree->n, sizeof *number, "segments", err));
    add_field(tree, paint, scene, number);
    Status status = graph ? blend_find(tree, number, scene, err) : STATUS_OK;
    free(number);
    return status;
}

static Status add_geometry(const Tree *tree, const Paint *paint, const StageParams *params,
                           Scene *scene, StageReport *report, Err *err)
{
    if (scene->model == SCENE_ISOSURFACE || scene->model == SCENE_BLOB)
        return add_potential(tree, paint, params->graph, scene, err);
    TRY(mem_calloc(&scene->primitives, 2 * tree->n, sizeof *scene->primitives, "primitives", err));
    Places places = {0};
    TRY(places_find(tree, &places, err));
    Status status = STATUS_OK;
    if (scene->model == SCENE_JOINED)
        status = joints_add(tree, paint, &places, params->joints, scene, report, err);
    else
        status = add_solids(tree, paint, &places, scene, err);
    places_release(&places);
    return status;
}

/* The two end balls of every segment drawn. The implicit surface reaches beyond its segments by
 * 0.551 r at free ends and by less than r where vessels meet, hence the factor. */
static size_t end_balls(const Scene *scene, Ball *balls, Box *bounds)
{
    size_t n = 0;
    for (size_t i = 0; i < scene->n_primitives; i++) {
        const Primitive *primitive = &scene->primitives[i];
        balls[n++] = (Ball){primitive->a, primitive->radius_mm};
        bool joint = primitive->kind == PRIMITIVE_JOINT;
        balls[n++] = (Ball){primitive->b, joint ? primitive->radius_b_mm : primitive->radius_mm};
    }
    for (size_t i = 0; i < scene->n_segments; i++) {
        const FieldSegment *segment = &scene->segments[i];
        balls[n++] = (Ball){segment->a, 2 * segment->radius_mm};
        balls[n++] = (Ball){segment->b, 2 * segment->radius_mm};
    }
    *bounds = box_empty();
    for (size_t i = 0; i < n; i++)
        *bounds = box_with_ball(*bounds, balls[i].center, balls[i].radius);
    return n;
}

/* A vector of right, up and towards the viewer, in the world. */
static Vec3 from_camera(const Camera *camera, Vec3 v)
{
    Vec3 world = vec3_scale(vec3_normalized(camera->right), v.x);
    world = vec3_add_scaled(world, vec3_normalized(camera->up), v.y);
    return vec3_add_scaled(world, camera->direction, -v.z);
}

/* The ground lies just beyond the last ball along its normal, and farther by the gap. */
static Ground place_ground(const LookGround *look, const Ball *balls, size_t n, const Scene *scene)
{
    if (!look->present)
        return (Ground){0};
    Vec3 normal = look->in_world ? look->normal : from_camera(&scene->camera, look->normal);
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
    ground.offset_mm -= look->gap * vec3_distance(scene->bounds.low, scene->bounds.high) / 2;
    return ground;
}

/* A light in the world. Parallel lights stand ten diagonals away, in front of everything they
 * light. */
static Light place_light(const LookLight *light, const Scene *scene, bool shadows)
{
    Vec3 right = vec3_normalized(scene->camera.right), up = vec3_normalized(scene->camera.up);
    Vec3 center = box_center(scene->bounds), direction = light->direction;
    double diagonal = vec3_distance(scene->bounds.low, scene->bounds.high);
    if (!light->is_point)
        direction = vec3_normalized(direction);
    Vec3 offset = from_camera(&scene->camera, direction);
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

/* Camera, ground and lights about the geometry, whose bounds it sets. */
static Status set_stage(const Look *look, const StageParams *params, Scene *scene, Err *err)
{
    Ball *balls = NULL;
    Status status = mem_calloc(&balls, 2 * (scene->n_primitives + scene->n_segments), sizeof *balls,
                               "balls", err);
    if (status == STATUS_OK) {
        size_t n = end_balls(scene, balls, &scene->bounds);
        status = framing_camera(balls, n, scene->bounds, params, &scene->camera, err);
        if (status == STATUS_OK)
            scene->ground = place_ground(&look->ground, balls, n, scene);
    }
    free(balls);
    if (status == STATUS_OK)
        status = mem_calloc(&scene->lights, (size_t)look->n_lights, sizeof *scene->lights, "lights",
                            err);
    if (status == STATUS_OK) {
        scene->n_lights = (size_t)look->n_lights;
        for (int i = 0; i < look->n_lights; i++)
            scene->lights[i] = place_light(&look->lights[i], scene, params->shadows);
        status = scene_check(scene, err);
    }
    return status;
}

Status stage_aim(const Look *look, const StageParams *params, Scene *scene, Err *err)
{
    StageParams moved = *params;
    moved.location = vec3_sub(params->location, scene->origin);
    moved.look_at = vec3_sub(params->look_at, scene->origin);
    Scene aimed = *scene;
    aimed.lights = NULL;
    Status status = set_stage(look, &moved, &aimed, err);
    free(status == STATUS_OK ? scene->lights : aimed.lights);
    if (status == STATUS_OK)
        *scene = aimed;
    return status;
}

Status stage_scene(const Tree *tree, const Look *look, const Rgb *colors, const StageParams *params,
                   Scene *scene, StageReport *report, Err *err)
{
    Scene built = {.model = params->model,
                   .background = look->background,
                   .finish = look->finish,
                   .open_joints = params->joints == JOINTS_PAPER,
                   .uniform_color = colors == NULL,
                   .color = look->color};
    StageReport counted = {0};
    for (size_t i = 0; i < tree->n; i++) {
        if (segment_can_be_drawn(tree, i))
            counted.drawn++;
        else if (tree_is_segment(tree, i))
            counted.dropped++;
    }
    if (counted.drawn == 0)
        return err_set(err, STATUS_INPUT,
                       "the tree has nothing to draw: no segment is longer than %g mm and has a "
                       "radius above 0",
                       SHORTEST_MM);
    built.drawn = counted.drawn;
    const Paint paint = {colors, look->color};
    Status status = add_geometry(tree, &paint, params, &built, &counted, err);
    if (status == STATUS_OK)
        status = set_stage(look, params, &built, err);
    if (status != STATUS_OK) {
        scene_release(&built);
        return status;
    }
    *scene = built;
    if (report)
        *report = counted;
    return STATUS_OK;
}
