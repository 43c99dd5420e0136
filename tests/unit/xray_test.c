/* The length of vessel along rays, compared with samples along the ray and with volumes. */
#include "render/xray/xray.h"
#include "unit.h"

#include "field/field.h"
#include "render/render.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "test_stage.h"

static Err err;

static const Look film = {.background = {1, 1, 1},
                          .finish = {.ambient = 1, .brilliance = 1, .roughness = 0.05f},
                          .effects = {.crease_deg = 180, .xray_per_mm = 0.125}};

/* A bifurcation whose parent is turned out of the plane of its daughters, and a vessel across. */
static void make_tree(Tree *tree)
{
    static const struct {
        int32_t parent;
        Vec3 at;
        double radius;
    } nodes[] = {
        {-1, {0, 12, 3}, 1.95},       {0, {0.4, 2.1, 0}, 1.95}, {1, {-6.3, -5.2, -1.4}, 1.55},
        {1, {5.1, -7.7, 0.6}, 1.385}, {3, {9.2, -12, 4}, 1.2},  {-1, {-8, -3, 2}, 0.9},
        {5, {8.3, -4.6, -1.1}, 0.9},
    };
    enum { N = sizeof nodes / sizeof *nodes };
    assert_int_equal(tree_init(tree, N, NULL), STATUS_OK);
    for (int32_t i = 0; i < N; i++) {
        tree->parent[i] = nodes[i].parent;
        tree->id[i] = i + 1;
        tree->radius_mm[i] = nodes[i].radius;
        tree->position[i] = nodes[i].at;
    }
}

static Scene scene_of(const Tree *tree, const GeometryParams *geometry, NamedView view,
                      Projection projection, int side)
{
    StageParams params = {*geometry, view_defaults()};
    Scene scene;
    params.view.view = view;
    params.view.projection = projection;
    params.view.width = params.view.height = side;
    assert_int_equal(stage_all(tree, &film, &params, &scene, NULL, &err), STATUS_OK);
    return scene;
}

/* The length along the ray of each pixel, mm. */
static Plane draw_lengths(const Scene *scene)
{
    const RenderParams params = {.threads = 2, .antialias = 1, .want_color = true};
    Frame frame;
    Plane lengths;
    RenderStats stats;
    assert_int_equal(render(scene, &params, &frame, &stats, &err), STATUS_OK);
    assert_string_equal(stats.engine, "xray");
    assert_int_equal(plane_init(&lengths, frame.color.width, frame.color.height, 1, &err),
                     STATUS_OK);
    for (size_t i = 0; i < (size_t)lengths.width * (size_t)lengths.height; i++)
        lengths.values[i] =
            (float)(-log((double)frame.color.values[3 * i]) / film.effects.xray_per_mm);
    frame_release(&frame);
    return lengths;
}

/* ---- place by place -------------------------------------------------------------------------- */

static bool is_in_primitive(const Primitive *primitive, Vec3 at)
{
    Vec3 from = vec3_sub(at, primitive->a), span = vec3_sub(primitive->b, primitive->a);
    if (primitive->kind == PRIMITIVE_SPHERE)
        return vec3_length(from) < primitive->radius_mm;
    double part = vec3_dot(from, span) / vec3_dot(span, span);
    return part > 0 && part < 1 &&
           vec3_length(vec3_add_scaled(from, span, -part)) < primitive->radius_mm;
}

static double sum_of(const Geometry *geometry, const uint32_t *members, size_t n, Vec3 at)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += potential_term(&geometry->segments[members ? members[i] : i], at);
    return sum;
}

static bool is_inside(const Geometry *geometry, Vec3 at)
{
    for (size_t i = 0; i < geometry->n_primitives; i++)
        if (is_in_primitive(&geometry->primitives[i], at))
            return true;
    const Blend *blend = &geometry->blend;
    for (size_t i = 0; i < blend->n_groups; i++) {
        uint32_t first = blend->members.first[i];
        if (sum_of(geometry, blend->members.items + first, blend->members.first[i + 1] - first,
                   at) > FIELD_LEVEL)
            return true;
    }
    return geometry->n_segments && !blend->n_groups &&
           sum_of(geometry, NULL, geometry->n_segments, at) > FIELD_LEVEL;
}

static double length_by_places(const Scene *scene, Ray ray, double step)
{
    double near, far, length = 0;
    camera_depth_range(&scene->view.camera, scene->geometry.bounds, &near, &far);
    for (double t = near + step / 2; t < far; t += step)
        length += is_inside(&scene->geometry, ray_at(ray, t)) ? step : 0;
    return length;
}

static void lengths_are_those_of_places_inside(void **state)
{
    (void)state;
    static const GeometryParams models_of[] = {{.model = SCENE_CYLINDERS},
                                               {.model = SCENE_ROUNDED},
                                               {.model = SCENE_ISOSURFACE},
                                               {.model = SCENE_ISOSURFACE, .graph = true}};
    enum { SIDE = 15 };
    const double step = 0.01;
    Tree tree;
    make_tree(&tree);
    for (size_t i = 0; i < sizeof models_of / sizeof *models_of; i++)
        for (int projection = 0; projection < 2; projection++) {
            Scene scene = scene_of(&tree, &models_of[i], VIEW_ISO, (Projection)projection, SIDE);
            Plane lengths = draw_lengths(&scene);
            for (int pixel = 0; pixel < SIDE * SIDE; pixel++) {
                Ray ray = camera_ray(&scene.view.camera, pixel % SIDE, pixel / SIDE);
                double expected = length_by_places(&scene, ray, step);
                /* each end of a stretch may be off by half a step */
                if (fabs(expected - (double)lengths.values[pixel]) > 4 * step)
                    fail_msg("model %zu, projection %d, pixel %d: %g mm, not %g", i, projection,
                             pixel, (double)lengths.values[pixel], expected);
            }
            plane_release(&lengths);
            scene_release(&scene);
        }
    tree_release(&tree);
}

/* ---- volumes --------------------------------------------------------------------------------- */

static double volume_seen(const Tree *tree, const GeometryParams *params, NamedView view)
{
    enum { SIDE = 120 };
    Scene scene = scene_of(tree, params, view, PROJECTION_ORTHOGRAPHIC, SIDE);
    Plane lengths = draw_lengths(&scene);
    double volume = 0, pixel_mm = vec3_length(scene.view.camera.up) / SIDE;
    for (int i = 0; i < SIDE * SIDE; i++)
        volume += (double)lengths.values[i] * pixel_mm * pixel_mm;
    plane_release(&lengths);
    scene_release(&scene);
    return volume;
}

static void every_model_has_the_same_volume_from_all_sides(void **state)
{
    (void)state;
    Tree tree;
    make_tree(&tree);
    for (int model = 0; model < SCENE_MODELS; model++) {
        const GeometryParams params = {.model = (SceneModel)model,
                                       .part_overlaps = true,
                                       .mesh = {.tolerance = 0.05, .threads = 1}};
        double front = volume_seen(&tree, &params, VIEW_FRONT);
        double top = volume_seen(&tree, &params, VIEW_TOP);
        double left = volume_seen(&tree, &params, VIEW_LEFT);
        if (fabs(front / top - 1) > 0.005 || fabs(left / top - 1) > 0.005)
            fail_msg("%s: %g, %g and %g mm3", models[model].name, front, top, left);
    }
    tree_release(&tree);
}

/* A joint between two circles of one axis is a cone cut off, h pi (a^2 + a b + b^2) / 3. */
static void a_straight_joint_is_a_cone(void **state)
{
    (void)state;
    const Primitive cone = {.kind = PRIMITIVE_JOINT,
                            .a = {0, 0, 0},
                            .b = {0, 0, 3},
                            .radius_mm = 2.385,
                            .radius_b_mm = 1.1,
                            .axes = (const Vec3[]){{0, 0, 1}, {0, 0, 1}}};
    const PrimitiveFrame frame = primitive_frame(&cone);
    double volume = 0, step = 0.02;
    for (double y = -3 + step / 2; y < 3; y += step)
        for (double z = -1 + step / 2; z < 4; z += step) {
            RayInterval stretches[3];
            int n = primitive_inside(&cone, &frame, (Ray){{-9, y, z}, {1, 0, 0}}, stretches);
            volume += intervals_length(stretches, (size_t)n) * step * step;
        }
    double expected =
        3.14159265358979323846 * (2.385 * 2.385 + 2.385 * 1.1 + 1.1 * 1.1); /* h = 3 */
    assert_true(fabs(volume / expected - 1) < 2e-3);
}

static void stretches_that_overlap_count_once(void **state)
{
    (void)state;
    RayInterval stretches[] = {{5, 6.5}, {1, 2}, {1.5, 3.25}, {2, 2.5}, {6.5, 7}};
    assert_true(intervals_length(stretches, 5) == 2.25 + 2);
    assert_true(intervals_length(stretches, 0) == 0);
}

static void a_camera_inside_a_vessel_sees_what_is_before_it(void **state)
{
    (void)state;
    static const SceneModel kinds[] = {SCENE_ROUNDED, SCENE_ISOSURFACE};
    Tree tree;
    assert_int_equal(tree_init(&tree, 2, NULL), STATUS_OK);
    for (int32_t i = 0; i < 2; i++) {
        tree.parent[i] = i - 1;
        tree.id[i] = i + 1;
        tree.radius_mm[i] = 2.385;
        tree.position[i] = vec3(i ? 40 : -40, 0, 0);
    }
    for (int i = 0; i < 2; i++) {
        StageParams params = {{.model = kinds[i]}, view_defaults()};
        Scene scene;
        params.view.projection = PROJECTION_PERSPECTIVE;
        params.view.has_location = params.view.has_look_at = true;
        params.view.location = vec3(0, 0, 1);
        params.view.width = params.view.height = 9;
        params.view.angle_deg = 1;
        assert_int_equal(stage_all(&tree, &film, &params, &scene, NULL, &err), STATUS_OK);
        Plane lengths = draw_lengths(&scene);
        assert_true(fabs((double)lengths.values[40] - 3.385) < 1e-3);
        plane_release(&lengths);
        scene_release(&scene);
    }
    tree_release(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stretches_that_overlap_count_once),
        cmocka_unit_test(a_straight_joint_is_a_cone),
        cmocka_unit_test(lengths_are_those_of_places_inside),
        cmocka_unit_test(every_model_has_the_same_volume_from_all_sides),
        cmocka_unit_test(a_camera_inside_a_vessel_sees_what_is_before_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
