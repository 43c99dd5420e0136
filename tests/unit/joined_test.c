/* The model `joined`: cuts, joints, and the nodes that have none. */
#include "stage/stage.h"
#include "unit.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "test_search.h"
#include "test_stage.h"

static const Look look = {.color = {0.5f, 0.1f, 0.2f},
                          .finish = {.ambient = 0.1f, .diffuse = 0.6f, .brilliance = 1},
                          .lights = {{.direction = {1, 2, 3}, .color = {1, 1, 1}}},
                          .n_lights = 1};

static double number(Random *random, double low, double high)
{
    return low + (high - low) * random_uniform(random);
}

static Tree tree_of(size_t n, const int32_t *parents, const Vec3 *places, const double *radii)
{
    Tree tree;
    assert_int_equal(tree_init(&tree, n, NULL), STATUS_OK);
    for (size_t i = 0; i < n; i++) {
        tree.id[i] = (int32_t)i + 1;
        tree.parent[i] = parents[i];
        tree.position[i] = places[i];
        tree.radius_mm[i] = radii[i];
    }
    return tree;
}

static Scene stage(const Tree *tree, JointForm joints, StageReport *report)
{
    StageParams params = stage_defaults();
    params.geometry.model = SCENE_JOINED;
    params.geometry.joints = joints;
    Scene scene;
    Err err = {{0}};
    must(stage_all(tree, &look, &params, &scene, report, &err), &err);
    return scene;
}

static size_t count(const Scene *scene, PrimitiveKind kind)
{
    size_t n = 0;
    for (size_t i = 0; i < scene->geometry.n_primitives; i++)
        n += scene->geometry.primitives[i].kind == kind;
    return n;
}

/* A trunk down the y axis that splits into daughters of 1.2 and 0.8, with room for all. */
static Tree bifurcation(Vec3 left)
{
    return tree_of(4, (const int32_t[]){-1, 0, 1, 1},
                   (const Vec3[]){{0, 20, 0}, {0, 5, 0}, left, {9, -4, 1}},
                   (const double[]){1.5, 1.5, 1.2, 0.8});
}

static void joints_lead_from_the_rim_of_the_parent_to_those_of_the_daughters(void **state)
{
    (void)state;
    Tree tree = bifurcation(vec3(-6, -8, 2));
    StageReport report;
    Scene scene = stage(&tree, JOINTS_ROBUST, &report);
    assert_int_equal(report.joints, 2);
    assert_int_equal(report.junctions_short + report.junctions_sharp, 0);
    assert_int_equal(count(&scene, PRIMITIVE_CYLINDER), 3);
    for (size_t k = 0; k < 2; k++) {
        const Primitive *joint = &scene.geometry.primitives[3 + k],
                        *daughter = &scene.geometry.primitives[1 + k];
        const Primitive *parent = &scene.geometry.primitives[0];
        assert_int_equal(joint->kind, PRIMITIVE_JOINT);
        assert_int_equal(scene.geometry.ids[joint->segment], 3 + k);
        assert_true(vec3_distance(joint->a, parent->b) == 0);
        assert_true(vec3_distance(joint->b, daughter->a) == 0);
        assert_true(joint->radius_mm == 1.5 && joint->radius_b_mm == tree.radius_mm[2 + k]);
        assert_true(fabs(joint->axes[0].y + 1) < 1e-15);
        Vec3 along = vec3_normalized(vec3_sub(daughter->b, daughter->a));
        assert_true(vec3_distance(joint->axes[1], along) < 1e-12);
        assert_true(vec3_distance(daughter->b, tree.position[2 + k]) == 0);
    }
    scene_release(&scene);
    tree_release(&tree);
}

static void each_disc_of_a_joint_lies_on_one_side_of_the_other(void **state)
{
    (void)state;
    Tree tree = bifurcation(vec3(-6, 1, 2));
    Scene scene = stage(&tree, JOINTS_ROBUST, NULL);
    for (size_t i = 0; i < scene.geometry.n_primitives; i++) {
        const Primitive *joint = &scene.geometry.primitives[i];
        if (joint->kind != PRIMITIVE_JOINT)
            continue;
        double sine = vec3_length(vec3_cross(joint->axes[0], joint->axes[1]));
        Vec3 span = vec3_sub(joint->b, joint->a);
        assert_true(vec3_dot(span, joint->axes[0]) - joint->radius_b_mm * sine > -1e-12);
        assert_true(vec3_dot(span, joint->axes[1]) - joint->radius_mm * sine > -1e-12);
    }
    scene_release(&scene);
    tree_release(&tree);
}

static void a_straight_place_needs_no_joint(void **state)
{
    (void)state;
    Tree tree =
        tree_of(3, (const int32_t[]){-1, 0, 1}, (const Vec3[]){{0, 9, 0}, {0, 5, 0}, {0, -3, 0}},
                (const double[]){1.5, 1.5, 1.2});
    StageReport report;
    Scene scene = stage(&tree, JOINTS_ROBUST, &report);
    assert_int_equal(report.joints + report.junctions_short + report.junctions_sharp, 0);
    assert_int_equal(scene.geometry.n_primitives, 2);
    assert_true(scene.geometry.primitives[0].b.y == 5 && scene.geometry.primitives[1].a.y == 5);
    scene_release(&scene);
    tree_release(&tree);
}

static void where_a_vessel_is_too_short_the_place_is_round(void **state)
{
    (void)state;
    Tree tree = bifurcation(vec3(-0.4, 4.7, 0));
    StageReport report;
    Scene scene = stage(&tree, JOINTS_ROBUST, &report);
    assert_int_equal(report.junctions_short, 1);
    assert_int_equal(report.joints, 0);
    assert_int_equal(count(&scene, PRIMITIVE_CYLINDER), 3);
    assert_int_equal(count(&scene, PRIMITIVE_SPHERE), 1);
    for (size_t i = 0; i < 3; i++)
        assert_true(
            vec3_distance(scene.geometry.primitives[i].a, tree.position[tree.parent[i + 1]]) == 0);
    assert_true(scene.geometry.primitives[3].radius_mm == 1.5);
    assert_int_equal(scene.geometry.ids[scene.geometry.primitives[3].segment], 2);
    scene_release(&scene);
    tree_release(&tree);
}

static void where_a_vessel_turns_back_the_place_is_round(void **state)
{
    (void)state;
    Tree tree = bifurcation(vec3(-9, 20, 0));
    StageReport report;
    Scene scene = stage(&tree, JOINTS_ROBUST, &report);
    assert_int_equal(report.junctions_sharp, 1);
    assert_int_equal(report.junctions_short, 0);
    assert_int_equal(count(&scene, PRIMITIVE_SPHERE), 1);
    scene_release(&scene);
    scene = stage(&tree, JOINTS_PAPER, &report);
    assert_int_equal(report.junctions_sharp, 1);
    assert_int_equal(report.joints, 2);
    assert_int_equal(count(&scene, PRIMITIVE_SPHERE), 0);
    scene_release(&scene);
    tree_release(&tree);
}

static void a_place_is_round_from_60_degrees_to_the_trunk_on(void **state)
{
    (void)state;
    for (int round = 0; round < 2; round++) {
        double angle = (round ? 59.9 : 60.1) * 3.14159265358979323846 / 180;
        Tree tree = tree_of(
            4, (const int32_t[]){-1, 0, 1, 1},
            (const Vec3[]){
                {0, 30, 0}, {0, 0, 0}, {40 * sin(angle), 40 * cos(angle), 0}, {-30, -30, 1}},
            (const double[]){1.5, 1.5, 1.2, 0.8});
        StageReport report;
        Scene scene = stage(&tree, JOINTS_ROBUST, &report);
        assert_int_equal(report.junctions_sharp, round);
        assert_int_equal(report.joints, round ? 0 : 2);
        scene_release(&scene);
        tree_release(&tree);
    }
}

/* Two bends of 90 degrees, each of which cuts the vessel between them by its radius: 2.6 mm in
 * all. */
static void two_places_share_a_vessel_down_to_a_thousandth_of_it(void **state)
{
    (void)state;
    for (int fits = 0; fits < 2; fits++) {
        double length = 2.6 / (fits ? 0.9989 : 0.9991);
        Tree tree = tree_of(4, (const int32_t[]){-1, 0, 1, 2},
                            (const Vec3[]){{0, 20, 0}, {0, 0, 0}, {length, 0, 0}, {length, 0, 20}},
                            (const double[]){1.3, 1.3, 1.3, 1.3});
        StageReport report;
        Scene scene = stage(&tree, JOINTS_ROBUST, &report);
        assert_int_equal(report.junctions_short, !fits);
        assert_int_equal(report.joints, 1 + fits);
        scene_release(&scene);
        tree_release(&tree);
    }
}

static void to_the_letter_a_vessel_that_is_too_short_vanishes_into_its_joints(void **state)
{
    (void)state;
    Tree tree = bifurcation(vec3(-0.4, 4.7, 0));
    StageReport report;
    Scene scene = stage(&tree, JOINTS_PAPER, &report);
    assert_int_equal(report.junctions_short, 1);
    assert_int_equal(report.joints, 2);
    assert_int_equal(count(&scene, PRIMITIVE_CYLINDER), 2);
    for (size_t i = 0; i < scene.geometry.n_primitives; i++)
        if (scene.geometry.primitives[i].kind == PRIMITIVE_JOINT &&
            scene.geometry.ids[scene.geometry.primitives[i].segment] == 3)
            assert_true(vec3_distance(scene.geometry.primitives[i].b, tree.position[2]) < 1e-12);
    scene_release(&scene);
    tree_release(&tree);
}

static void a_vessel_between_two_places_keeps_the_joint_that_needs_less(void **state)
{
    (void)state;
    /* Both bends ask for more than half of the vessel between them, the second for less. */
    Tree tree = tree_of(4, (const int32_t[]){-1, 0, 1, 2},
                        (const Vec3[]){{-9, 4.5, 0}, {0, 0, 0}, {1, 0, 0}, {9, -3.7, 0}},
                        (const double[]){2.6, 2.6, 2.6, 2.6});
    StageReport report;
    Scene scene = stage(&tree, JOINTS_ROBUST, &report);
    assert_int_equal(report.joints, 1);
    assert_int_equal(report.junctions_short, 1);
    for (size_t i = 0; i < scene.geometry.n_primitives; i++)
        if (scene.geometry.primitives[i].kind == PRIMITIVE_SPHERE)
            assert_true(scene.geometry.primitives[i].a.x == 0);
    scene_release(&scene);
    tree_release(&tree);
}

static void where_trees_begin_the_thickest_vessel_is_the_trunk(void **state)
{
    (void)state;
    Tree tree = tree_of(4, (const int32_t[]){-1, 0, 0, 0},
                        (const Vec3[]){{0, 0, 0}, {9, 0, 0}, {-9, 1, 0}, {0, 2, 12}},
                        (const double[]){1, 0.9, 1.4, 1.1});
    StageReport report;
    Scene scene = stage(&tree, JOINTS_ROBUST, &report);
    assert_int_equal(report.joints, 2);
    for (size_t i = 3; i < 5; i++) {
        assert_true(scene.geometry.primitives[i].radius_mm == 1.4);
        assert_int_equal(scene.geometry.ids[scene.geometry.primitives[i].segment], i == 3 ? 2 : 4);
    }
    scene_release(&scene);
    tree_release(&tree);
}

static void of_equally_thick_vessels_the_first_is_the_trunk(void **state)
{
    (void)state;
    Tree tree = tree_of(4, (const int32_t[]){-1, 0, 0, 0},
                        (const Vec3[]){{0, 0, 0}, {9, 0, 0}, {-9, 1, 0}, {0, 2, 12}},
                        (const double[]){1, 0.9, 1.4, 1.4});
    StageReport report;
    Scene scene = stage(&tree, JOINTS_ROBUST, &report);
    assert_int_equal(report.joints, 2);
    assert_int_equal(scene.geometry.ids[scene.geometry.primitives[3].segment], 2);
    assert_int_equal(scene.geometry.ids[scene.geometry.primitives[4].segment], 4);
    scene_release(&scene);
    tree_release(&tree);
}

/* A tree that obeys no law: vessels of any direction, many of them shorter than wide. */
static Tree throw_tree(Random *random, size_t n)
{
    Tree tree;
    assert_int_equal(tree_init(&tree, n, NULL), STATUS_OK);
    for (size_t i = 0; i < n; i++) {
        size_t parent = i ? (size_t)number(random, 0, (double)i) : 0;
        double x = number(random, -1, 1), y = number(random, -1, 1);
        Vec3 step = vec3(x, y, number(random, -1, 1));
        double scale = i % 4 ? number(random, 1, 9) : number(random, 0, 1);
        tree.id[i] = (int32_t)i + 1;
        tree.parent[i] = i ? (int32_t)parent : TREE_NO_PARENT;
        tree.position[i] = vec3_add_scaled(tree.position[parent], step, i ? scale : 0);
        tree.radius_mm[i] = i ? tree.radius_mm[parent] * number(random, 0.6, 1) : 1.5;
    }
    return tree;
}

/* The first thing that a ray from outside meets is the outside of a vessel: where a joint were open
 * or turned inside out, it would be an inside. */
static void no_ray_sees_the_inside_of_a_robust_tree(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 71);
    size_t seen = 0, joints = 0, round = 0;
    for (int k = 0; k < 40; k++) {
        Tree tree = throw_tree(&random, 25);
        StageReport report;
        Scene scene = stage(&tree, JOINTS_ROBUST, &report);
        joints += report.joints;
        round += report.junctions_short + report.junctions_sharp;
        TestSearch search = testsearch_open(&primitive_search, &scene.geometry, NULL);
        Vec3 size = vec3_sub(scene.geometry.bounds.high, scene.geometry.bounds.low);
        for (int i = 0; i < 4000; i++) {
            double u = random_uniform(&random), v = random_uniform(&random);
            double w = random_uniform(&random);
            Vec3 target = vec3(scene.geometry.bounds.low.x + u * size.x,
                               scene.geometry.bounds.low.y + v * size.y,
                               scene.geometry.bounds.low.z + w * size.z);
            double x = number(&random, -1, 1), y = number(&random, -1, 1);
            Vec3 direction = vec3_normalized(vec3(x, y, number(&random, 0.1, 1)));
            Ray ray = {vec3_add_scaled(target, direction, -200), direction};
            RayHit hit;
            if (!testsearch_first(&search, ray, 0, INFINITY, &hit))
                continue;
            seen++;
            if (vec3_dot(hit.normal, direction) > 0)
                fail_msg("tree %d, ray %d sees the inside of primitive %u", k, i, hit.index);
        }
        testsearch_close(&search);
        scene_release(&scene);
        tree_release(&tree);
    }
    assert_true(seen > 20000);
    assert_true(joints > 100 && round > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(joints_lead_from_the_rim_of_the_parent_to_those_of_the_daughters),
        cmocka_unit_test(each_disc_of_a_joint_lies_on_one_side_of_the_other),
        cmocka_unit_test(a_straight_place_needs_no_joint),
        cmocka_unit_test(where_a_vessel_is_too_short_the_place_is_round),
        cmocka_unit_test(where_a_vessel_turns_back_the_place_is_round),
        cmocka_unit_test(a_place_is_round_from_60_degrees_to_the_trunk_on),
        cmocka_unit_test(two_places_share_a_vessel_down_to_a_thousandth_of_it),
        cmocka_unit_test(to_the_letter_a_vessel_that_is_too_short_vanishes_into_its_joints),
        cmocka_unit_test(a_vessel_between_two_places_keeps_the_joint_that_needs_less),
        cmocka_unit_test(where_trees_begin_the_thickest_vessel_is_the_trunk),
        cmocka_unit_test(of_equally_thick_vessels_the_first_is_the_trunk),
        cmocka_unit_test(no_ray_sees_the_inside_of_a_robust_tree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
