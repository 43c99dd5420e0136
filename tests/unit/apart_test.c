/* The distance between the trees of a forest, compared with all pairs of segments by another
 * formula. */
#include "unit.h"

#include <stdlib.h>
#include <string.h>

#include "test_grow.h"
#include "tree_promises.h"

static Tree forest(const char *spec, double clearance)
{
    const Vec3 inlet[] = {{0, 29.5, 0}, {4.5, -28, 0}, {-27, 3, 0}};
    GrowParams params = grow_defaults();
    params.terminals = 220;
    params.inlets = 3;
    params.inlet = inlet;
    params.blood.q_perf_ml_min = 90;
    params.clearance_mm = clearance;
    return test_grown_by(&params, spec);
}

/* By all pairs. */
static double apart_by_pairs(const Tree *tree)
{
    double least = INFINITY;
    int32_t *root = calloc(tree->n, sizeof *root);
    assert_non_null(root);
    for (size_t i = 0; i < tree->n; i++) {
        root[i] = tree_is_segment(tree, i) ? root[tree->parent[i]] : (int32_t)i;
        for (size_t j = 0; j < i && tree_is_segment(tree, i); j++)
            if (tree_is_segment(tree, j) && root[i] != root[j])
                least = fmin(least,
                             segment_distance(tree->position[tree->parent[i]], tree->position[i],
                                              tree->position[tree->parent[j]], tree->position[j]) -
                                 tree->radius_mm[i] - tree->radius_mm[j]);
    }
    free(root);
    return least;
}

static void trees_are_as_far_apart_as_their_nearest_pair(void **state)
{
    (void)state;
    const char *const spec[] = {"disc:30", "ball:30"};
    for (int k = 0; k < 4; k++) {
        Tree tree = forest(spec[k % 2], k / 2 * 1.25);
        double apart, by_pairs = apart_by_pairs(&tree);
        size_t pair[2];
        assert_int_equal(trees_wall_distance(&tree, 50, &apart, pair, NULL), STATUS_OK);
        assert_true(fabs(apart - by_pairs) < 1e-6);
        assert_true(apart >= k / 2 * 1.25);
        assert_int_equal(trees_wall_distance(&tree, by_pairs / 2, &apart, pair, NULL), STATUS_OK);
        assert_true(isinf(apart));
        tree_release(&tree);
    }
}

/* Two segments, of two trees, that are 3 mm apart where the one is s of its way on and the other t:
 * everywhere from end to end, also close to an end. */
static void trees_are_nearest_wherever_their_segments_cross(void **state)
{
    (void)state;
    static const double parts[] = {0, 0.01, 0.07, 0.13, 0.5, 0.86, 0.95, 0.99, 1};
    enum { PARTS = sizeof parts / sizeof *parts };
    for (int k = 0; k < 2 * PARTS * PARTS; k++) {
        double s = parts[k % PARTS], t = parts[k / PARTS % PARTS];
        Vec3 one = vec3(10, 0, 0), other = vec3_scale(vec3(4, 9, 0), k < PARTS * PARTS ? 1 : -1);
        Vec3 a = vec3_scale(one, -s), c = vec3_add_scaled(vec3(0, 0, 3), other, -t);
        Vec3 position[] = {a, vec3_add(a, one), c, vec3_add(c, other)};
        int32_t id[] = {1, 2, 3, 4}, parent[] = {-1, 0, -1, 2};
        double radius[] = {0.5, 0.5, 0.25, 0.25}, apart;
        const Tree tree = {
            .n = 4, .id = id, .parent = parent, .position = position, .radius_mm = radius};
        size_t pair[2];
        Err err = {""};
        must(trees_wall_distance(&tree, 50, &apart, pair, &err), &err);
        assert_true(fabs(apart - 2.25) < 1e-12);
        assert_int_equal(trees_prove_clearance(&tree, 2.2, 50, "", &apart, &err), STATUS_OK);
        assert_int_equal(trees_prove_clearance(&tree, 2.3, 50, "", &apart, &err),
                         STATUS_INFEASIBLE);
        assert_non_null(strstr(err.text, "nodes 2 and 4, of different trees, are 2.25 mm apart"));
    }
}

/* The clearance asked for is nearly all that the trees have, so that moves run into it. */
static void refined_trees_keep_their_clearance(void **state)
{
    (void)state;
    const GrowRefine level[] = {GROW_REFINE_GEOMETRY, GROW_REFINE_TOPOLOGY};
    const char *const spec[] = {"ball:30", "disc:30"};
    for (int k = 0; k < 2; k++) {
        Err err = {""};
        Tree tree = forest(spec[k], 1.25);
        double clearance = apart_by_pairs(&tree) - 1e-3;
        meta_set_number(&tree.meta, META_CLEARANCE, clearance);
        RefineParams params = {.level = level[k], .moves = 4000, .seed = 5};
        RefineReport report;
        if (refine_tree(&params, NULL, &tree, &report, &err) != STATUS_OK)
            fail_msg("%s", err.text);
        assert_true(report.target_after < 0.99 * report.target_before);
        assert_true(report.apart_mm >= clearance);
        assert_true(apart_by_pairs(&tree) >= clearance - 1e-6);
        tree_release(&tree);
    }
}

static void trees_that_are_too_near_are_not_refined(void **state)
{
    (void)state;
    Err err = {""};
    Tree tree = forest("disc:30", 1.25);
    Vec3 last = tree.position[tree.n - 1];
    meta_set_number(&tree.meta, META_CLEARANCE, apart_by_pairs(&tree) + 1e-3);
    RefineParams params = {.level = GROW_REFINE_GEOMETRY};
    assert_int_equal(refine_tree(&params, NULL, &tree, NULL, &err), STATUS_INFEASIBLE);
    assert_non_null(strstr(err.text, "as the trees are, `clearance_mm` "));
    assert_true(vec3_distance(last, tree.position[tree.n - 1]) == 0);
    tree_release(&tree);
}

static void vessels_that_overlap_are_less_than_nothing_apart(void **state)
{
    (void)state;
    Tree tree;
    assert_int_equal(tree_init(&tree, 4, NULL), STATUS_OK);
    const Vec3 at[] = {{-5, 0, 0}, {5, 0, 0.5}, {0, -4, 1.5}, {0, 6, 1.5}};
    for (size_t i = 0; i < 4; i++) {
        tree.position[i] = at[i];
        tree.radius_mm[i] = 0.85;
        tree.parent[i] = i % 2 ? (int32_t)i - 1 : TREE_NO_PARENT;
    }
    double apart;
    size_t pair[2];
    assert_int_equal(trees_wall_distance(&tree, 1, &apart, pair, NULL), STATUS_OK);
    double expected = segment_distance(at[0], at[1], at[2], at[3]) - 1.7;
    assert_true(apart < 0 && fabs(apart - expected) < 1e-6);
    assert_int_equal(pair[0], 1);
    assert_int_equal(pair[1], 3);
    tree_release(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trees_are_as_far_apart_as_their_nearest_pair),
        cmocka_unit_test(trees_are_nearest_wherever_their_segments_cross),
        cmocka_unit_test(refined_trees_keep_their_clearance),
        cmocka_unit_test(trees_that_are_too_near_are_not_refined),
        cmocka_unit_test(vessels_that_overlap_are_less_than_nothing_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
