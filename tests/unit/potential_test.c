/* The effects of the potential on vessels, in numbers (docs/METHODS.md, section 2.4), and the
 * differences with --potential graph. */
#include "render/render.h"
#include "stage/stage.h"
#include "unit.h"

#include <stdint.h>
#include <stdlib.h>

#include "field_scenes.h"
#include "test_search.h"
#include "test_stage.h"

static TestScene empty_scene(void)
{
    TestScene test;
    memset(&test, 0, sizeof test);
    test.geometry.model = SCENE_ISOSURFACE;
    return test;
}

/* Where a ray from far outside towards `center` first meets the surface: the distance from there,
 * or -1 without a hit. */
static double radius_towards(const Geometry *geometry, Vec3 center, Vec3 outwards)
{
    uint32_t all[2 * MAX_SEGMENTS];
    RayHit hit;
    assert_true(geometry->n_segments <= sizeof all / sizeof *all);
    TestSearch search = testsearch_among(&field_search, geometry, all, geometry->n_segments);
    for (uint32_t i = 0; i < geometry->n_segments; i++)
        all[i] = i;
    Vec3 d = vec3_normalized(outwards);
    Ray ray = {vec3_add_scaled(center, d, 50), vec3_scale(d, -1)};
    bool found = testsearch_first(&search, ray, 0, 100, &hit);
    testsearch_close(&search);
    return found ? 50 - hit.t : -1;
}

/* Segments from the origin into the plane z = 0, at equal angles; their radius across that
 * plane. */
static double joint_radius(const double *radii, int n)
{
    TestScene test = empty_scene();
    test.geometry.segments = test.segments;
    for (int i = 0; i < n; i++) {
        double angle = 6.283185307179586 * i / n;
        put_segment(&test, vec3(0, 0, 0), vec3(30 * cos(angle), 30 * sin(angle), 0), radii[i]);
    }
    return radius_towards(&test.geometry, vec3(0, 0, 0), vec3(0, 0, 1));
}

static void free_ends_overshoot_by_half_a_radius(void **state)
{
    (void)state;
    TestScene test = empty_scene();
    test.geometry.segments = test.segments;
    put_segment(&test, vec3(-20, 0, 0), vec3(0, 0, 0), 1.7);
    double length = radius_towards(&test.geometry, vec3(0, 0, 0), vec3(1, 0, 0));
    assert_true(fabs(length / 1.7 - 0.5508) < 1e-4);
}

static void short_segments_shrink_and_vanish(void **state)
{
    (void)state;
    const struct {
        double length, radius;
    } cases[] = {{0.16, -1}, {0.1703, -1}, {0.1706, 0.0216}, {0.5, 0.722},
                 {1, 0.900}, {2, 0.988},   {4, 1.000}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        TestScene test = empty_scene();
        test.geometry.segments = test.segments;
        put_segment(&test, vec3(-cases[i].length / 2, 0, 0), vec3(cases[i].length / 2, 0, 0), 1);
        double radius = radius_towards(&test.geometry, vec3(0, 0, 0), vec3(0, 0, 1));
        assert_true(fabs(radius - cases[i].radius) < 1e-3);
        size_t vanished;
        assert_int_equal(surface_count_missing(&test.geometry, &vanished, NULL), STATUS_OK);
        assert_int_equal(vanished, cases[i].radius < 0);
    }
}

static void short_segments_of_a_chain_do_not_vanish(void **state)
{
    (void)state;
    TestScene test = empty_scene();
    test.geometry.segments = test.segments;
    for (int i = 0; i < 50; i++)
        put_segment(&test, vec3(0.1 * i, 0, 0), vec3(0.1 * (i + 1), 0, 0), 1);
    size_t vanished;
    assert_int_equal(surface_count_missing(&test.geometry, &vanished, NULL), STATUS_OK);
    assert_int_equal(vanished, 0);
}

/* Together 0.172 r long, they reach the level half way along the first, but not along the
 * second. */
static void what_vanishes_is_counted_half_way_along(void **state)
{
    (void)state;
    TestScene test = empty_scene();
    test.geometry.segments = test.segments;
    put_segment(&test, vec3(0, 0, 0), vec3(0.16, 0, 0), 1);
    put_segment(&test, vec3(0.16, 0, 0), vec3(0.172, 0, 0), 1);
    size_t vanished;
    assert_int_equal(surface_count_missing(&test.geometry, &vanished, NULL), STATUS_OK);
    assert_int_equal(vanished, 1);
}

static void joints_bulge_and_neck(void **state)
{
    (void)state;
    const double equal[] = {1, 1, 1, 1};
    assert_true(fabs(joint_radius(equal, 2) - 1) < 1e-9);
    assert_true(fabs(joint_radius(equal, 3) - 1.097) < 1e-3);
    assert_true(fabs(joint_radius(equal, 4) - 1.160) < 1e-3);
    const double gamma3[] = {1, 0.793701, 0.793701}, gamma2[] = {1, 0.707107, 0.707107};
    assert_true(fabs(joint_radius(gamma3, 3) - 0.956) < 1e-3);
    assert_true(fabs(joint_radius(gamma2, 3) - 0.904) < 1e-3);
    const double twig[] = {1, 0.98, 0.3};
    assert_true(fabs(joint_radius(twig, 3) - 0.990) < 1e-3);
}

static void parallel_vessels_merge_below_a_third_of_a_radius(void **state)
{
    (void)state;
    for (int merged = 0; merged < 2; merged++) {
        TestScene test = empty_scene();
        test.geometry.segments = test.segments;
        double y = 1.3 * (2 + (merged ? 0.320 : 0.322)) / 2;
        put_segment(&test, vec3(-20, y, 0), vec3(20, y, 0), 1.3);
        put_segment(&test, vec3(-20, -y, 0), vec3(20, -y, 0), 1.3);
        assert_int_equal(radius_towards(&test.geometry, vec3(0, 0, 0), vec3(0, 0, 1)) > -1, merged);
    }
}

/* A root of two vessels that run side by side, almost touching, to x = 20. */
static void make_hairpin(Tree *tree)
{
    const Vec3 places[] = {{-20, 0, 0},  {-10, 0, 0},  {0, 1.1, 0},
                           {20, 1.1, 0}, {0, -1.1, 0}, {20, -1.1, 0}};
    const int32_t parents[] = {-1, 0, 1, 2, 1, 4};
    assert_int_equal(tree_init(tree, 6, NULL), STATUS_OK);
    for (int i = 0; i < 6; i++) {
        tree->id[i] = i + 1;
        tree->parent[i] = parents[i];
        tree->position[i] = places[i];
        tree->radius_mm[i] = 1;
    }
}

static Scene staged_hairpin(bool graph)
{
    Tree tree;
    Scene scene;
    Look look = {0};
    StageParams params = stage_defaults();
    params.geometry.model = SCENE_ISOSURFACE;
    params.view.width = 200;
    params.view.height = 120;
    params.geometry.graph = graph;
    make_hairpin(&tree);
    assert_int_equal(stage_all(&tree, &look, &params, &scene, NULL, NULL), STATUS_OK);
    tree_release(&tree);
    return scene;
}

static void the_graph_keeps_strangers_apart(void **state)
{
    (void)state;
    Scene paper = staged_hairpin(false), graph = staged_hairpin(true);
    Vec3 gap = vec3(15, 0, 0), joint = vec3(-10, 0, 0), up = vec3(0, 0, 1);
    assert_true(radius_towards(&paper.geometry, gap, up) > 0);
    assert_true(radius_towards(&graph.geometry, gap, up) < 0);
    assert_true(fabs(radius_towards(&graph.geometry, joint, up) -
                     radius_towards(&paper.geometry, joint, up)) < 1e-6);
    Vec3 beside = vec3(10, 1.1, 0);
    assert_true(fabs(radius_towards(&graph.geometry, beside, up) - 1) < 1e-6);
    scene_release(&paper);
    scene_release(&graph);
}

/* Whether two segments are in one group. */
static bool blend_somewhere(const Geometry *geometry, uint32_t one, uint32_t other)
{
    const Blend *blend = &geometry->blend;
    for (size_t group = 0; group < blend->n_groups; group++)
        if (indexlists_hold(&blend->members, group, one) &&
            indexlists_hold(&blend->members, group, other))
            return true;
    return false;
}

/* The ends of the hairpin are part of other groups. */
static void the_graph_has_a_group_for_each_node_that_no_other_holds(void **state)
{
    (void)state;
    Scene scene = staged_hairpin(true);
    assert_int_equal(scene.geometry.blend.n_groups, 3);
    for (uint32_t i = 0; i < 5; i++)
        for (uint32_t j = 0; j < i; j++) {
            bool strangers = (j == 0 && (i == 2 || i == 4)) || (j == 1 && i == 4) || (j == 2);
            assert_int_equal(blend_somewhere(&scene.geometry, i, j), !strangers);
        }
    scene_release(&scene);
}

/* Stages a tree whose nodes follow each other but for those whose parents are given. */
static Geometry staged_graph(const Vec3 *places, const double *radii, const int32_t *parents, int n)
{
    Tree tree;
    Geometry geometry;
    GeometryParams params = stage_defaults().geometry;
    params.model = SCENE_ISOSURFACE;
    params.graph = true;
    assert_int_equal(tree_init(&tree, (size_t)n, NULL), STATUS_OK);
    for (int i = 0; i < n; i++) {
        tree.id[i] = i + 1;
        tree.parent[i] = parents ? parents[i] : i - 1;
        tree.position[i] = places[i];
        tree.radius_mm[i] = radii[i];
    }
    assert_int_equal(stage_geometry(&tree, &params, &geometry, NULL, NULL), STATUS_OK);
    tree_release(&tree);
    return geometry;
}

/* A vessel of 1.3 mm blends with what begins 2.6 mm on. */
static void the_graph_joins_up_to_two_radii_away(void **state)
{
    (void)state;
    for (int within = 0; within < 2; within++) {
        const Vec3 places[] = {{-5, 0, 0}, {0, 0, 0}, {within ? 2.59 : 2.61, 0, 0}, {9, 0, 0}};
        const double radii[] = {1.3, 1.3, 0.7, 0.2};
        Geometry geometry = staged_graph(places, radii, NULL, 4);
        assert_int_equal(blend_somewhere(&geometry, 0, 2), within);
        assert_int_equal(geometry.blend.n_groups, within ? 1 : 2);
        geometry_release(&geometry);
    }
}

/* Two vessels, 0.2 of their radius apart, at both ends of a segment that joins them: far from it,
 * where the potential of both together would fill the gap, they are two. */
static void the_graph_does_not_bridge_what_a_short_segment_joins(void **state)
{
    (void)state;
    const double r = 1.3, far = 24;
    const Vec3 places[] = {{-far, 0, 0},    {0, 0, 0},         {far, 0, 0},
                           {0, 2.2 * r, 0}, {far, 2.2 * r, 0}, {-far, 2.2 * r, 0}};
    const double radii[] = {r, r, r, r, r, r};
    const int32_t parents[] = {-1, 0, 1, 1, 3, 3};
    Geometry graph = staged_graph(places, radii, parents, 6), paper = graph;
    paper.blend = (Blend){0};
    Vec3 gap = vec3(5.7, 1.1 * r, 0), beside = vec3(5.7, 0, 0), up = vec3(0, 0, 1);
    assert_true(radius_towards(&paper, gap, up) > 0.3 * r);
    assert_true(radius_towards(&graph, gap, up) < 0);
    assert_true(fabs(radius_towards(&graph, beside, up) - r) < 1e-6);
    geometry_release(&graph);
}

/* Steps of a tenth, a fifth and half of a radius leave the wall of a tube where it is. */
static void the_graph_does_not_starve_finely_sampled_chains(void **state)
{
    (void)state;
    const double r = 1.7, steps[] = {0.1, 0.2, 0.5};
    for (int k = 0; k < 3; k++) {
        int n = (int)lround(10 / steps[k]) + 1;
        Vec3 places[2 * MAX_SEGMENTS];
        double radii[2 * MAX_SEGMENTS], volume = 0, straight = 0;
        for (int i = 0; i < n; i++) {
            places[i] = vec3(i * steps[k] * r, 0, 0);
            radii[i] = r;
        }
        Geometry chain = staged_graph(places, radii, NULL, n);
        size_t vanished;
        assert_int_equal(surface_count_missing(&chain, &vanished, NULL), STATUS_OK);
        assert_int_equal(vanished, 0);
        Geometry tube = staged_graph((Vec3[]){places[0], places[n - 1]}, radii, NULL, 2);
        for (double x = -0.5; x < 10.5; x += 0.037) {
            Vec3 at = vec3(x * r, 0, 0), up = vec3(0, 0.6, 0.8);
            double is = radius_towards(&chain, at, up), should = radius_towards(&tube, at, up);
            assert_true(is <= should + 1e-9 && is >= should * (1 - 2e-3));
            assert_true(is >= should * (1 - 1e-4) || x < 0.2 || x > 9.8);
            volume += is * is;
            straight += should * should;
        }
        assert_true(volume / straight > 1 - 2e-4);
        geometry_release(&chain);
        geometry_release(&tube);
    }
}

static void the_picture_of_the_graph_is_that_of_single_rays(void **state)
{
    (void)state;
    Scene scene = staged_hairpin(true);
    const RenderParams params = {.threads = 2, .antialias = 1, .want_depth = true};
    Frame frame;
    assert_int_equal(render(&scene, &params, &frame, NULL, NULL), STATUS_OK);
    const uint32_t all[] = {0, 1, 2, 3, 4};
    TestSearch search = testsearch_among(&field_search, &scene.geometry, all, 5);
    int hits = 0;
    for (int pixel = 0; pixel < 200 * 120; pixel++) {
        Ray ray = camera_ray(&scene.view.camera, pixel % 200, pixel / 200);
        RayHit hit;
        bool found = testsearch_first(&search, ray, 0, HUGE_VAL, &hit);
        assert_int_equal(found, isfinite(frame.depth.values[pixel]));
        assert_true(!found || fabs((double)frame.depth.values[pixel] - hit.t) < 1e-3);
        hits += found;
    }
    assert_true(hits > 2000);
    testsearch_close(&search);
    frame_release(&frame);
    scene_release(&scene);
}

static double way_to_root(const Tree *tree, int32_t node)
{
    return tree->parent[node] < 0
               ? 0
               : tree_segment_length(tree, (size_t)node) + way_to_root(tree, tree->parent[node]);
}

/* Along the tree. */
static double way_between(const Tree *tree, int32_t a, int32_t b)
{
    for (int32_t up = a; up >= 0; up = tree->parent[up])
        for (int32_t other = b; other >= 0; other = tree->parent[other])
            if (up == other)
                return way_to_root(tree, a) + way_to_root(tree, b) - 2 * way_to_root(tree, up);
    return HUGE_VAL;
}

/* Whether the sum at any of the nodes reaches the level, from the definition. */
static bool is_in_graph(const Tree *tree, const Geometry *geometry, Vec3 x)
{
    for (int32_t node = 0; node < (int32_t)tree->n; node++) {
        double sum = 0;
        for (uint32_t i = 0; i < geometry->n_segments; i++) {
            const FieldSegment *segment = &geometry->segments[i];
            int32_t end = (int32_t)segment->segment;
            double way =
                fmin(way_between(tree, node, end), way_between(tree, node, tree->parent[end]));
            if (way <= 2 * segment->radius_mm)
                sum += potential_term(segment, x);
        }
        if (sum >= FIELD_LEVEL)
            return true;
    }
    return false;
}

/* From inside the union of bodies that overlap, the wall is that of the union. */
static void the_graph_is_left_where_all_its_bodies_are_left(void **state)
{
    (void)state;
    Tree tree;
    make_hairpin(&tree);
    Scene scene = staged_hairpin(true);
    const uint32_t all[] = {0, 1, 2, 3, 4};
    TestSearch search = testsearch_among(&field_search, &scene.geometry, all, 5);
    Random random;
    random_seed(&random, 74);
    for (int i = 0; i < 2000; i++) {
        const FieldSegment *in = &scene.geometry.segments[i % 5];
        Vec3 span = vec3_sub(in->b, in->a), d = random_direction(&random);
        Ray ray = {vec3_add_scaled(in->a, span, uniform(&random, 0.1, 0.9)), d};
        double step = 0.02 * in->radius_mm;
        RayHit hit;
        assert_true(testsearch_first(&search, ray, 0, HUGE_VAL, &hit));
        const double t = hit.t;
        for (double at = 0; at < t - 1e-6; at += step)
            assert_true(is_in_graph(&tree, &scene.geometry, ray_at(ray, at)));
        assert_true(is_in_graph(&tree, &scene.geometry, ray_at(ray, t - 1e-6)));
        assert_false(is_in_graph(&tree, &scene.geometry, ray_at(ray, t + 1e-6)));
    }
    testsearch_close(&search);
    tree_release(&tree);
    scene_release(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_ends_overshoot_by_half_a_radius),
        cmocka_unit_test(short_segments_shrink_and_vanish),
        cmocka_unit_test(short_segments_of_a_chain_do_not_vanish),
        cmocka_unit_test(what_vanishes_is_counted_half_way_along),
        cmocka_unit_test(joints_bulge_and_neck),
        cmocka_unit_test(parallel_vessels_merge_below_a_third_of_a_radius),
        cmocka_unit_test(the_graph_keeps_strangers_apart),
        cmocka_unit_test(the_graph_has_a_group_for_each_node_that_no_other_holds),
        cmocka_unit_test(the_graph_joins_up_to_two_radii_away),
        cmocka_unit_test(the_graph_does_not_bridge_what_a_short_segment_joins),
        cmocka_unit_test(the_graph_does_not_starve_finely_sampled_chains),
        cmocka_unit_test(the_picture_of_the_graph_is_that_of_single_rays),
        cmocka_unit_test(the_graph_is_left_where_all_its_bodies_are_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
