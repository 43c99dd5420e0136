/* Grown trees keep their promises [tree_promises.h]. */
#include "grow/grow.h"
#include "unit.h"

#include <stdlib.h>
#include <string.h>

#include "tree_promises.h"

static Domain domain_of(const char *spec)
{
    Domain domain;
    assert_int_equal(domain_parse(&domain, spec, NULL), STATUS_OK);
    return domain;
}

static Tree grown(const GrowParams *params, const char *spec, GrowReport *report)
{
    Domain domain = domain_of(spec);
    Tree tree;
    Err err = {""};
    must(grow_tree(params, &domain, &tree, report, &err), &err);
    return tree;
}

static void assert_inside(const Tree *tree, const char *spec)
{
    Domain domain = domain_of(spec);
    for (size_t i = 0; i < tree->n; i++)
        assert_true(domain_inside(&domain, tree->position[i], 0));
}

static void assert_all(const GrowParams *params, const char *spec)
{
    GrowReport report;
    Tree tree = grown(params, spec, &report);
    assert_binary(&tree, params->terminals);
    assert_murray(&tree, params->gamma.value[0]);
    assert_pressures(&tree);
    assert_inside(&tree, spec);
    double target = 0;
    for (size_t i = 1; i < tree.n; i++)
        target += vec3_distance(tree.position[i], tree.position[tree.parent[i]]) *
                  pow(tree.radius_mm[i], params->lambda);
    assert_true(fabs(report.target / target - 1) <= 1e-12);
    assert_int_equal(report.terminals, params->terminals);
    assert_true(report.root_radius_mm == tree.radius_mm[0]);
    assert_true(report.tosses >= params->terminals + report.rejected);
    tree_release(&tree);
}

static void one_two_and_three_terminals_make_trees(void **state)
{
    (void)state;
    GrowParams params = grow_defaults();
    for (params.terminals = 1; params.terminals <= 3; params.terminals++) {
        assert_all(&params, "disc:50");
        assert_all(&params, "ball:23.85");
    }
}

static void laws_hold_for_any_gamma_and_lambda(void **state)
{
    (void)state;
    const double gammas[] = {0.1, 0.3, 1, 2, 2.55, 3, 10}, lambdas[] = {0, 0.5, 1, 2, 3, 6.5};
    GrowParams params = grow_defaults();
    params.terminals = 150;
    for (size_t i = 0; i < sizeof gammas / sizeof *gammas; i++)
        for (size_t j = 0; j < sizeof lambdas / sizeof *lambdas; j++) {
            params.gamma = logcurve_constant(gammas[i]);
            params.lambda = lambdas[j];
            params.seed++;
            assert_all(&params, params.seed % 2 ? "disc:50" : "ball:23.85");
        }
}

static void laws_hold_for_any_flow_pressure_and_size(void **state)
{
    (void)state;
    GrowParams params = grow_defaults();
    params.terminals = 120;
    params.blood.p_perf_mmhg = 23.85;
    params.blood.p_term_mmhg = -71.5;
    params.blood.q_perf_ml_min = 0.37;
    params.blood.viscosity_cp = 1.2;
    params.toss = GROW_TOSS_TERMINAL;
    params.candidates = 1;
    const Vec3 inlet = vec3(3e-7, -7e-7, 0);
    params.inlets = 1;
    params.inlet = &inlet;
    assert_all(&params, "disc:0.0238");
    assert_all(&params, "ball:1e6");
    assert_all(&params, "disc:1e-6");
    params.candidates = GROW_MAX_CANDIDATES;
    assert_all(&params, "ball:0.0238");
}

static double cross_z(Vec3 a, Vec3 b, Vec3 c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static void segments_in_the_plane_never_cross(void **state)
{
    (void)state;
    GrowParams params = grow_defaults();
    params.terminals = 400;
    const double lambdas[] = {0, 2}, gammas[] = {3, 1};
    for (params.seed = 1; params.seed <= 8; params.seed++) {
        params.lambda = lambdas[params.seed % 2];
        params.gamma =
            logcurve_constant(gammas[params.seed / 7]); /* the last are too thick for the disc */
        Tree tree = grown(&params, "disc:50", NULL);
        for (size_t i = 1; i < tree.n; i++)
            for (size_t j = 1; j < i; j++) {
                Vec3 a = tree.position[tree.parent[i]], b = tree.position[i];
                Vec3 c = tree.position[tree.parent[j]], d = tree.position[j];
                if (!share_a_node(&tree, i, j))
                    assert_false(cross_z(a, b, c) * cross_z(a, b, d) <= 0 &&
                                 cross_z(c, d, a) * cross_z(c, d, b) <= 0);
            }
        tree_release(&tree);
    }
}

/* At final radii. */
static void vessels_are_longer_than_wide_and_clear_of_each_other(void **state)
{
    (void)state;
    const char *specs[] = {"disc:50", "ball:50"};
    for (size_t k = 0; k < 2; k++) {
        GrowParams params = grow_defaults();
        params.seed = 17;
        GrowReport report;
        Tree tree = grown(&params, specs[k], &report);
        assert_true(report.thickness == 1);
        assert_int_equal(count_violations(&tree), 0);
        assert_int_equal(report.broken, 0);
        tree_release(&tree);
    }
}

/* Too much flow for the disc: vessels at their real thickness have no room. */
static void vessels_without_room_count_as_thinner_by_halves_down_to_lines(void **state)
{
    (void)state;
    const struct {
        double flow, gamma, thickness;
    } cases[] = {{5e5, 3, 0.5}, {5e6, 3, 0.25}, {500, 0.5, 0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        GrowParams params = grow_defaults();
        params.terminals = 200;
        params.seed = 3;
        params.blood.q_perf_ml_min = cases[k].flow;
        params.gamma = logcurve_constant(cases[k].gamma);
        GrowReport report;
        Tree tree = grown(&params, "disc:50", &report);
        if (report.thickness != cases[k].thickness)
            fail_msg("case %zu: thickness %g", k, report.thickness);
        tree_release(&tree);
    }
}

static double mean_target(GrowToss toss)
{
    GrowParams params = grow_defaults();
    params.toss = toss;
    double sum = 0;
    for (params.seed = 1; params.seed <= 12; params.seed++) {
        GrowReport report;
        Tree tree = grown(&params, "disc:50", &report);
        sum += report.target;
        tree_release(&tree);
    }
    return sum / 12;
}

static void targets_are_lower_than_published_peers_reach(void **state)
{
    (void)state;
    assert_true(mean_target(GROW_TOSS_SEGMENT) <= 240);
    assert_true(mean_target(GROW_TOSS_TERMINAL) <= 235);
}

static bool same_trees(const Tree *a, const Tree *b)
{
    return a->n == b->n && memcmp(a->parent, b->parent, a->n * sizeof *a->parent) == 0 &&
           memcmp(a->position, b->position, a->n * sizeof *a->position) == 0 &&
           memcmp(a->radius_mm, b->radius_mm, a->n * sizeof *a->radius_mm) == 0;
}

static void one_seed_gives_one_tree(void **state)
{
    (void)state;
    GrowParams params = grow_defaults();
    params.terminals = 700;
    params.seed = UINT64_MAX;
    Tree a = grown(&params, "ball:50", NULL), b = grown(&params, "ball:50", NULL);
    params.seed = 2;
    Tree c = grown(&params, "ball:50", NULL);
    assert_true(same_trees(&a, &b));
    assert_false(same_trees(&a, &c));
    tree_release(&a);
    tree_release(&b);
    tree_release(&c);
}

/* Enough terminals for threads to work on different tiles. */
static void the_number_of_threads_does_not_change_the_tree(void **state)
{
    (void)state;
    GrowParams params = grow_defaults();
    params.terminals = 20000;
    const char *specs[] = {"disc:50", "ball:50"};
    for (size_t k = 0; k < 2; k++) {
        params.threads = 1;
        Tree one = grown(&params, specs[k], NULL);
        for (params.threads = 2; params.threads <= 3; params.threads++) {
            Tree many = grown(&params, specs[k], NULL);
            assert_true(same_trees(&one, &many));
            tree_release(&many);
        }
        tree_release(&one);
    }
}

/* Adds the terminals of a tree in disc:50 to 4 rings of 5 sectors of equal areas. */
static void count_terminals(const Tree *tree, int count[20])
{
    int32_t *children = child_counts(tree);
    for (size_t i = 1; i < tree->n; i++) {
        if (children[i])
            continue;
        Vec3 p = tree->position[i];
        int ring = (int)(4 * vec3_dot(p, p) / 2500);
        int sector = (int)(5 * (atan2(p.y, p.x) + pi) / (2 * pi));
        count[(ring < 4 ? ring : 3) * 5 + (sector < 5 ? sector : 0)]++;
    }
    free(children);
}

static void terminals_fill_the_tissue_evenly(void **state)
{
    (void)state;
    GrowParams params = grow_defaults();
    params.terminals = 2000;
    int count[20] = {0};
    for (params.seed = 1; params.seed <= 8; params.seed++) {
        Tree tree = grown(&params, "disc:50", NULL);
        count_terminals(&tree, count);
        tree_release(&tree);
    }
    for (int i = 0; i < 20; i++)
        assert_in_range(count[i], 640, 960);
}

static void the_header_tells_how_the_tree_was_made(void **state)
{
    (void)state;
    GrowParams params = grow_defaults();
    params.terminals = 5;
    params.seed = 12345678901234567890u;
    params.gamma = logcurve_constant(2.55);
    params.lambda = 0.1;
    Tree tree = grown(&params, "disc:23.85", NULL);
    static const struct {
        MetaKey key;
        const char *value;
    } expected[] = {{META_GENERATOR, "corcast " CORCAST_VERSION},
                    {META_SEED, "12345678901234567890"},
                    {META_DIMENSION, "2"},
                    {META_DOMAIN, "disc:23.85"},
                    {META_GAMMA, "2.55"},
                    {META_LAMBDA, "0.1"},
                    {META_P_PERF, "100"},
                    {META_P_TERM, "60"},
                    {META_Q_PERF, "500"},
                    {META_VISCOSITY, "3.6"}};
    MetaWalk walk = {.meta = &tree.meta};
    MetaLine line;
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        Text value = TEXT_INIT;
        assert_true(meta_walk(&walk, &line) && line.key == expected[i].key);
        meta_put_value(&tree.meta, line.key, &value);
        assert_string_equal(text_chars(&value), expected[i].value);
        text_release(&value);
    }
    assert_false(meta_walk(&walk, &line));
    tree_release(&tree);
}

static bool note_progress(double fraction, void *context)
{
    double *last = context;
    assert_true(fraction > *last && fraction <= 1);
    *last = fraction;
    return true;
}

static void progress_rises(void **state)
{
    (void)state;
    GrowParams params = grow_defaults();
    double last = 0;
    params.progress = note_progress;
    params.progress_context = &last;
    Tree tree = grown(&params, "disc:50", NULL);
    assert_true(last > 0.7);
    tree_release(&tree);
}

static void assert_refused(GrowParams params, const char *option)
{
    Domain domain = domain_of("disc:50");
    Err err = {""};
    assert_int_equal(grow_params_check(&params, &domain, &err), STATUS_USAGE);
    assert_memory_equal(err.text, option, strlen(option));
    Tree tree = {.n = 23};
    GrowReport report = {.target = 2.385};
    assert_int_equal(grow_tree(&params, &domain, &tree, &report, &err), STATUS_USAGE);
    assert_true(tree.n == 23 && report.target == 2.385);
}

#define REFUSES(field, value, option)                                                              \
    do {                                                                                           \
        GrowParams params_ = grow_defaults();                                                      \
        params_.field = value;                                                                     \
        assert_refused(params_, option);                                                           \
    } while (0)

static void refuses_parameters_out_of_range_and_names_the_option(void **state)
{
    (void)state;
    REFUSES(terminals, 0, "`terminals` is 0");
    REFUSES(terminals, GROW_MAX_TERMINALS + 1, "`terminals` is 50000001");
    REFUSES(gamma.value[0], 0, "`gamma` is 0");
    REFUSES(gamma.value[0], -2.5, "`gamma` is -2.5");
    REFUSES(gamma.value[0], 10.01, "`gamma` is 10.01");
    REFUSES(gamma.value[0], NAN, "`gamma` is nan");
    REFUSES(lambda, -0.5, "`lambda` is -0.5");
    REFUSES(lambda, INFINITY, "`lambda` is inf");
    REFUSES(blood.p_perf_mmhg, INFINITY, "`p_perf_mmHg` is inf");
    REFUSES(blood.p_term_mmhg, 100, "`p_term_mmHg` is 100");
    REFUSES(blood.p_term_mmhg, 100.5, "`p_term_mmHg` is 100.5");
    REFUSES(blood.p_term_mmhg, -INFINITY, "`p_term_mmHg` is -inf");
    REFUSES(blood.q_perf_ml_min, 0, "`q_perf_ml_min` is 0");
    REFUSES(blood.q_perf_ml_min, NAN, "`q_perf_ml_min` is nan");
    REFUSES(blood.viscosity_cp, -3.6, "`viscosity_cP` is -3.6");
    REFUSES(blood.viscosity_cp, INFINITY, "`viscosity_cP` is inf");
    REFUSES(candidates, 0, "`candidates` is 0");
    REFUSES(candidates, GROW_MAX_CANDIDATES + 1, "`candidates` is 1001");
    GrowParams params = grow_defaults();
    params.inlets = 1;
    const Vec3 inlets[] = {{0, 50.1, 0}, {3, 4, 0.01}, {NAN, 0, 0}};
    for (size_t i = 0; i < sizeof inlets / sizeof *inlets; i++) {
        params.inlet = &inlets[i];
        assert_refused(params, "`inlet`");
    }
    const Vec3 rim = vec3(35.3553391, 35.3553391, 0); /* but for typing */
    params.inlet = &rim;
    Domain domain = domain_of("disc:50");
    assert_int_equal(grow_params_check(&params, &domain, NULL), STATUS_OK);
}

static void assert_infeasible(const GrowParams *params, const char *spec, const char *change)
{
    Domain domain = domain_of(spec);
    Tree tree = {.n = 23};
    Err err = {""};
    assert_int_equal(grow_tree(params, &domain, &tree, NULL, &err), STATUS_INFEASIBLE);
    assert_non_null(strstr(err.text, change));
    assert_int_equal(tree.n, 23);
}

static void says_what_to_change_when_the_radii_exceed_all_numbers(void **state)
{
    (void)state;
    GrowParams params = grow_defaults();
    params.gamma = logcurve_constant(0.01);
    assert_infeasible(&params, "disc:50", "with this `gamma` and");
    params.lambda = 100;
    params.gamma = logcurve_constant(0.05);
    assert_infeasible(&params, "disc:50", "gave up placing terminal 2 of `terminals` 1000");
    params.gamma = logcurve_constant(3);
    params.lambda = 5000;
    assert_infeasible(&params, "disc:50", "`lambda` 5000");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_two_and_three_terminals_make_trees),
        cmocka_unit_test(laws_hold_for_any_gamma_and_lambda),
        cmocka_unit_test(laws_hold_for_any_flow_pressure_and_size),
        cmocka_unit_test(segments_in_the_plane_never_cross),
        cmocka_unit_test(vessels_are_longer_than_wide_and_clear_of_each_other),
        cmocka_unit_test(vessels_without_room_count_as_thinner_by_halves_down_to_lines),
        cmocka_unit_test(targets_are_lower_than_published_peers_reach),
        cmocka_unit_test(one_seed_gives_one_tree),
        cmocka_unit_test(the_number_of_threads_does_not_change_the_tree),
        cmocka_unit_test(terminals_fill_the_tissue_evenly),
        cmocka_unit_test(the_header_tells_how_the_tree_was_made),
        cmocka_unit_test(progress_rises),
        cmocka_unit_test(refuses_parameters_out_of_range_and_names_the_option),
        cmocka_unit_test(says_what_to_change_when_the_radii_exceed_all_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
