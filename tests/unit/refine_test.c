/* Slow: refines whole trees at every level. */
/* Refined trees: lower targets, and every promise of a tree kept [tree_promises.h]. */
#include "grow/grow.h"
#include "unit.h"

#include <stdlib.h>
#include <string.h>

#include "tree_promises.h"

static Tree grown(size_t terminals, double lambda, uint64_t seed, const char *spec, Domain *domain)
{
    GrowParams params = grow_defaults();
    params.terminals = terminals;
    params.lambda = lambda;
    params.seed = seed;
    Tree tree;
    Err err = {""};
    assert_int_equal(domain_parse(domain, spec, NULL), STATUS_OK);
    must(grow_tree(&params, domain, &tree, NULL, &err), &err);
    return tree;
}

static RefineReport refine(Tree *tree, const Domain *domain, GrowRefine level, uint64_t moves)
{
    RefineParams params = {.level = level, .moves = moves, .seed = 3};
    RefineReport report;
    Err err = {""};
    must(refine_tree(&params, domain, tree, &report, &err), &err);
    return report;
}

static double gain(const RefineReport *report)
{
    return 1 - report->target_after / report->target_before;
}

static double target_of(const Tree *tree)
{
    double sum = 0;
    for (size_t i = 1; i < tree->n; i++)
        sum +=
            tree_segment_length(tree, i) * pow(tree->radius_mm[i], tree->meta.number[META_LAMBDA]);
    return sum;
}

static int compare_places(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(Vec3));
}

/* The places of all terminals (owned), in an order of their own. */
static Vec3 *terminal_places(const Tree *tree)
{
    size_t terminals = tree->n / 2, found = 0;
    Vec3 *place = calloc(terminals, sizeof *place);
    int32_t *children = child_counts(tree);
    assert_non_null(place);
    for (size_t i = 1; i < tree->n; i++)
        if (!children[i])
            place[found++] = tree->position[i];
    assert_int_equal(found, terminals);
    qsort(place, terminals, sizeof *place, compare_places);
    free(children);
    return place;
}

static void assert_promises(const Tree *tree, size_t terminals)
{
    assert_binary(tree, terminals);
    assert_murray(tree, tree->meta.number[META_GAMMA]);
    assert_pressures(tree);
}

static void each_level_lowers_the_target_by_what_it_should(void **state)
{
    (void)state;
    const struct {
        GrowRefine level;
        size_t terminals;
        uint64_t moves; /* 0: as many as the level is given */
        double least_gain;
    } cases[] = {{GROW_REFINE_GEOMETRY, 1000, 0, 0.008},
                 {GROW_REFINE_GEOMETRY, 20000, 1, 0.0023}, /* one joint move */
                 {GROW_REFINE_TOPOLOGY, 1000, 0, 0.035},
                 {GROW_REFINE_ANNEAL, 200, 150000, 0.06}};
    for (size_t k = 0; k < (SHARE > 1 ? 1 : sizeof cases / sizeof *cases); k++) {
        Domain domain;
        Tree tree = grown(cases[k].terminals, 2, 1, "disc:50", &domain);
        RefineReport report = refine(&tree, &domain, cases[k].level, cases[k].moves);
        assert_true(fabs(report.target_after / target_of(&tree) - 1) <= 1e-12);
        if (!(gain(&report) >= cases[k].least_gain))
            fail_msg("level %d gains %g, less than %g", (int)cases[k].level, gain(&report),
                     cases[k].least_gain);
        tree_release(&tree);
        domain_release(&domain);
    }
}

/* The length of the shortest tree on the inlet and the terminals alone (Prim), mm. */
static double spanning_length(const Tree *tree)
{
    size_t terminals = tree->n / 2;
    Vec3 *place = terminal_places(tree), at = tree->position[0];
    double *apart = malloc(terminals * sizeof *apart), sum = 0;
    assert_non_null(apart);
    for (size_t i = 0; i < terminals; i++)
        apart[i] = INFINITY;
    for (size_t left = terminals; left > 0; left--) {
        size_t next = 0;
        for (size_t i = 0; i < left; i++) {
            apart[i] = fmin(apart[i], vec3_distance(place[i], at));
            next = apart[i] < apart[next] ? i : next;
        }
        sum += apart[next];
        at = place[next];
        place[next] = place[left - 1];
        apart[next] = apart[left - 1];
    }
    free(place);
    free(apart);
    return sum;
}

static void trees_of_little_length_come_near_the_spanning_tree(void **state)
{
    (void)state;
    const struct {
        const char *domain;
        uint64_t seed;
        double limit;
    } cases[] = {{"ball:50", 1, 1.005}, {"disc:50", 1, 1.07}, {"disc:50", 4, 1.07}};
    for (size_t k = 0; k < (SHARE > 1 ? 1 : sizeof cases / sizeof *cases); k++) {
        Domain domain;
        Tree tree = grown(1000, 0, cases[k].seed, cases[k].domain, &domain);
        RefineReport report = refine(&tree, &domain, GROW_REFINE_TOPOLOGY, 0);
        double ratio = report.target_after / spanning_length(&tree);
        if (!(ratio <= cases[k].limit))
            fail_msg("%s, seed %d: %.4f times the spanning tree", cases[k].domain,
                     (int)cases[k].seed, ratio);
        assert_true(report.thickness == 1);
        assert_int_equal(count_violations(&tree), 0);
        assert_promises(&tree, 1000);
        tree_release(&tree);
        domain_release(&domain);
    }
}

/* A tree that comes in with vessels in each other: bifurcations are where they should not be. */
static void topology_mends_rules_that_were_broken(void **state)
{
    (void)state;
    Domain domain;
    Tree tree = grown(200, 2, 6, "disc:50", &domain);
    int32_t *children = child_counts(&tree);
    for (size_t i = 2; i < 20; i++)
        if (children[i])
            tree.position[i].x += 5.7;
    free(children);
    assert_true(count_violations(&tree) >= 6);
    RefineReport report = refine(&tree, &domain, GROW_REFINE_TOPOLOGY, 0);
    assert_true(report.thickness == 1);
    assert_int_equal(count_violations(&tree), 0);
    assert_promises(&tree, 200);
    tree_release(&tree);
    domain_release(&domain);
}

static void refined_trees_keep_every_promise(void **state)
{
    (void)state;
    const char *specs[] = {"disc:50", "ball:50", "shell:40,40,60,12"};
    const double lambdas[] = {2, 0, 1};
    for (size_t k = 0; k < 3; k++)
        for (GrowRefine level = GROW_REFINE_GEOMETRY; level <= GROW_REFINE_ANNEAL; level++) {
            Domain domain;
            Tree tree = grown(200, lambdas[k], 7, specs[k], &domain);
            Vec3 inlet = tree.position[0], *before = terminal_places(&tree);
            size_t bad = count_violations(&tree);
            RefineReport report = refine(&tree, &domain, level, 20000);
            Vec3 *after = terminal_places(&tree);
            assert_promises(&tree, 200);
            assert_true(report.target_after < report.target_before);
            assert_true(report.thickness == 1);
            assert_true(count_violations(&tree) <= bad);
            assert_memory_equal(&inlet, &tree.position[0], sizeof inlet);
            assert_memory_equal(before, after, 200 * sizeof *before);
            for (size_t i = 1; i < tree.n; i++) {
                assert_true(domain_inside(&domain, tree.position[i], 0));
                assert_true(
                    domain_holds_segment(&domain, tree.position[tree.parent[i]], tree.position[i]));
            }
            free(before);
            free(after);
            tree_release(&tree);
            domain_release(&domain);
        }
}

static void unequal_flows_stay_with_their_terminals(void **state)
{
    (void)state;
    Domain domain;
    Tree tree = grown(150, 2, 9, "disc:50", &domain);
    int32_t *children = child_counts(&tree);
    assert_int_equal(tree_add_flow_shares(&tree, NULL), STATUS_OK);
    double at_first = 0, at_last = 0; /* share times place, a mark of who has which */
    for (size_t i = 1; i < tree.n; i++)
        if (!children[i]) {
            tree.flow_share[i] = 0.6 + (double)(i % 7) / 8;
            at_first += tree.flow_share[i] * tree.position[i].x;
        }
    free(children);
    refine(&tree, &domain, GROW_REFINE_TOPOLOGY, 0);
    for (size_t i = 1; i < tree.n; i++)
        at_last += tree.flow_share[i] * tree.position[i].x;
    assert_true(fabs(at_last - at_first) <= 1e-9);
    assert_promises(&tree, 150);
    tree_release(&tree);
    domain_release(&domain);
}

static void the_same_moves_give_the_same_tree(void **state)
{
    (void)state;
    Domain domain;
    Tree a = grown(120, 2, 4, "ball:50", &domain), b = grown(120, 2, 4, "ball:50", &domain);
    refine(&a, &domain, GROW_REFINE_ANNEAL, 15000);
    refine(&b, &domain, GROW_REFINE_ANNEAL, 15000);
    assert_memory_equal(a.position, b.position, a.n * sizeof *a.position);
    assert_memory_equal(a.radius_mm, b.radius_mm, a.n * sizeof *a.radius_mm);
    assert_memory_equal(a.parent, b.parent, a.n * sizeof *a.parent);
    tree_release(&a);
    tree_release(&b);
    domain_release(&domain);
}

static bool stop_at_last(void *context)
{
    return --*(int *)context == 0;
}

static void stops_when_asked_with_a_tree_that_is_no_worse(void **state)
{
    (void)state;
    for (int level = GROW_REFINE_GEOMETRY; level <= GROW_REFINE_ANNEAL; level++) {
        Domain domain;
        Tree tree = grown(100, 2, 5, "disc:50", &domain);
        double before = target_of(&tree);
        int left = 157;
        RefineParams params = {
            .level = (GrowRefine)level, .seed = 3, .stop = stop_at_last, .stop_context = &left};
        RefineReport report;
        assert_int_equal(refine_tree(&params, &domain, &tree, &report, NULL), STATUS_OK);
        assert_true(report.stopped && report.moves_tried <= 157);
        assert_true(target_of(&tree) <= before * (1 + 1e-12));
        assert_promises(&tree, 100);
        tree_release(&tree);
        domain_release(&domain);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_level_lowers_the_target_by_what_it_should),
        cmocka_unit_test(trees_of_little_length_come_near_the_spanning_tree),
        cmocka_unit_test(topology_mends_rules_that_were_broken),
        cmocka_unit_test(refined_trees_keep_every_promise),
        cmocka_unit_test(unequal_flows_stay_with_their_terminals),
        cmocka_unit_test(the_same_moves_give_the_same_tree),
        cmocka_unit_test(stops_when_asked_with_a_tree_that_is_no_worse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
