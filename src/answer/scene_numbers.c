/* All numbers that determine the colors of a scene, as a digest and as JSON. */
#include "answer/answer.h"

/* ---- digest ---------------------------------------------------------------------------------- */

/* Adds doubles to the digest. */
#define ADD_NUMBERS(hash, ...)                                                                     \
    hash_add(hash, (const double[]){__VA_ARGS__}, sizeof((const double[]){__VA_ARGS__}))

static void add_vector(Hash *hash, Vec3 v)
{
    ADD_NUMBERS(hash, v.x, v.y, v.z);
}

static void add_rgb(Hash *hash, Rgb color)
{
    add_vector(hash, vec3((double)color.r, (double)color.g, (double)color.b));
}

static void add_finish(Hash *hash, const Finish *f)
{
    ADD_NUMBERS(hash, (double)f->ambient, (double)f->diffuse, (double)f->brilliance,
                (double)f->phong, (double)f->phong_size, (double)f->specular, (double)f->roughness);
}

static void add_view(Hash *hash, const View *view, bool shadows)
{
    const Camera *camera = &view->camera;
    ADD_NUMBERS(hash, camera->projection, camera->width, camera->height, shadows);
    const Vec3 vectors[] = {camera->location, camera->right, camera->up, camera->direction,
                            view->ground.normal};
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
        add_vector(hash, vectors[i]);
    for (size_t i = 0; i < view->n_lights; i++) {
        const Light *light = &view->lights[i];
        add_vector(hash, light->location);
        add_vector(hash, light->target);
        add_vector(hash, light->sides[0]);
        add_vector(hash, light->sides[1]);
        add_rgb(hash, light->color);
        ADD_NUMBERS(hash, light->parallel, light->casts_shadows, light->samples);
        if (light->round) /* a square light adds nothing: its scenes keep the digests of before */
            ADD_NUMBERS(hash, light->round);
    }
    ADD_NUMBERS(hash, view->ground.present, view->ground.offset_mm);
    add_rgb(hash, view->ground.color);
    add_finish(hash, &view->ground.finish);
    add_rgb(hash, view->background);
    ADD_NUMBERS(hash, view->fade.nearest, view->fade.farthest, view->fade.near_mm,
                view->fade.far_mm);
}

HashText answer_scene_hash(const Scene *scene, bool shadows)
{
    const Geometry *geometry = &scene->geometry;
    Hash hash;
    hash_begin(&hash);
    hash_add_text(&hash, models[geometry->model].name);
    for (size_t i = 0; i < geometry->n_primitives; i++) {
        const Primitive *primitive = &geometry->primitives[i];
        add_vector(&hash, primitive->a);
        add_vector(&hash, primitive->b);
        ADD_NUMBERS(&hash, primitive->kind, primitive->radius_mm);
        if (primitive->kind == PRIMITIVE_JOINT) {
            ADD_NUMBERS(&hash, primitive->radius_b_mm);
            add_vector(&hash, primitive->axes[0]);
            add_vector(&hash, primitive->axes[1]);
        }
        add_rgb(&hash, appearance_color(&scene->appearance, primitive->segment));
    }
    for (size_t i = 0; i < geometry->n_segments; i++) {
        const FieldSegment *segment = &geometry->segments[i];
        add_vector(&hash, segment->a);
        add_vector(&hash, segment->b);
        ADD_NUMBERS(&hash, segment->radius_mm);
        add_rgb(&hash, appearance_color(&scene->appearance, segment->segment));
    }
    const VesselMesh *mesh = &geometry->mesh;
    if (mesh->n_triangles) {
        hash_add(&hash, mesh->points, mesh->n_points * sizeof *mesh->points);
        hash_add(&hash, mesh->normals, mesh->n_points * sizeof *mesh->normals);
        hash_add(&hash, mesh->triangles, mesh->n_triangles * sizeof *mesh->triangles);
        hash_add(&hash, mesh->labels, mesh->n_triangles * sizeof *mesh->labels);
    }
    const IndexLists *members = &geometry->blend.members;
    for (size_t i = 0; i < geometry->blend.n_groups; i++)
        for (uint32_t k = members->first[i]; k < members->first[i + 1]; k++)
            ADD_NUMBERS(&hash, (double)i, members->items[k]);
    add_finish(&hash, &scene->appearance.finish);
    add_view(&hash, &scene->view, shadows);
    return hash_finish(&hash);
}

/* ---- JSON ------------------------------------------------------------------------------------ */

static json_t *vector_json(Vec3 v)
{
    return json_numbers((const double[]){v.x, v.y, v.z}, 3);
}

static json_t *color_json(Rgb c)
{
    return json_numbers((const double[]){(double)c.r, (double)c.g, (double)c.b}, 3);
}

static json_t *finish_json(const Finish *finish)
{
    return JSON_OBJECT({"ambient", json_number((double)finish->ambient)},
                       {"diffuse", json_number((double)finish->diffuse)},
                       {"brilliance", json_number((double)finish->brilliance)},
                       {"phong", json_number((double)finish->phong)},
                       {"phong_size", json_number((double)finish->phong_size)},
                       {"specular", json_number((double)finish->specular)},
                       {"roughness", json_number((double)finish->roughness)});
}

static json_t *camera_json(const Camera *camera)
{
    const bool perspective = camera->projection == PROJECTION_PERSPECTIVE;
    return JSON_OBJECT({"projection", json_text(perspective ? "perspective" : "orthographic")},
                       {"location", vector_json(camera->location)},
                       {"right", vector_json(camera->right)}, {"up", vector_json(camera->up)},
                       {"direction", vector_json(camera->direction)},
                       {"width", json_count((uint64_t)camera->width)},
                       {"height", json_count((uint64_t)camera->height)});
}

static json_t *light_json(const Light *light)
{
    return JSON_OBJECT(
        {"location", vector_json(light->location)}, {"target", vector_json(light->target)},
        {"parallel", json_boolean(light->parallel)},
        {"casts_shadows", json_boolean(light->casts_shadows)}, {"color", color_json(light->color)},
        {"samples", json_count((uint64_t)light_points(light))},
        {"round", json_boolean(light->round)}, {"side_a", vector_json(light->sides[0])},
        {"side_b", vector_json(light->sides[1])});
}

static json_t *joint_json(const Scene *scene, const Primitive *joint)
{
    return JSON_OBJECT(
        {"kind", json_text("joint")}, {"a", vector_json(joint->a)}, {"b", vector_json(joint->b)},
        {"radius", json_number(joint->radius_mm)}, {"radius_b", json_number(joint->radius_b_mm)},
        {"axis_a", vector_json(joint->axes[0])}, {"axis_b", vector_json(joint->axes[1])},
        {"color", color_json(appearance_color(&scene->appearance, joint->segment))});
}

static json_t *shape_json(const Scene *scene, const Primitive *primitive)
{
    const Appearance *look = &scene->appearance;
    const bool is_ball = primitive->kind == PRIMITIVE_SPHERE;
    if (primitive->kind == PRIMITIVE_JOINT)
        return joint_json(scene, primitive);
    return JSON_OBJECT(
        {"kind", json_text(is_ball ? "sphere" : "cylinder")}, {"a", vector_json(primitive->a)},
        {"b", vector_json(is_ball ? primitive->a : primitive->b)},
        {"radius", json_number(primitive->radius_mm)},
        {"color",
         color_json(look->colors ? appearance_color(look, primitive->segment) : look->color)});
}

static json_t *triangle_json(const Scene *scene, uint32_t triangle)
{
    const VesselMesh *mesh = &scene->geometry.mesh;
    const uint32_t segment = scene->geometry.segments[mesh_segment(mesh, triangle)].segment;
    json_t *points = json_array(), *normals = json_array();
    for (int k = 0; k < 3; k++) {
        const uint32_t point = mesh->triangles[triangle][k];
        const float *n = mesh->normals[point];
        points = json_with_item(points, vector_json(mesh_point(mesh, point)));
        normals =
            json_with_item(normals, vector_json(vec3((double)n[0], (double)n[1], (double)n[2])));
    }
    return JSON_OBJECT({"kind", json_text("triangle")}, {"points", points}, {"normals", normals},
                       {"flat", json_boolean(mesh_is_cap(mesh, triangle))},
                       {"color", color_json(appearance_color(&scene->appearance, segment))});
}

static json_t *segment_json(const Scene *scene, const FieldSegment *segment)
{
    const Appearance *look = &scene->appearance;
    const bool is_blob = model_has(scene->geometry.model, MODEL_BLOB);
    return JSON_OBJECT({"kind", json_text(is_blob ? "blob" : "segment")},
                       {"a", vector_json(segment->a)}, {"b", vector_json(segment->b)},
                       {"radius", json_number(segment->radius_mm)},
                       {"color", color_json(appearance_color(look, segment->segment))});
}

/* Returns an array with an array of indices of segments for each blend group. */
static json_t *groups_json(const Blend *blend)
{
    json_t *groups = json_array();
    for (size_t i = 0; i < blend->n_groups; i++) {
        json_t *members = json_array();
        for (uint32_t k = blend->members.first[i]; k < blend->members.first[i + 1]; k++)
            members = json_with_item(members, json_count(blend->members.items[k]));
        groups = json_with_item(groups, members);
    }
    return groups;
}

static json_t *ground_json(const Ground *ground)
{
    return ground->present ? JSON_OBJECT({"normal", vector_json(ground->normal)},
                                         {"offset", json_number(ground->offset_mm)},
                                         {"color", color_json(ground->color)},
                                         {"finish", finish_json(&ground->finish)})
                           : json_null();
}

json_t *answer_scene_json(const Scene *scene, bool shadows)
{
    json_t *lights = json_array(), *shapes = json_array();
    for (size_t i = 0; i < scene->view.n_lights; i++)
        lights = json_with_item(lights, light_json(&scene->view.lights[i]));
    for (size_t i = 0; i < scene->geometry.n_primitives; i++)
        shapes = json_with_item(shapes, shape_json(scene, &scene->geometry.primitives[i]));
    for (uint32_t i = 0; i < scene->geometry.mesh.n_triangles; i++)
        shapes = json_with_item(shapes, triangle_json(scene, i));
    for (size_t i = 0; i < scene->geometry.n_segments && !scene->geometry.mesh.n_triangles; i++)
        shapes = json_with_item(shapes, segment_json(scene, &scene->geometry.segments[i]));
    const Fade *fade = &scene->view.fade;
    return JSON_OBJECT(
        {"camera", camera_json(&scene->view.camera)},
        {"background", color_json(scene->view.background)},
        {"finish", finish_json(&scene->appearance.finish)}, {"shadows", json_boolean(shadows)},
        {"fade",
         json_numbers((const double[]){fade->nearest, fade->farthest, fade->near_mm, fade->far_mm},
                      4)},
        {"ground", ground_json(&scene->view.ground)}, {"lights", lights}, {"shapes", shapes},
        {"groups", groups_json(&scene->geometry.blend)});
}
