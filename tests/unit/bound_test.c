/* The lower bound of a tree's target: every tree tried is above it, and the best tree found
 * reaches it. */
#include "grow/bound/bound_newton.h"
#include "test_grow.h"
#include "unit.h"

#include <stdlib.h>
#include <string.h>

static Tree grown(size_t terminals, double lambda, const char *spec, TerminalFlow flow)
{
    GrowParams params = grow_defaults();
    params.terminals = terminals;
    params.lambda = lambda;
    params.blood.terminal_flow = flow;
    params.seed = 23;
    return test_grown_by(&params, spec);
}

/* A tree of so many nodes: x, y, z, radius and parent of each. */
static Tree tree_of(size_t n, const double row[][5])
{
    Tree tree;
    assert_int_equal(tree_init(&tree, n, NULL), STATUS_OK);
    for (size_t i = 0; i < n; i++) {
        tree.position[i] = vec3(row[i][0], row[i][1], row[i][2]);
        tree.radius_mm[i] = row[i][3];
        tree.parent[i] = (int32_t)row[i][4];
    }
    tree_renumber(&tree);
    return tree;
}

static Bound bounded(const Tree *tree, double lambda)
{
    Bound bound;
    Err err = {""};
    must(bound_tree(tree, lambda, &bound, &err), &err);
    return bound;
}

static double target_of(const Tree *tree, double lambda)
{
    double sum = 0;
    for (size_t i = 0; i < tree->n; i++)
        sum += tree_segment_length(tree, i) * pow(tree->radius_mm[i], lambda);
    return sum;
}

/* Flow shares at and below every node, and drops from the root in units of share mm^-3; owned. */
typedef struct Flows {
    double *flow, *drop;
} Flows;

static Flows flows_of(const Tree *tree)
{
    Flows flows;
    assert_int_equal(tree_flow_shares(tree, &flows.flow, NULL), STATUS_OK);
    flows.drop = calloc(tree->n, sizeof *flows.drop);
    assert_non_null(flows.drop);
    for (size_t i = tree->n; i-- > 1;)
        flows.flow[tree->parent[i]] += flows.flow[i];
    for (size_t i = 1; i < tree->n; i++)
        flows.drop[i] = flows.drop[tree->parent[i]] +
                        flows.flow[i] * tree_segment_length(tree, i) / pow(tree->radius_mm[i], 4);
    return flows;
}

static void flows_release(Flows *flows)
{
    free(flows->flow);
    free(flows->drop);
}

/* Moves every bifurcation by up to `by` mm along each axis, parts the drops anew, by up to `part`
 * differently, and gives every segment the radius that has its drop. Every outlet keeps its place
 * and drop. */
static void shake(Tree *tree, double by, double part, Random *random)
{
    Flows flows = flows_of(tree);
    int32_t *children;
    assert_int_equal(tree_child_counts(tree, &children, NULL), STATUS_OK);
    for (size_t i = 1; i < tree->n; i++) {
        if (children[i] == 0)
            continue;
        double least = INFINITY, above = flows.drop[tree->parent[i]];
        for (size_t k = i + 1; k < tree->n; k++)
            if (tree->parent[k] == (int32_t)i)
                least = fmin(least, flows.drop[k]);
        flows.drop[i] += part * (2 * random_uniform(random) - 1) *
                         fmin(least - flows.drop[i], flows.drop[i] - above);
        Vec3 *at = &tree->position[i];
        *at = vec3_add(*at, vec3(by * (2 * random_uniform(random) - 1),
                                 by * (2 * random_uniform(random) - 1),
                                 by * (2 * random_uniform(random) - 1)));
    }
    for (size_t i = 1; i < tree->n; i++)
        tree->radius_mm[i] = pow(flows.flow[i] * tree_segment_length(tree, i) /
                                     (flows.drop[i] - flows.drop[tree->parent[i]]),
                                 0.25);
    free(children);
    flows_release(&flows);
}

/* And the bound does not depend on where a tree's bifurcations are, nor on its radii: each of these
 * trees has the same least target. */
static void the_bound_is_below_every_geometry_and_the_same_for_all(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 2385);
    Tree tree = grown(61, 2, "ball:23.5", TERMINAL_FLOW_EQUAL);
    Bound bound = bounded(&tree, 2);
    for (int run = 0; run < 60; run++) {
        shake(&tree, 0.05 * run, run % 2 ? 0.7 : 0, &random);
        assert_true(target_of(&tree, 2) >= bound.bound);
        if (run % 10)
            continue;
        Bound same = bounded(&tree, 2);
        assert_true(fabs(same.target - target_of(&tree, 2)) < 1e-9 * same.target);
        assert_true(same.bound <= bound.best && bound.bound <= same.best);
        bound_release(&same);
    }
    bound_release(&bound);
    tree_release(&tree);
}

static void the_gap_is_small_for_all_exponents_dimensions_and_flows(void **state)
{
    (void)state;
    const double lambda[] = {0.5, 1, 1.785, 2, 3, 4};
    for (size_t k = 0; k < sizeof lambda / sizeof *lambda; k++)
        for (int run = 0; run < 4; run++) {
            Tree tree = grown(run / 2 ? 238 : 38, lambda[k], run % 2 ? "disc:50" : "ball:50",
                              run / 2 ? TERMINAL_FLOW_EQUAL : TERMINAL_FLOW_TERRITORY);
            Bound bound = bounded(&tree, lambda[k]);
            assert_true(bound.best <= bound.bound * 1.0005);
            assert_true(bound.bound < bound.best && bound.best < bound.murray);
            assert_true(bound.murray < bound.target);
            assert_int_equal(bound.outlets, run / 2 ? 238 : 38);
            bound_release(&bound);
            tree_release(&tree);
        }
}

/* A straight segment is the best one: its own target, l r^lambda. */
static void one_terminal_is_bounded_by_its_own_target(void **state)
{
    (void)state;
    const double row[][5] = {{0.4, -1, 2, 0.3, -1}, {3.1, 4.25, -5, 0.3, 0}};
    Tree tree = tree_of(2, row);
    Bound bound = bounded(&tree, 1.5);
    assert_true(fabs(bound.best - target_of(&tree, 1.5)) < 1e-12);
    assert_true(bound.bound <= bound.best && bound.bound > bound.best * (1 - 1e-6));
    assert_true(isnan(bound.murray));
    bound_release(&bound);
    tree_release(&tree);
}

/* The target of a tree that leads from (0, 0) by (0, y) to (-3, 8) and (3, 8), whose outlets have a
 * drop of 5, `part` of it on the first segment. */
static double target_of_fork(double y, double part, double lambda)
{
    double a = lambda / 4, leg = hypot(3, 8 - y);
    return pow(2, a) * pow(y, 1 + a) * pow(5 * part, -a) +
           2 * pow(leg, 1 + a) * pow(5 * (1 - part), -a);
}

static double least_of_forks(double lambda)
{
    double y = 4, part = 0.5, least = INFINITY;
    for (double step = 0.1; step > 1e-7; step /= 2)
        for (int turn = 0; turn < 400; turn++) {
            double try_y = y + step * (turn % 3 - 1) * 8,
                   try_part = part + step * (turn / 3 % 3 - 1);
            if (try_y <= 0 || try_y >= 8 || try_part <= 0 || try_part >= 1)
                continue;
            double target = target_of_fork(try_y, try_part, lambda);
            if (target < least)
                least = target, y = try_y, part = try_part;
        }
    return least;
}

static void two_terminals_are_bounded_by_the_best_fork(void **state)
{
    (void)state;
    /* radii with which each segment has a drop of 2.5 */
    const double stem = pow(2 * 4 / 2.5, 0.25), leg = pow(5 / 2.5, 0.25);
    const double row[][5] = {
        {0, 0, 0, stem, -1}, {0, 4, 0, stem, 0}, {-3, 8, 0, leg, 1}, {3, 8, 0, leg, 1}};
    Tree tree = tree_of(4, row);
    for (double lambda = 0.5; lambda <= 4; lambda += 0.7) {
        Bound bound = bounded(&tree, lambda);
        double least = least_of_forks(lambda);
        assert_true(bound.bound <= least && bound.bound >= least * (1 - 4e-4));
        assert_true(bound.best >= least * (1 - 1e-12) && bound.best <= least * (1 + 4e-4));
        bound_release(&bound);
    }
    tree_release(&tree);
}

/* Points along a vessel are passed, side branches without flow left out, and a segment with an
 * outlet at its start costs nothing more where there is no length. */
static void points_dead_ends_and_outlets_on_the_way_change_nothing(void **state)
{
    (void)state;
    const double row[][5] = {
        {0, 0, 0, 1, -1}, {0, 4, 0, 1, 0}, {-3, 8, 0, 0.8, 1}, {3, 8, 0, 0.7, 1}};
    const double with_points[][5] = {{0, 0, 0, 1, -1},     {0, 1.5, 0, 1, 0}, {0, 4, 0, 1, 1},
                                     {-1.5, 6, 0, 0.8, 2}, {7, 7, 7, 0.2, 2}, {-3, 8, 0, 0.8, 3},
                                     {3, 8, 0, 0.7, 2}};
    Tree plain = tree_of(4, row), points = tree_of(7, with_points);
    assert_int_equal(tree_add_flow_shares(&points, NULL), STATUS_OK);
    points.flow_share[5] = points.flow_share[6] = 1;
    Bound of_plain = bounded(&plain, 2), of_points = bounded(&points, 2);
    assert_int_equal(of_points.outlets, 2);
    assert_true(fabs(of_points.bound - of_plain.bound) < 1e-9 * of_plain.bound);
    bound_release(&of_points);
    points.flow_share[2] = 0.5;
    of_points = bounded(&points, 2);
    assert_int_equal(of_points.outlets, 3);
    assert_int_equal(of_points.outlet[0].node, 2);
    assert_true(of_points.bound < target_of(&points, 2) &&
                of_points.best < of_points.bound * 1.001);
    bound_release(&of_points);
    bound_release(&of_plain);
    tree_release(&plain);
    tree_release(&points);
}

/* Everything that a step of Newton's method goes by. */
typedef struct Parts {
    Tree tree;
    Problem problem;
    Newton newton;
} Parts;

static Parts parts_of(double lambda)
{
    Parts parts = {.tree = grown(37, lambda, "ball:20", TERMINAL_FLOW_TERRITORY)};
    assert_int_equal(problem_init(&parts.problem, &parts.tree, lambda, NULL), STATUS_OK);
    assert_int_equal(newton_init(&parts.newton, parts.problem.n, NULL), STATUS_OK);
    return parts;
}

static void parts_release(Parts *parts)
{
    newton_release(&parts->newton);
    problem_release(&parts->problem);
    tree_release(&parts->tree);
}

/* The force on joint i that is left over by those of its own segment and of its daughters'. */
static void left_over(const Parts *parts, size_t i, State sum)
{
    newton_force(&parts->problem, &parts->newton, 0.3, i, sum);
    for (size_t k = i + 1; k < parts->problem.n; k++) {
        State force;
        if (parts->problem.joint[k].parent != (int32_t)i)
            continue;
        newton_force(&parts->problem, &parts->newton, 0.3, k, force);
        for (int axis = 0; axis < STATE; axis++)
            sum[axis] -= force[axis];
    }
}

static void the_gradient_is_that_of_differences(void **state)
{
    (void)state;
    Parts parts = parts_of(2.7);
    for (size_t i = 0; i < parts.problem.n; i++) {
        State sum;
        if (!parts.problem.joint[i].is_free)
            continue;
        left_over(&parts, i, sum);
        for (int axis = 0; axis < STATE; axis++) {
            double h = axis == DROP ? 1e-4 * parts.problem.joint[i].at[DROP] : 1e-4;
            parts.newton.step[i][axis] = h;
            double up = newton_cost(&parts.problem, &parts.newton, 0.3, 1);
            double down = newton_cost(&parts.problem, &parts.newton, 0.3, -1);
            parts.newton.step[i][axis] = 0;
            double scale = newton_cost(&parts.problem, &parts.newton, 0.3, 0);
            assert_true(fabs((up - down) / 2 - sum[axis] * h) <
                        1e-6 * fabs(sum[axis] * h) + 1e-11 * scale);
        }
    }
    parts_release(&parts);
}

static void forces_balance_at_the_end_of_a_step(void **state)
{
    (void)state;
    Parts parts = parts_of(1.3);
    State before, after;
    double slope = newton_step(&parts.problem, &parts.newton, 0.3);
    assert_true(slope < 0);
    for (size_t i = 0; i < parts.problem.n; i++) {
        if (!parts.problem.joint[i].is_free)
            continue;
        left_over(&parts, i, after);
        newton_force(&parts.problem, &parts.newton, 0.3, i, before);
        for (int axis = 0; axis < STATE; axis++)
            assert_true(fabs(after[axis]) < 1e-7 * fabs(before[axis]));
    }
    parts_release(&parts);
}

/* Along any line the cost in the middle is not above the mean of both ends. */
static void the_cost_is_convex_in_places_and_drops(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 471);
    for (double lambda = 0.5; lambda <= 4; lambda += 0.7) {
        Parts parts = parts_of(lambda);
        for (int run = 0; run < 50; run++) {
            for (size_t i = 0; i < parts.problem.n; i++)
                for (int axis = 0; axis < STATE && parts.problem.joint[i].is_free; axis++)
                    parts.newton.step[i][axis] =
                        (random_uniform(&random) - 0.5) *
                        (axis == DROP ? 0.01 * parts.problem.joint[i].at[DROP] : 4);
            double left = newton_cost(&parts.problem, &parts.newton, 0, -1);
            double middle = newton_cost(&parts.problem, &parts.newton, 0, 0);
            double right = newton_cost(&parts.problem, &parts.newton, 0, 1);
            assert_true(middle <= (left + right) / 2 * (1 + 1e-12));
        }
        parts_release(&parts);
    }
}

static void the_same_tree_gives_the_same_bits(void **state)
{
    (void)state;
    Tree tree = grown(83, 2, "disc:50", TERMINAL_FLOW_TERRITORY);
    Text text[2] = {TEXT_INIT, TEXT_INIT};
    for (int run = 0; run < 2; run++) {
        Bound bound = bounded(&tree, 2);
        bound_put_certificate(&bound, &tree, &text[run]);
        bound_release(&bound);
    }
    assert_string_equal(text_chars(&text[0]), text_chars(&text[1]));
    text_release(&text[0]);
    text_release(&text[1]);
    tree_release(&tree);
}

static void expect_refused(const Tree *tree, double lambda, Status expected, const char *sentence)
{
    Bound bound = {.steps = 2385};
    Err err = {""};
    assert_int_equal(bound_tree(tree, lambda, &bound, &err), expected);
    assert_non_null(strstr(err.text, sentence));
    assert_int_equal(bound.steps, 2385);
}

static void refuses_trees_and_exponents_without_a_bound(void **state)
{
    (void)state;
    const double row[][5] = {{0, 0, 0, 1, -1}, {0, 4, 0, 0, 0}};
    const double nowhere[][5] = {{0, 0, 0, 1, -1}, {0, 0, 0, 1, 0}};
    Tree tree = tree_of(2, row), still = tree_of(2, nowhere);
    expect_refused(&tree, 2, STATUS_INPUT, "node 2: blood flows to it through a radius of 0");
    expect_refused(&still, 2, STATUS_INPUT, "node 2: blood leaves the tree where its root is");
    tree.radius_mm[1] = 1;
    expect_refused(&tree, 0.49, STATUS_USAGE, "`lambda` is 0.49; it must be from 0.5 to 4");
    expect_refused(&tree, NAN, STATUS_USAGE, "`lambda`");
    assert_int_equal(tree_add_flow_shares(&tree, NULL), STATUS_OK);
    expect_refused(&tree, 2, STATUS_INPUT, "no blood flows");
    tree_release(&tree);
    tree_release(&still);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_bound_is_below_every_geometry_and_the_same_for_all),
        cmocka_unit_test(the_gap_is_small_for_all_exponents_dimensions_and_flows),
        cmocka_unit_test(one_terminal_is_bounded_by_its_own_target),
        cmocka_unit_test(two_terminals_are_bounded_by_the_best_fork),
        cmocka_unit_test(points_dead_ends_and_outlets_on_the_way_change_nothing),
        cmocka_unit_test(the_gradient_is_that_of_differences),
        cmocka_unit_test(forces_balance_at_the_end_of_a_step),
        cmocka_unit_test(the_cost_is_convex_in_places_and_drops),
        cmocka_unit_test(the_same_tree_gives_the_same_bits),
        cmocka_unit_test(refuses_trees_and_exponents_without_a_bound),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
