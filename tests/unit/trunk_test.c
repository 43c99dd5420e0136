/* Growth on a trunk with fixed radii, checked against Poiseuille's law by a separate traversal. */
#include "grow/grow.h"
#include "unit.h"

#include <stdlib.h>
#include <string.h>

#include "tree_promises.h"

/* A bent trunk of seven segments in the disc, two inlets if `inlets` is 2, radii of any kind. */
static Tree trunk(int inlets)
{
    static const struct {
        int32_t parent;
        double x, y, radius;
    } node[] = {{-1, 0, 49.5, 0},    {0, 1.5, 30.25, 1.85}, {1, -2, 11.5, 1.7},
                {2, -20.5, -4, 1.1}, {2, 17.25, -6, 1.3},   {3, -28, -22.5, 0.85},
                {-1, 3.5, -49, 0},   {6, 6, -31.5, 1.2},    {7, 1, -20.25, 0.9}};
    Tree tree;
    size_t n = inlets == 2 ? 9 : 6;
    assert_int_equal(tree_init(&tree, n, NULL), STATUS_OK);
    for (size_t i = 0; i < n; i++) {
        tree.parent[i] = node[i].parent;
        tree.position[i] = vec3(node[i].x, node[i].y, 0);
        tree.radius_mm[i] = node[i].radius;
        tree.type[i] = 3;
        tree.id[i] = 11 + 3 * (int32_t)i;
    }
    return tree;
}

static Status grow_on(const GrowParams *params, Tree *out, Err *err)
{
    Domain domain;
    assert_int_equal(domain_parse(&domain, "disc:50", NULL), STATUS_OK);
    return grow_tree(params, &domain, out, NULL, err);
}

/* The node of `tree` with this id. */
static size_t find(const Tree *tree, int32_t id)
{
    size_t i = 0;
    while (i < tree->n && tree->id[i] != id)
        i++;
    assert_true(i < tree->n);
    return i;
}

/* Marks what is part of the trunk in the grown tree, and asserts that its points and radii are the
 * trunk's, bit by bit. */
static bool *assert_kept(const Tree *trunk, const Tree *tree)
{
    bool *kept = calloc(tree->n, sizeof *kept);
    assert_non_null(kept);
    for (size_t i = 0; i < trunk->n; i++) {
        size_t at = find(tree, trunk->id[i]);
        assert_memory_equal(&tree->position[at], &trunk->position[i], sizeof(Vec3));
        kept[at] = true;
        if (!tree_is_segment(trunk, i))
            continue;
        size_t top = find(tree, trunk->id[trunk->parent[i]]);
        for (size_t k = at; k != top; k = (size_t)tree->parent[k]) {
            kept[k] = true;
            assert_true(tree->radius_mm[k] == trunk->radius_mm[i]);
        }
    }
    return kept;
}

/* p_term at every new terminal, and Murray's law at every fork off the trunk. */
static void assert_laws(const Tree *tree, const bool *kept)
{
    const double *said = tree->meta.number;
    double drop = said[META_P_PERF] - said[META_P_TERM], total = 0;
    double unit =
        8 * said[META_VISCOSITY] * 1e-3 / pi * said[META_Q_PERF] * 1000 / 60 / 133.322387415;
    int32_t *children = child_counts(tree);
    double *share = calloc(tree->n, sizeof *share), *fall = calloc(tree->n, sizeof *fall);
    double *cubes = calloc(tree->n, sizeof *cubes);
    assert_true(share && fall && cubes);
    for (size_t i = tree->n; i-- > 0;) {
        share[i] += tree_is_segment(tree, i) && children[i] == 0;
        if (tree_is_segment(tree, i)) {
            share[tree->parent[i]] += share[i];
            cubes[tree->parent[i]] += pow(tree->radius_mm[i], said[META_GAMMA]);
        } else {
            total += share[i];
        }
    }
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i))
            continue;
        fall[i] = fall[tree->parent[i]] + unit * share[i] / total * tree_segment_length(tree, i) /
                                              pow(tree->radius_mm[i], 4);
        assert_true(fall[i] < drop * (1 + 1e-9));
        if (!kept[i] && children[i] == 0)
            assert_true(fabs(fall[i] / drop - 1) < 1e-9);
        if (!kept[i] && children[i] > 0)
            assert_true(fabs(cubes[i] / pow(tree->radius_mm[i], said[META_GAMMA]) - 1) < 1e-9);
    }
    free(children);
    free(share);
    free(fall);
    free(cubes);
}

static GrowParams params_on(const Tree *from, size_t terminals)
{
    GrowParams params = grow_defaults();
    params.from = from;
    params.keep_radii = true;
    params.terminals = terminals;
    params.blood.q_perf_ml_min = 60;
    return params;
}

static void radii_and_points_of_a_trunk_stay_to_the_bit(void **state)
{
    (void)state;
    for (int inlets = 1; inlets <= 2; inlets++) {
        Tree from = trunk(inlets), tree;
        GrowParams params = params_on(&from, 700);
        params.gamma = logcurve_constant(inlets == 1 ? 3 : 2.7);
        params.lambda = inlets == 1 ? 2 : 1.4;
        Err err = {""};
        must(grow_on(&params, &tree, &err), &err);
        bool *kept = assert_kept(&from, &tree);
        assert_laws(&tree, kept);
        assert_true(tree.radius_mm[0] == from.radius_mm[1]);
        free(kept);
        tree_release(&tree);
        tree_release(&from);
    }
}

static void the_number_of_threads_does_not_change_what_grows_on_a_trunk(void **state)
{
    (void)state;
    Tree from = trunk(1), one, three;
    GrowParams params = params_on(&from, 9000);
    params.threads = 1;
    assert_int_equal(grow_on(&params, &one, NULL), STATUS_OK);
    params.threads = 3;
    assert_int_equal(grow_on(&params, &three, NULL), STATUS_OK);
    assert_int_equal(one.n, three.n);
    assert_memory_equal(one.radius_mm, three.radius_mm, one.n * sizeof *one.radius_mm);
    assert_memory_equal(one.position, three.position, one.n * sizeof *one.position);
    tree_release(&one);
    tree_release(&three);
    tree_release(&from);
}

static void a_trunk_by_pries_and_territory_keeps_its_radii(void **state)
{
    (void)state;
    Tree from = trunk(1), tree;
    GrowParams params = params_on(&from, 300);
    params.blood.viscosity_law = VISCOSITY_PRIES;
    params.blood.terminal_flow = TERMINAL_FLOW_TERRITORY;
    Err err = {""};
    must(grow_on(&params, &tree, &err), &err);
    free(assert_kept(&from, &tree));
    assert_non_null(tree.flow_share);
    tree_release(&tree);
    tree_release(&from);
}

/* Of the flow that the sentence says, a third passes, although another tree grows then. */
static void a_trunk_too_narrow_for_its_flow_says_which_flow_passes(void **state)
{
    (void)state;
    Tree from = trunk(1), tree;
    GrowParams params = params_on(&from, 200);
    params.blood.q_perf_ml_min = 23850;
    Err err;
    assert_int_equal(grow_on(&params, &tree, &err), STATUS_INFEASIBLE);
    const char *said = strstr(err.text, "give a flow below ");
    assert_non_null(said);
    assert_non_null(strstr(err.text, "too narrow for `q_perf` 23850 ml/min"));
    params.blood.q_perf_ml_min = strtod(said + strlen("give a flow below "), NULL) / 3;
    assert_int_equal(grow_on(&params, &tree, &err), STATUS_OK);
    tree_release(&tree);
    tree_release(&from);
}

static void refuses_what_has_no_radii_to_keep(void **state)
{
    (void)state;
    Tree from = trunk(1), tree;
    GrowParams params = params_on(&from, 50);
    Err err;
    from.radius_mm[3] = 0;
    assert_int_equal(grow_on(&params, &tree, &err), STATUS_INPUT);
    assert_non_null(strstr(err.text, "node 20 has radius 0"));
    params.from = NULL;
    assert_int_equal(grow_on(&params, &tree, &err), STATUS_USAGE);
    assert_non_null(strstr(err.text, "`keep_radii` needs `from`"));
    tree_release(&from);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(radii_and_points_of_a_trunk_stay_to_the_bit),
        cmocka_unit_test(the_number_of_threads_does_not_change_what_grows_on_a_trunk),
        cmocka_unit_test(a_trunk_by_pries_and_territory_keeps_its_radii),
        cmocka_unit_test(a_trunk_too_narrow_for_its_flow_says_which_flow_passes),
        cmocka_unit_test(refuses_what_has_no_radii_to_keep),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
