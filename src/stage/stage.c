/* A tree becomes a scene in three steps: the geometry of its model, the camera that frames it, and
 * the look's lights turned from the camera's axes to the world's.
 *
 * No two surfaces of a primitive model coincide, because which of two coincident surfaces is seen is
 * nobody's to say. Nodes joined by segments of no length are one place: `rounded` puts one sphere
 * there, of the largest radius that meets. A segment that shares both ends with a sister at least as
 * thick lies inside her and is left out; measured trees hold such pairs. */
#include "stage/stage.h"

#include "stage/blend.h"
#include "stage/framing.h"
#include <stdlib.h>

/* POV-Ray refuses cylinders shorter than this [docs/POVRAY.md]. */
static const double shortest_mm = 1e-9;

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

static bool has_length(const Tree *tree, size_t i)
{
    return tree_segment_length(tree, i) > shortest_mm;
}

static bool can_be_drawn(const Tree *tree, size_t i)
{
    return tree_is_segment(tree, i) && tree->radius_mm[i] > 0 && has_length(tree, i);
}

/* For each node the sister within whose segment its own lies, or TREE_NO_PARENT, in *cover (owned). */
static Status find_covers(const Tree *tree, int32_t **cover, Err *err)
{
    int32_t *last = NULL, *previous = NULL, *found = NULL; /* child lists, latest first */
    Status status = mem_calloc(&last, tree->n, sizeof *last, "nodes", err);
    if (status == STATUS_OK)
        status = mem_calloc(&previous, tree->n, sizeof *previous, "nodes", err);
    if (status == STATUS_OK)
        status = mem_calloc(&found, tree->n, sizeof *found, "nodes", err);
    for (size_t i = 0; status == STATUS_OK && i < tree->n; i++) {
        last[i] = found[i] = TREE_NO_PARENT;
        if (!can_be_drawn(tree, i))
            continue;
        int32_t self = (int32_t)i, *youngest = &last[tree->parent[i]];
        for (int32_t sister = *youngest; sister >= 0; sister = previous[sister]) {
            if (found[sister] >= 0 ||
                vec3_distance(tree->position[i], tree->position[sister]) > shortest_mm)
                continue;
            bool thicker = tree->radius_mm[i] > tree->radius_mm[sister];
            found[thicker ? sister : self] = thicker ? self : sister;
            break;
        }
        previous[i] = *youngest;
        *youngest = self;
    }
    free(last);
    free(previous);
    if (status == STATUS_OK)
        *cover = found;
    return status;
}

static Rgb color_of(const Rgb *colors, const Look *look, size_t node)
{
    return colors ? colors[node] : look->color;
}

static void add_cylinders(const Tree *tree, const Look *look, const Rgb *colors,
                          const int32_t *cover, Scene *scene)
{
    for (size_t i = 0; i < tree->n; i++) {
        if (can_be_drawn(tree, i) && cover[i] < 0)
            scene->primitives[scene->n_primitives++] =
                (Primitive){.kind = PRIMITIVE_CYLINDER,
                            .a = tree->position[tree->parent[i]],
                            .b = tree->position[i],
                            .radius_mm = tree->radius_mm[i],
                            .id = (uint32_t)tree->id[i],
                            .color = color_of(colors, look, i)};
    }
}

/* The sphere of a place stands for the thickest segment that meets there; of equals, the one that
 * ends there. */
static Status add_spheres(const Tree *tree, const Look *look, const Rgb *colors,
                          const int32_t *cover, Scene *scene, Err *err)
{
    int32_t *place = NULL, *thickest = NULL;
    Status status = mem_calloc(&place, tree->n, sizeof *place, "nodes", err);
    if (status == STATUS_OK)
        status = mem_calloc(&thickest, tree->n, sizeof *thickest, "nodes", err);
    if (status != STATUS_OK)
        goto done;
    for (size_t i = 0; i < tree->n; i++) {
        bool joined = tree_is_segment(tree, i) && !has_length(tree, i);
        place[i] = joined ? place[tree->parent[i]] : cover[i] >= 0 ? cover[i] : (int32_t)i;
        thickest[i] = can_be_drawn(tree, i) ? (int32_t)i : TREE_NO_PARENT;
    }
    for (size_t i = 0; i < tree->n; i++) {
        if (!can_be_drawn(tree, i))
            continue;
        int32_t *best = &thickest[place[tree->parent[i]]];
        if (*best < 0 || tree->radius_mm[i] > tree->radius_mm[*best])
            *best = (int32_t)i;
    }
    for (size_t i = 0; i < tree->n; i++) {
        if (place[i] != (int32_t)i || thickest[i] < 0)
            continue;
        size_t segment = (size_t)thickest[i];
        scene->primitives[scene->n_primitives++] =
            (Primitive){.kind = PRIMITIVE_SPHERE,
                        .a = tree->position[i],
                        .b = tree->position[i],
                        .radius_mm = tree->radius_mm[segment],
                        .id = (uint32_t)tree->id[segment],
                        .color = color_of(colors, look, segment)};
    }
done:
    free(place);
    free(thickest);
    return status;
}

/* number[i] becomes the index of the segment that ends at node i, or -1. */
static void add_field(const Tree *tree, const Look *look, const Rgb *colors, Scene *scene,
                      int32_t *number)
{
    for (size_t i = 0; i < tree->n; i++) {
        number[i] = -1;
        if (!can_be_drawn(tree, i))
            continue;
        number[i] = (int32_t)scene->n_segments;
        scene->segments[scene->n_segments++] = (FieldSegment){.a = tree->position[tree->parent[i]],
                                                              .b = tree->position[i],
                                                              .radius_mm = tree->radius_mm[i],
                                                              .id = (uint32_t)tree->id[i],
                                                              .color = color_of(colors, look, i)};
    }
}

static Status add_potential(const Tree *tree, const Look *look, const Rgb *colors, bool graph,
                            Scene *scene, Err *err)
{
    int32_t *number = NULL;
    TRY(mem_calloc(&scene->segments, tree->n, sizeof *scene->segments, "segments", err));
    TRY(mem_calloc(&number, tree->n, sizeof *number, "segments", err));
    add_field(tree, look, colors, scene, number);
    Status status = graph ? blend_find(tree, number, scene, err) : STATUS_OK;
    free(number);
    return status;
}

static Status add_geometry(const Tree *tree, const Look *look, const Rgb *colors, bool graph,
                           Scene *scene, Err *err)
{
    if (scene->model == SCENE_ISOSURFACE)
        return add_potential(tree, look, colors, graph, scene, err);
    TRY(mem_calloc(&scene->primitives, 2 * tree->n, sizeof *scene->primitives, "primitives", err));
    int32_t *cover = NULL;
    Status status = find_covers(tree, &cover, err);
    if (status == STATUS_OK)
        add_cylinders(tree, look, colors, cover, scene);
    if (status == STATUS_OK && scene->model == SCENE_ROUNDED)
        status = add_spheres(tree, look, colors, cover, scene, err);
    free(cover);
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
        balls[n++] = (Ball){primitive->b, primitive->radius_mm};
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

/* Parallel lights stand ten diagonals away, in front of everything they light. */
static Status add_lights(const Look *look, bool shadows, Scene *scene, Err *err)
{
    TRY(mem_calloc(&scene->lights, (size_t)look->n_lights, sizeof *scene->lights, "lights", err));
    Vec3 right = vec3_normalized(scene->camera.right), up = vec3_normalized(scene->camera.up);
    Vec3 towards = vec3_scale(scene->camera.direction, -1), center = box_center(scene->bounds);
    double distance = 10 * vec3_distance(scene->bounds.low, scene->bounds.high);
    for (int i = 0; i < look->n_lights; i++) {
        Vec3 local = vec3_normalized(look->lights[i].direction);
        Vec3 world = vec3_scale(right, local.x);
        world = vec3_add_scaled(world, up, local.y);
        world = vec3_add_scaled(world, towards, local.z);
        scene->lights[scene->n_lights++] =
            (Light){.location = vec3_add_scaled(center, world, distance),
                    .target = center,
                    .color = look->lights[i].color,
                    .parallel = true,
                    .casts_shadows = shadows};
    }
    return STATUS_OK;
}

Status stage_scene(const Tree *tree, const Look *look, const Rgb *colors, const StageParams *params,
                   Scene *scene, StageReport *report, Err *err)
{
    Scene built = {.model = params->model,
                   .background = look->background,
                   .finish = look->finish,
                   .uniform_color = colors == NULL,
                   .color = look->color};
    StageReport counted = {0};
    for (size_t i = 0; i < tree->n; i++) {
        if (can_be_drawn(tree, i))
            counted.drawn++;
        else if (tree_is_segment(tree, i))
            counted.dropped++;
    }
    if (counted.drawn == 0)
        return err_set(err, STATUS_INPUT,
                       "the tree has nothing to draw: no segment has both a length and a radius");
    Ball *balls = NULL;
    Status status = add_geometry(tree, look, colors, params->graph, &built, err);
    if (status == STATUS_OK)
        status = mem_calloc(&balls, 2 * (built.n_primitives + built.n_segments), sizeof *balls,
                            "balls", err);
    if (status == STATUS_OK) {
        size_t n = end_balls(&built, balls, &built.bounds);
        status = framing_camera(balls, n, built.bounds, params, &built.camera, err);
    }
    if (status == STATUS_OK)
        status = add_lights(look, params->shadows, &built, err);
    if (status == STATUS_OK)
        status = scene_check(&built, err);
    free(balls);
    if (status != STATUS_OK) {
        scene_release(&built);
        return status;
    }
    *scene = built;
    if (report)
        *report = counted;
    return STATUS_OK;
}
