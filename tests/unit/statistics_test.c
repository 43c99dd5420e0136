/* Statistics of trees: vessels, orders, elements, ratios, bifurcations. */
#include "derive/derive.h"
#include "unit.h"

#include "treeio/treeio.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const TreeMeta no_options;

static void assert_close(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-12 * fabs(expected)))
        fail_msg("%.17g is not %.17g", value, expected);
}

static Tree make_tree(size_t n, const int32_t *parent, const double *radius, const double *length)
{
    Tree tree;
    Err err;
    must(tree_init(&tree, n, &err), &err);
    for (size_t i = 0; i < n; i++) {
        tree.id[i] = (int32_t)i + 1;
        tree.parent[i] = parent[i];
        tree.radius_mm[i] = radius[i];
        if (parent[i] >= 0)
            tree.position[i] = vec3_add_scaled(tree.position[parent[i]],
                                               vec3(0.6, i % 2 ? 0.8 : -0.8, 0), length[i]);
    }
    must(tree_check(&tree, &err), &err);
    return tree;
}

static TreeStatistics statistics_of(const Tree *tree)
{
    TreeStatistics statistics;
    Err err;
    must(derive_statistics(tree, &statistics, &err), &err);
    return statistics;
}

static Field field_of(const Tree *tree, const char *name)
{
    Field field;
    Err err;
    must(derive_field(tree, &no_options, name, &field, &err), &err);
    return field;
}

static void assert_row(const StatisticsTable *table, size_t at, StatisticsRow expected)
{
    assert_true(at < table->n);
    const StatisticsRow *row = &table->row[at];
    assert_int_equal(row->number, expected.number);
    assert_int_equal(row->vessels, expected.vessels);
    assert_int_equal(row->elements, expected.elements);
    assert_close(row->radius_mm.mean, expected.radius_mm.mean);
    assert_close(row->length_mm.mean, expected.length_mm.mean);
    assert_true(fabs(row->radius_mm.sd - expected.radius_mm.sd) < 1e-12);
    assert_true(fabs(row->length_mm.sd - expected.length_mm.sd) < 1e-12);
}

/* Three thicknesses, 4, 2 and 1 mm: a trunk (1), branches (2; 3 and 9, in series) and twigs.
 * Segment 5, a twig that forks, has Strahler order 2 but the thickness of order 1. */
enum { HAND_N = 12 };
static const int32_t hand_parent[HAND_N] = {-1, 0, 1, 1, 2, 2, 5, 5, 3, 3, 9, 9};
static const double hand_radius[HAND_N] = {4, 4, 2, 2.1, 1, 1.05, 0.95, 0.9, 1, 1.9, 1, 1.02};
static const double hand_length[HAND_N] = {0, 9, 5, 6, 1.5, 2.5, 1.25, 0.5, 2, 4, 1, 3};

static void orders_by_diameter_converge_to_the_three_thicknesses(void **state)
{
    (void)state;
    Tree tree = make_tree(HAND_N, hand_parent, hand_radius, hand_length);
    static const int strahler[HAND_N] = {0, 3, 2, 2, 1, 2, 1, 1, 1, 2, 1, 1};
    static const int by_diameter[HAND_N] = {0, 3, 2, 2, 1, 1, 1, 1, 1, 2, 1, 1};
    Field plain = field_of(&tree, "strahler"), diameter = field_of(&tree, "diameter-strahler");
    assert_true(isnan(diameter.value[0]));
    for (int i = 1; i < HAND_N; i++) {
        assert_true(plain.value[i] == strahler[i]);
        assert_true(diameter.value[i] == by_diameter[i]);
    }
    TreeStatistics statistics = statistics_of(&tree);
    assert_true(statistics.diameter_orders_converged);
    assert_int_equal(statistics.diameter_rounds, 2); /* 5 moves, then nothing does */
    statistics_release(&statistics);
    field_release(&plain);
    field_release(&diameter);
    tree_release(&tree);
}

/* A forest of COPIES trees: a trunk, two branches of order 2 and the diameters 1.6 mm and `thin`
 * mm, in the first `changed` trees, and four twigs. */
static Tree forest_of(size_t copies, size_t changed, double thin)
{
    static const int32_t parent[8] = {-1, 0, 1, 1, 2, 2, 3, 3};
    enum { MOST = 32 };
    int32_t parents[8 * MOST];
    double radii[8 * MOST], lengths[8 * MOST];
    assert_true(copies <= MOST);
    for (size_t i = 0; i < 8 * copies; i++) {
        const double diameter[8] = {4, 4, 1.6, i / 8 < changed ? thin : 1.6, 1, 1.4, 1, 1.4};
        parents[i] = i % 8 ? (int32_t)(i - i % 8) + parent[i % 8] : -1;
        radii[i] = diameter[i % 8] / 2;
        lengths[i] = i % 8 ? 3 : 0;
    }
    return make_tree(8 * copies, parents, radii, lengths);
}

/* Twigs have the mean 1.2 mm and the standard deviation 0.231; with branches of 1.6 and x mm the
 * bound is x where x = (1.2 + 0.231 + (1.6 + x) / 2 - (1.6 - x) / sqrt2) / 2: at 1.3868 mm. */
static void the_bound_between_orders_lies_between_their_deviations(void **state)
{
    (void)state;
    for (int below = 0; below < 2; below++) {
        Tree tree = forest_of(1, 1, below ? 1.386 : 1.388);
        Field order = field_of(&tree, "diameter-strahler");
        assert_true(order.value[2] == 2);
        assert_true(order.value[3] == (below ? 1 : 2));
        field_release(&order);
        tree_release(&tree);
    }
}

static void orders_have_converged_when_one_vessel_in_a_hundred_changes(void **state)
{
    (void)state;
    const struct {
        size_t copies, changed;
        int rounds;
    } cases[] = {{28, 1, 1}, {28, 2, 2}, {29, 2, 1}}; /* 1 and 2 of 196, 2 of 203 vessels */
    for (int i = 0; i < 3; i++) {
        Tree tree = forest_of(cases[i].copies, cases[i].changed, 1.2);
        TreeStatistics statistics = statistics_of(&tree);
        assert_int_equal(statistics.diameter_rounds, cases[i].rounds);
        assert_true(statistics.diameter_orders_converged);
        statistics_release(&statistics);
        tree_release(&tree);
    }
}

static void tables_of_a_tree_by_hand(void **state)
{
    (void)state;
    Tree tree = make_tree(HAND_N, hand_parent, hand_radius, hand_length);
    TreeStatistics statistics = statistics_of(&tree);
    assert_int_equal(statistics.vessels, 11);
    assert_int_equal(statistics.by_level.n, 4);
    assert_row(&statistics.by_level, 0, (StatisticsRow){0, 1, 1, {4, 0}, {9, 0}});
    assert_row(&statistics.by_level, 1,
               (StatisticsRow){1, 2, 2, {2.05, sqrt(0.005)}, {5.5, sqrt(0.5)}});
    assert_row(
        &statistics.by_level, 2,
        (StatisticsRow){
            2, 4, 4, {4.95 / 4, 0.44229515032385325}, {2.5, sqrt((1 + 0 + 0.25 + 2.25) / 3)}});
    assert_int_equal(statistics.by_strahler.n, 3);
    /* order 2: 2 with its heir 5, and 3 with 9 */
    assert_row(&statistics.by_strahler, 1,
               (StatisticsRow){2, 4, 2, {1.7625, sqrt(2) * 0.2375}, {8.75, sqrt(2) * 1.25}});
    /* order 1: 5 with its heir 6, and 4, 7, 8, 10, 11 alone */
    assert_int_equal(statistics.by_diameter_strahler.n, 3);
    const StatisticsRow *twigs = &statistics.by_diameter_strahler.row[0];
    assert_int_equal(twigs->vessels, 7);
    assert_int_equal(twigs->elements, 6);
    assert_close(twigs->radius_mm.mean, (1 + 1 + 0.9 + 1 + 1 + 1.02) / 6);
    assert_close(twigs->length_mm.mean, (1.5 + 3.75 + 0.5 + 2 + 1 + 3) / 6);
    assert_row(&statistics.by_diameter_strahler, 1,
               (StatisticsRow){2, 3, 2, {2, 0}, {7.5, sqrt(12.5)}});
    assert_row(&statistics.by_diameter_strahler, 2, (StatisticsRow){3, 1, 1, {4, 0}, {9, 0}});

    assert_int_equal(statistics.symmetry.count, 5);
    double symmetry[] = {2 / 2.1, 1 / 1.05, 0.9 / 0.95, 1 / 1.9, 1 / 1.02}, sum = 0;
    for (int i = 0; i < 5; i++)
        sum += symmetry[i];
    assert_close(statistics.symmetry.mean, sum / 5);
    assert_close(statistics.symmetry.median, 1 / 1.05);
    assert_close(statistics.area_ratio.median, (1 + 1.02 * 1.02) / (1.9 * 1.9));
    statistics_release(&statistics);
    tree_release(&tree);
}

static void elements_spring_from_elements_of_their_own_and_higher_orders(void **state)
{
    (void)state;
    Tree tree = make_tree(HAND_N, hand_parent, hand_radius, hand_length);
    TreeStatistics statistics = statistics_of(&tree);
    /* twig 7 from 5 with its heir 6; 4 and 5 from branch 2, and 8, 10, 11 from 3 with its heir 9 */
    const double daughters[3][3] = {{1.0 / 6, 0, 0}, {2.5, 0, 0}, {0, 2, 0}};
    for (int i = 0; i < 9; i++)
        if (fabs(statistics.daughters[i] - daughters[i / 3][i % 3]) > 1e-12)
            fail_msg("entry %d is %g", i, statistics.daughters[i]);
    statistics_release(&statistics);
    tree_release(&tree);
}

static char folder[] = "/tmp/corcast-statistics-XXXXXX", table_path[64];

static void write_table(const char *text)
{
    FILE *file = fopen(table_path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static const MorphometryPair *find_pair(const MorphometryComparison *comparison,
                                        MorphometryMeasure measure, int order)
{
    for (size_t i = 0; i < comparison->n; i++)
        if (comparison->pair[i].measure == measure && comparison->pair[i].order == order)
            return &comparison->pair[i];
    return NULL;
}

static const char five_orders[] =
    "# the head\nsource Nobody (1999)\nratios 2.44 nan 1.3\nfitted-from 1 1 3\n"
    "1 1000 100 1.1 .1 80 2 nan .1 nan nan nan\n"
    "2 1900 80 1.3 .7 24 1.2 nan .2 2.2 nan nan\n"
    "3 4100 90 7.9 3 8 1.9 nan\ndaughters 3 nan nan 2.4 .01 .4 nan\n"
    "4 8100 nan 13 nan 3 1 .6\ndaughters 4 .2 nan 2.3 .4 .1 .06 .3 nan\n"
    "5 16000 nan nan nan 1 3 nan nan nan nan nan\n";

/* Compares by the table of five orders. */
static void compare_with_five(const Tree *tree, MorphometryComparison comparison[])
{
    TreeStatistics statistics = statistics_of(tree);
    Morphometry table;
    Err err;
    write_table(five_orders);
    must(morphometry_read(&table, table_path, &err), &err);
    assert_string_equal(table.source, "Nobody (1999)");
    assert_int_equal(table.n, 5);
    assert_true(morphometry_bound_mm(&table, 0) == 0);
    assert_close(morphometry_bound_mm(&table, 1), (1.1 + 1.82) / 2);
    assert_close(morphometry_bound_mm(&table, 4), 12.05); /* of two single elements */
    assert_true(isinf(morphometry_bound_mm(&table, 5)));
    must(morphometry_compare(tree, &statistics, &table, comparison, &err), &err);
    morphometry_release(&table);
    statistics_release(&statistics);
}

/* The tree's orders 1 to 3, of diameters 1.97, 4 and 8 mm, are orders 2 to 4 of the table. Both
 * kinds of orders have the same vessels. */
static void a_tree_stands_beside_the_published_orders_of_its_diameters(void **state)
{
    (void)state;
    Tree tree = make_tree(HAND_N, hand_parent, hand_radius, hand_length);
    TreeStatistics statistics = statistics_of(&tree);
    MorphometryComparison beside[MORPHOMETRY_ORDERS];
    compare_with_five(&tree, beside);
    const struct {
        MorphometryMeasure measure;
        int order, published; /* order: the one found */
        double value, mean, room;
    } pairs[] = {
        {COMPARED_DIAMETER, 1, 2, 2 * 5.92 / 6, 1.9, 0.08},
        {COMPARED_DIAMETER, 3, 4, 8, 8.1, 0.25 * 8.1},
        {COMPARED_LENGTH, 2, 3, 7.5, 7.9, 3},
        {COMPARED_VESSELS, 2, 3, 1.5, 1.9, 0.25 * 1.9},
        {COMPARED_VESSELS, 3, 4, 1, 1, 0.6},
        {COMPARED_DAUGHTERS, 1, 2, 1.0 / 6, 0.2, 0.05},
        {COMPARED_DAUGHTERS_1_LESS, 2, 3, 2.5, 2.4, 0.6},
        {COMPARED_DAUGHTERS_1_LESS, 3, 4, 2, 2.3, 0.8}, /* of 2 standard errors */
        {COMPARED_DAUGHTERS_2_LESS, 3, 4, 0, 0.1, 0.12},
        {COMPARED_NUMBER_RATIO, 0, 0, statistics.diameter_strahler_ratios.number, 2.44, 0.61},
        {COMPARED_LENGTH_RATIO, 0, 0, 9 / 7.5, 1.3, 0.325}};
    for (int kind = 0; kind < MORPHOMETRY_ORDERS; kind++) {
        int more = kind == ORDERS_PUBLISHED;
        for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
            const MorphometryPair *pair = find_pair(&beside[kind], pairs[i].measure,
                                                    pairs[i].order + (pairs[i].order ? more : 0));
            assert_non_null(pair);
            assert_int_equal(pair->published_order, pairs[i].published);
            assert_true(fabs(pair->value - pairs[i].value) < 1e-12);
            assert_close(pair->published.mean, pairs[i].mean);
            assert_close(pair->tolerance, pairs[i].room);
            assert_true(pair->agrees);
            assert_true(pair->agrees_strictly == (pairs[i].measure != COMPARED_DAUGHTERS_2_LESS));
        }
        /* not published, or not of a tree of three orders */
        assert_null(find_pair(&beside[kind], COMPARED_DIAMETER_RATIO, 0));
        assert_null(find_pair(&beside[kind], COMPARED_DAUGHTERS, 2 + more));
        assert_null(find_pair(&beside[kind], COMPARED_DAUGHTERS_3_LESS, 3 + more));
        size_t agreeing = 0, strictly = 0;
        for (size_t i = 0; i < beside[kind].n; i++) {
            agreeing += beside[kind].pair[i].agrees;
            strictly += beside[kind].pair[i].agrees_strictly;
        }
        assert_int_equal(beside[kind].agreeing, agreeing);
        assert_int_equal(beside[kind].agreeing_strictly, strictly);
        free(beside[kind].pair);
    }
    statistics_release(&statistics);
    tree_release(&tree);
}

/* A vessel of 1 mm, of order 1 by its diameter, with daughters of 4 mm (order 3) and 1 mm. */
static void a_published_order_is_never_below_that_of_a_daughter(void **state)
{
    (void)state;
    static const int32_t parent[] = {-1, 0, 1, 1};
    static const double radius[] = {0.5, 0.5, 2, 0.5}, length[] = {0, 3, 2, 1};
    Tree tree = make_tree(4, parent, radius, length);
    MorphometryComparison beside[MORPHOMETRY_ORDERS];
    compare_with_five(&tree, beside);
    const MorphometryComparison *own = &beside[ORDERS_PUBLISHED];
    assert_close(find_pair(own, COMPARED_LENGTH, 3)->value, 5);
    assert_close(find_pair(own, COMPARED_VESSELS, 3)->value, 2);
    assert_close(find_pair(own, COMPARED_LENGTH, 1)->value, 1);
    assert_null(find_pair(own, COMPARED_LENGTH, 2));
    assert_true(find_pair(own, COMPARED_DAUGHTERS_1_LESS, 3)->value == 0);
    assert_close(find_pair(own, COMPARED_DAUGHTERS_2_LESS, 3)->value, 1);
    for (int kind = 0; kind < MORPHOMETRY_ORDERS; kind++)
        free(beside[kind].pair);
    tree_release(&tree);
}

static void rejects_a_table_of_morphometry_that_is_none(void **state)
{
    (void)state;
    static const char *const wrong[][2] = {
        {"", ": a table of morphometry needs a row for order 1"},
        {"1 9 1 1 1 9 2 nan .1 nan nan nan\n", ": a table of morphometry needs a source"},
        {"source X\n2 9 1 1 1 9 2 nan .1 nan nan nan\n",
         ":2: the row begins with order 2 and diameter 9; it must be order 1, and a "
         "diameter above 0"},
        {"source X\n1 0 1 1 1 9 2 nan .1 nan nan nan\n", ":2: the row begins with order 1"},
        {"source X\nratios 2 3\n", ":2: 'ratios 2 3' is not a row of the table"},
        {"source X\nfitted-from 1 1 2.5\n", ":2: 'fitted-from 1 1 2.5' is not a row"},
        {"source X\nfitted-from 1 nan 1\n", ":2: 'fitted-from 1 nan 1' is not a row"},
        {"source X\nsource Y\n", ":2: 'source Y' is not a row"},
        {"source X\ndaughters 1 2 .1\n", ":2: 'daughters 1 2 .1' is not a row"},
        {"source X\n1 9 1 1 1 9 2 nan\ndaughters 2 2 .1\n", ":3: 'daughters 2 2 .1' is not a row"},
        {"source X\n1 9 1 1 1 9 2 nan\ndaughters 1 2\n", ":3: 'daughters 1 2' is not a row"},
        {"source X\n1 9 1 1 1 9 2 nan\ndaughters 1 2 .1 3 .1\n", ":3: 'daughters 1 2 .1 3"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        Morphometry table;
        Err err;
        write_table(wrong[i][0]);
        assert_int_equal(morphometry_read(&table, table_path, &err), STATUS_INPUT);
        size_t length = strlen(table_path);
        if (strncmp(err.text, table_path, length) != 0 ||
            strncmp(err.text + length, wrong[i][1], strlen(wrong[i][1])) != 0)
            fail_msg("'%s' is not '%s'", err.text, wrong[i][1]);
    }
}

/* Radii grow by the cube root of 2 and lengths by 1.5 from order to order. */
static void a_perfect_tree_has_the_ratios_it_was_made_with(void **state)
{
    (void)state;
    enum { ORDERS = 7, N = 1 << ORDERS };
    int32_t parent[N];
    double radius[N], length[N];
    for (int i = 0; i < N; i++) {
        int level = 0;
        while (i >> (level + 1))
            level++;
        parent[i] = i < 2 ? i - 1 : i / 2;
        radius[i] = 2.385 * pow(2, -level / 3.0);
        length[i] = 17.5 * pow(1.5, -level);
    }
    Tree tree = make_tree(N, parent, radius, length);
    TreeStatistics statistics = statistics_of(&tree);
    for (int kind = 0; kind < 2; kind++) {
        const OrderRatios *ratios =
            kind ? &statistics.diameter_strahler_ratios : &statistics.strahler_ratios;
        assert_close(ratios->number, 2);
        assert_close(ratios->diameter, cbrt(2));
        assert_close(ratios->length, 1.5);
    }
    assert_int_equal(statistics.by_diameter_strahler.n, ORDERS);
    assert_close(statistics.symmetry.median, 1);
    assert_close(statistics.area_ratio.mean, cbrt(2));
    assert_true(statistics.area_ratio.sd < 1e-12);
    statistics_release(&statistics);
    tree_release(&tree);
}

/* Four bifurcations, whose daughters' radii are as 0.5, 0.8, 0.95 and 1. */
static void bifurcations_spread_as_a_calculator_says(void **state)
{
    (void)state;
    enum { N = 10 };
    const int32_t parent[N] = {-1, 0, 1, 1, 2, 2, 4, 4, 3, 3};
    const double radius[N] = {2, 2, 1.8, 0.9, 1.5, 1.2, 1, 0.95, 0.8, 0.8};
    const double length[N] = {0, 9, 8, 7, 6, 5, 4, 4, 3, 3};
    Tree tree = make_tree(N, parent, radius, length);
    TreeStatistics statistics = statistics_of(&tree);
    assert_int_equal(statistics.symmetry.count, 4);
    assert_close(statistics.symmetry.mean, 0.8125);
    assert_close(statistics.symmetry.sd, 0.225);
    assert_close(statistics.symmetry.median, 0.875);
    statistics_release(&statistics);
    tree_release(&tree);
}

static void assert_same_table(const StatisticsTable *a, const StatisticsTable *b)
{
    assert_int_equal(a->n, b->n);
    for (size_t i = 0; i < a->n; i++)
        assert_row(a, i, b->row[i]);
}

/* Every segment of the tree in `pieces` steps, the last but one of length 0. */
static Tree subdivided(const Tree *tree, int pieces)
{
    Tree made;
    Err err;
    int32_t *last = calloc(tree->n, sizeof *last), n = 0;
    must(tree_init(&made, tree->n * (size_t)pieces, &err), &err);
    for (size_t i = 0; i < tree->n; i++) {
        int steps = tree_is_segment(tree, i) ? pieces : 1;
        for (int k = 1; k <= steps; k++, n++) {
            made.id[n] = n + 1;
            made.radius_mm[n] = tree->radius_mm[i];
            made.position[n] = tree->position[i];
            if (!tree_is_segment(tree, i))
                continue;
            Vec3 from = tree->position[tree->parent[i]];
            double fraction = k == steps ? 1 : fmin(k, steps - 2) / (steps - 1);
            made.parent[n] = k == 1 ? last[tree->parent[i]] : n - 1;
            made.position[n] = vec3_add_scaled(from, vec3_sub(tree->position[i], from), fraction);
        }
        last[i] = n - 1;
    }
    made.n = (size_t)n;
    free(last);
    return made;
}

static void a_tree_in_many_small_steps_has_the_same_statistics(void **state)
{
    (void)state;
    Tree tree = make_tree(HAND_N, hand_parent, hand_radius, hand_length);
    Tree steps = subdivided(&tree, 5);
    TreeStatistics a = statistics_of(&tree), b = statistics_of(&steps);
    assert_int_equal(steps.n, 1 + 5 * (HAND_N - 1));
    assert_int_equal(a.vessels, b.vessels);
    assert_same_table(&a.by_level, &b.by_level);
    assert_same_table(&a.by_strahler, &b.by_strahler);
    assert_same_table(&a.by_diameter_strahler, &b.by_diameter_strahler);
    assert_close(a.strahler_ratios.length, b.strahler_ratios.length);
    assert_close(a.volume_mm3, b.volume_mm3);
    statistics_release(&a);
    statistics_release(&b);
    tree_release(&steps);
    tree_release(&tree);
}

static void a_vessel_whose_radius_changes_has_the_mean_weighted_by_length(void **state)
{
    (void)state;
    const int32_t parent[] = {-1, 0, 1, 2};
    const double radius[] = {2, 2, 1.25, 77}, length[] = {0, 3, 1, 0};
    Tree tree = make_tree(4, parent, radius, length);
    TreeStatistics statistics = statistics_of(&tree);
    assert_int_equal(statistics.vessels, 1);
    assert_row(&statistics.by_level, 0, (StatisticsRow){0, 1, 1, {1.8125, 0}, {4, 0}});
    statistics_release(&statistics);
    tree_release(&tree);
}

static void the_smallest_trees_have_statistics(void **state)
{
    (void)state;
    const int32_t parent[] = {-1, 0};
    const double radius[] = {1.375, 1.375}, length[] = {0, 2.5};
    for (size_t n = 1; n <= 2; n++) {
        Tree tree = make_tree(n, parent, radius, length);
        TreeStatistics statistics = statistics_of(&tree);
        assert_int_equal(statistics.vessels, n - 1);
        assert_int_equal(statistics.by_level.n, n - 1);
        assert_int_equal(statistics.by_strahler.n, n - 1);
        assert_int_equal(statistics.by_diameter_strahler.n, n - 1);
        assert_true(isnan(statistics.strahler_ratios.number));
        assert_true(isnan(statistics.diameter_strahler_ratios.length));
        assert_int_equal(statistics.symmetry.count + statistics.area_ratio.count, 0);
        assert_true(isnan(statistics.symmetry.median));
        assert_true(statistics.diameter_orders_converged);
        statistics_release(&statistics);
        assert_null(statistics.by_level.row);
        tree_release(&tree);
    }
}

static void check_table(const StatisticsTable *table, size_t vessels, double total_length)
{
    size_t sum = 0;
    double length = 0;
    for (size_t i = 0; i < table->n; i++) {
        const StatisticsRow *row = &table->row[i];
        assert_true(row->elements > 0 && row->elements <= row->vessels);
        assert_true(i == 0 || row->number > row[-1].number);
        sum += row->vessels;
        length += row->length_mm.mean * (double)row->elements;
    }
    assert_int_equal(sum, vessels);
    assert_true(fabs(length - total_length) <= 1e-12 * total_length);
}

/* Orders never fall towards a root, and start at 1. */
static void check_nesting(const Tree *tree, const char *name)
{
    Field order = field_of(tree, name);
    double least = HUGE_VAL;
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i))
            continue;
        least = fmin(least, order.value[i]);
        size_t parent = (size_t)tree->parent[i];
        assert_true(!tree_is_segment(tree, parent) || order.value[parent] >= order.value[i]);
    }
    assert_true(least == 1 || !isfinite(least));
    field_release(&order);
}

static void check_invariants(const Tree *tree)
{
    TreeStatistics statistics = statistics_of(tree);
    TreeSummary summary;
    Err err;
    must(derive_summary(tree, &no_options, &summary, &err), &err);
    check_table(&statistics.by_level, statistics.vessels, summary.total_length_mm);
    check_table(&statistics.by_strahler, statistics.vessels, summary.total_length_mm);
    check_table(&statistics.by_diameter_strahler, statistics.vessels, summary.total_length_mm);
    if (summary.terminals > 0) {
        assert_int_equal(statistics.by_strahler.row[0].number, 1);
        assert_int_equal(statistics.by_diameter_strahler.row[0].number, 1);
        assert_true(statistics.by_strahler.row[0].vessels == summary.terminals);
        assert_true(statistics.by_diameter_strahler.row[0].vessels >= summary.terminals);
        size_t rows = statistics.by_strahler.n;
        assert_int_equal(statistics.by_strahler.row[rows - 1].number, summary.max_strahler);
        assert_true(statistics.by_diameter_strahler.n <= rows);
    }
    assert_true(statistics.symmetry.count <= summary.bifurcations);
    assert_true(!(statistics.symmetry.mean > 1));
    assert_close(statistics.volume_mm3, summary.volume_mm3);
    check_nesting(tree, "strahler");
    check_nesting(tree, "diameter-strahler");
    statistics_release(&statistics);
}

/* Forests with nodes of any number of children, steps of length 0 and radii of 0. */
static void counts_add_up_and_orders_nest_in_random_forests(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 20250711);
    for (int round = 0; round < 300; round++) {
        enum { N = 200 };
        int32_t parent[N];
        double radius[N], length[N];
        size_t n = 1 + (size_t)(random_uniform(&random) * (N - 1));
        double chain = random_uniform(&random), loose = random_uniform(&random);
        for (size_t i = 0; i < n; i++) {
            bool root = i == 0 || random_uniform(&random) < 0.03;
            bool on = random_uniform(&random) < chain;
            parent[i] = root ? -1
                        : on ? (int32_t)i - 1
                             : (int32_t)(random_uniform(&random) * (double)i);
            radius[i] = random_uniform(&random) < 0.05 * loose ? 0 : random_uniform(&random);
            length[i] = random_uniform(&random) < 0.2 * loose ? 0 : random_uniform(&random);
        }
        Tree tree = make_tree(n, parent, radius, length);
        check_invariants(&tree);
        tree_release(&tree);
    }
}

static void measured_trees_have_statistics(void **state)
{
    (void)state;
    const char *shared = getenv("CORCAST_SHARED");
    char path[400];
    snprintf(path, sizeof path, "%s/data/brava/BG0002records.swc", shared ? shared : "../shared");
    if (access(path, R_OK) != 0) {
        print_message("skipped: %s is not here\n", path);
        skip();
    }
    Tree tree;
    Err err;
    must(tree_read(&tree, path, &err), &err);
    check_invariants(&tree);
    TreeStatistics statistics = statistics_of(&tree);
    assert_true(statistics.diameter_orders_converged);
    assert_true(statistics.vessels < 300 && statistics.symmetry.median > 0.5);
    statistics_release(&statistics);
    tree_release(&tree);
}

static int make_folder(void **state)
{
    (void)state;
    if (!mkdtemp(folder))
        return -1;
    snprintf(table_path, sizeof table_path, "%s/table.txt", folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    return remove(table_path) == 0 ? rmdir(folder) : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(orders_by_diameter_converge_to_the_three_thicknesses),
        cmocka_unit_test(the_bound_between_orders_lies_between_their_deviations),
        cmocka_unit_test(orders_have_converged_when_one_vessel_in_a_hundred_changes),
        cmocka_unit_test(tables_of_a_tree_by_hand),
        cmocka_unit_test(elements_spring_from_elements_of_their_own_and_higher_orders),
        cmocka_unit_test(a_tree_stands_beside_the_published_orders_of_its_diameters),
        cmocka_unit_test(a_published_order_is_never_below_that_of_a_daughter),
        cmocka_unit_test(rejects_a_table_of_morphometry_that_is_none),
        cmocka_unit_test(a_perfect_tree_has_the_ratios_it_was_made_with),
        cmocka_unit_test(bifurcations_spread_as_a_calculator_says),
        cmocka_unit_test(a_tree_in_many_small_steps_has_the_same_statistics),
        cmocka_unit_test(a_vessel_whose_radius_changes_has_the_mean_weighted_by_length),
        cmocka_unit_test(the_smallest_trees_have_statistics),
        cmocka_unit_test(counts_add_up_and_orders_nest_in_random_forests),
        cmocka_unit_test(measured_trees_have_statistics),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
