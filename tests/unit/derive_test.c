/* Derived fields of trees, compared with values computed by hand. */
#include "derive/derive.h"
#include "unit.h"

#include "treeio/treeio.h"
#include <stdlib.h>
#include <string.h>

static const TreeMeta no_options;

#define SAYS(key, value) .known[META_##key] = true, .number[META_##key] = (value)

static Tree read_tree(const char *path)
{
    Tree tree = {0};
    Err err;
    must(tree_read(&tree, path, &err), &err);
    return tree;
}

/* A tree whose nodes lie along x, 1.25 mm apart. */
static Tree make_tree(size_t n, const int32_t *parent, const double *radius)
{
    Tree tree;
    Err err;
    must(tree_init(&tree, n, &err), &err);
    for (size_t i = 0; i < n; i++) {
        tree.id[i] = (int32_t)i + 1;
        tree.parent[i] = parent[i];
        tree.position[i] = vec3(1.25 * (double)i, 0.5, -3);
        tree.radius_mm[i] = radius[i];
    }
    return tree;
}

/* NAN stands for NAN; else equal to 1e-13 of the value. */
static void assert_field(const Tree *tree, const TreeMeta *params, const char *name,
                         const char *unit, const double *expected)
{
    Field field;
    Err err;
    must(derive_field(tree, params, name, &field, &err), &err);
    assert_string_equal(field.name, name);
    assert_string_equal(field.unit, unit);
    assert_int_equal(field.n, tree->n);
    for (size_t i = 0; i < field.n; i++) {
        bool same = isnan(expected[i])
                        ? isnan(field.value[i])
                        : fabs(field.value[i] - expected[i]) <= 1e-13 * fabs(expected[i]);
        if (!same)
            fail_msg("%s of node %zu is %.17g, not %.17g", name, i, field.value[i], expected[i]);
    }
    field_release(&field);
    assert_null(field.value);
}

static void assert_close(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-13 * fabs(expected)))
        fail_msg("%.17g is not %.17g", value, expected);
}

static const double none = (double)NAN;

static void fields_of_a_bifurcation_are_what_a_calculator_says(void **state)
{
    (void)state;
    Tree tree = read_tree("tests/data/bifurcation.swc");
    const double radius[] = {none, 2.385, 1.655, 2.0625};
    const double length[] = {none, 17.54458605952275, 17.511157157652374, 14.342354234922523};
    const double flow[] = {none, 212.5, 106.25, 106.25};
    const double velocity[] = {none, 198.18968370055546, 205.79357865802464, 132.507329418413};
    const double pressure[] = {none, 97.17345254835641, 96.90108418011108, 97.0809660298394};
    const double wss[] = {none, 1.146757918267365, 1.7159827102602663, 0.8865944950177453};
    const double reynolds[] = {none, 287.71971907658894, 207.3146616307144, 166.35431030246417};
    assert_field(&tree, &no_options, "radius", "mm", radius);
    assert_field(&tree, &no_options, "length", "mm", length);
    assert_field(&tree, &no_options, "flow", "ml/min", flow);
    assert_field(&tree, &no_options, "velocity", "mm/s", velocity);
    assert_field(&tree, &no_options, "pressure", "mmHg", pressure);
    assert_field(&tree, &no_options, "wss", "Pa", wss);
    assert_field(&tree, &no_options, "reynolds", "", reynolds);
    tree_release(&tree);
}

static void options_override_the_header(void **state)
{
    (void)state;
    Tree tree = read_tree("tests/data/bifurcation.swc");
    TreeMeta params = {SAYS(Q_PERF, 425), SAYS(P_PERF, 104.3), SAYS(VISCOSITY, 1.725)};
    const double flow[] = {none, 425, 212.5, 212.5};
    const double pressure[] = {none, 104.17345254835641, 103.90108418011108, 104.0809660298394};
    const double wss[] = {none, 1.146757918267365, 1.7159827102602663, 0.8865944950177453};
    assert_field(&tree, &params, "flow", "ml/min", flow);
    assert_field(&tree, &params, "pressure", "mmHg", pressure);
    assert_field(&tree, &params, "wss", "Pa", wss);
    tree_release(&tree);
}

static void orders_of_a_trifurcation_and_a_second_root(void **state)
{
    (void)state;
    Tree tree = read_tree("tests/data/trifurcation.swc");
    const double level[] = {none, 0, 0, 1, 1, 1, 2, 2, none, 0};
    const double strahler[] = {none, 2, 2, 2, 1, 1, 1, 1, none, 1};
    const double branch[] = {none, 1, 1, 2, 1, 3, 4, 2, none, 5};
    const double trees[] = {none, 1, 1, 1, 1, 1, 1, 1, none, 2};
    const double flow[] = {none, 26, 26, 13, 6.5, 6.5, 6.5, 6.5, none, 6.5};
    TreeMeta params = {SAYS(Q_PERF, 32.5)};
    assert_field(&tree, &no_options, "level", "", level);
    assert_field(&tree, &no_options, "strahler", "", strahler);
    assert_field(&tree, &no_options, "branch", "", branch);
    assert_field(&tree, &no_options, "tree", "", trees);
    assert_field(&tree, &params, "flow", "ml/min", flow);
    tree_release(&tree);
}

static void two_of_three_daughters_of_the_largest_order_raise_it(void **state)
{
    (void)state;
    /* 0 -> 1 -> { 2 -> {5, 6}, 3, 4 -> {7, 8} }, and the same with 4 a chain */
    const double radius[] = {2.5, 2.5, 1.5, 1.5, 1.5, 0.5, 0.5, 0.25, 0.75};
    const int32_t two_forks[] = {-1, 0, 1, 1, 1, 2, 2, 4, 4};
    const int32_t one_fork[] = {-1, 0, 1, 1, 1, 2, 2, 4, 7};
    const double two_orders[] = {none, 3, 2, 1, 2, 1, 1, 1, 1};
    const double one_order[] = {none, 2, 2, 1, 1, 1, 1, 1, 1};
    Tree tree = make_tree(9, two_forks, radius);
    assert_field(&tree, &no_options, "strahler", "", two_orders);
    tree_release(&tree);
    tree = make_tree(9, one_fork, radius);
    assert_field(&tree, &no_options, "strahler", "", one_order);
    tree_release(&tree);
}

static void the_first_of_equally_thick_daughters_continues_the_branch(void **state)
{
    (void)state;
    const double radius[] = {2.5, 2.5, 1.5, 1.625, 1.625, 0.5, 0.75};
    const int32_t parent[] = {-1, 0, 1, 1, 1, 4, 0};
    const double branch[] = {none, 1, 2, 1, 3, 3, 4};
    const double level[] = {none, 1, 2, 2, 2, 2, 1}; /* the root branches, too */
    Tree tree = make_tree(7, parent, radius);
    assert_field(&tree, &no_options, "branch", "", branch);
    assert_field(&tree, &no_options, "level", "", level);
    tree_release(&tree);
}

static void what_a_radius_of_zero_leaves_undefined_is_nan(void **state)
{
    (void)state;
    const double radius[] = {1.25, 1.25, 0, 0.75, 1.0625};
    const int32_t parent[] = {-1, 0, 1, 2, 1};
    Tree tree = make_tree(5, parent, radius);
    TreeMeta params = {SAYS(Q_PERF, 12.5), SAYS(P_PERF, 88.5), SAYS(VISCOSITY, 3.6)};
    const double flow[] = {none, 12.5, 6.25, 6.25, 6.25};
    assert_field(&tree, &params, "flow", "ml/min", flow);

    static const struct {
        const char *name;
        bool defined[5];
    } expected[] = {{"velocity", {false, true, false, true, true}},
                    {"wss", {false, true, false, true, true}},
                    {"reynolds", {false, true, false, true, true}},
                    {"pressure", {false, true, false, false, true}}};
    for (size_t k = 0; k < sizeof expected / sizeof *expected; k++) {
        Field field;
        Err err;
        must(derive_field(&tree, &params, expected[k].name, &field, &err), &err);
        for (size_t i = 0; i < field.n; i++)
            assert_int_equal(isfinite(field.value[i]) != 0, expected[k].defined[i]);
        field_release(&field);
    }
    TreeSummary summary;
    Err err;
    must(derive_summary(&tree, &params, &summary, &err), &err);
    assert_false(summary.has.terminal_pressure);
    assert_true(summary.min_radius_mm == 0);
    tree_release(&tree);
}

static void a_step_of_length_zero_drops_no_pressure(void **state)
{
    (void)state;
    Tree tree = read_tree("tests/data/trifurcation.swc");
    TreeMeta params = {SAYS(Q_PERF, 32.5), SAYS(P_PERF, 88.5), SAYS(VISCOSITY, 3.6)};
    Field pressure;
    Err err;
    must(derive_field(&tree, &params, "pressure", &pressure, &err), &err);
    assert_true(pressure.value[2] == pressure.value[1]);
    assert_true(pressure.value[3] < pressure.value[2]);
    field_release(&pressure);
    tree_release(&tree);
}

static void assert_needs(const TreeMeta *params, const char *name, const char *sentence)
{
    Tree tree = read_tree("tests/data/trifurcation.swc");
    Field field = {.n = 77};
    Err err;
    assert_int_equal(derive_field(&tree, params, name, &field, &err), STATUS_INPUT);
    assert_string_equal(err.text, sentence);
    assert_int_equal(field.n, 77);
    tree_release(&tree);
}

static void missing_data_are_asked_for_by_option(void **state)
{
    (void)state;
    TreeMeta params = {0};
    assert_needs(
        &params, "flow",
        "the field flow needs the flow through the inlet, which is not stored in this tree; "
        "give `q_perf_ml_min` or the header key q_perf_ml_min");
    assert_needs(
        &params, "pressure",
        "the field pressure needs the pressure at the inlet, which is not stored in this tree; "
        "give `p_perf_mmHg` or the header key p_perf_mmHg");
    meta_set_number(&params, META_Q_PERF, 32.5);
    static const char *const viscous[] = {"wss", "reynolds"};
    for (size_t i = 0; i < 2; i++) {
        char sentence[200];
        snprintf(
            sentence, sizeof sentence,
            "the field %s needs the viscosity of the blood, which is not stored in this tree; give "
            "`viscosity_cP` or the header key viscosity_cP",
            viscous[i]);
        assert_needs(&params, viscous[i], sentence);
    }
}

static void an_unknown_field_is_answered_with_the_known_ones(void **state)
{
    (void)state;
    Tree tree = read_tree("tests/data/bifurcation.swc");
    Field field;
    Err err;
    assert_int_equal(derive_field(&tree, &no_options, "color", &field, &err), STATUS_USAGE);
    assert_string_equal(
        err.text,
        "there is no field 'color'; the fields are radius, length, flow, velocity, "
        "pressure, wss, reynolds, level, strahler, diameter-strahler, branch, tree, type");
    tree_release(&tree);
}

static void flow_goes_by_the_shares_of_the_nodes(void **state)
{
    (void)state;
    Tree tree = read_tree("tests/data/trifurcation.swc");
    Err err;
    must(tree_add_flow_shares(&tree, &err), &err);
    tree.flow_share[5] = 0.75;
    tree.flow_share[3] = 0.125; /* leaks on the way to 6 and 7 */
    tree.flow_share[6] = 0.5;
    tree.flow_share[7] = 1.125;
    tree.flow_share[9] = 1.5;
    TreeMeta params = {SAYS(Q_PERF, 24)};
    const double flow[] = {none, 15, 15, 10.5, 0, 4.5, 3, 6.75, none, 9};
    assert_field(&tree, &params, "flow", "ml/min", flow);
    memset(tree.flow_share, 0, tree.n * sizeof *tree.flow_share);
    const double stagnant[] = {none, 0, 0, 0, 0, 0, 0, 0, none, 0};
    assert_field(&tree, &params, "flow", "ml/min", stagnant);
    tree_release(&tree);
}

/* 0 -> 1 -> { 2, 3 } of 55, 15 and 4.25 micrometres: every vessel has a viscosity of its own. */
static void pressures_follow_the_law_of_pries_vessel_by_vessel(void **state)
{
    (void)state;
    const int32_t parent[] = {-1, 0, 1, 1};
    const double radius[] = {0.055, 0.055, 0.015, 0.00425};
    Tree tree = make_tree(4, parent, radius);
    Err err;
    must(tree_add_flow_shares(&tree, &err), &err);
    tree.flow_share[2] = 0.75;
    tree.flow_share[3] = 0.0625;
    tree.meta =
        (TreeMeta){SAYS(Q_PERF, 0.00325), SAYS(P_PERF, 88.5), SAYS(VISCOSITY_LAW, VISCOSITY_PRIES),
                   SAYS(HEMATOCRIT, 0.45), SAYS(PLASMA_VISCOSITY, 1.25)};
    const double share[] = {0, 1, 0.75 / 0.8125, 0.0625 / 0.8125};
    double pressure[] = {none, 0, 0, 0}, wss[] = {none, 0, 0, 0}, above = 88.5;
    for (int i = 1; i < 4; i++) {
        double viscosity = viscosity_pries_pa_s(radius[i], 0.45, 1.25e-3);
        double flow = share[i] * 0.00325 * 1000 / 60, r = radius[i];
        double length = tree_segment_length(&tree, (size_t)i);
        wss[i] = 4 * viscosity * flow / (acos(-1) * r * r * r);
        pressure[i] = above - wss[i] * 2 * length / r / 133.322387415;
        above = pressure[1];
    }
    assert_field(&tree, &no_options, "wss", "Pa", wss);
    Field field;
    must(derive_field(&tree, &no_options, "pressure", &field, &err), &err);
    for (int i = 1; i < 4; i++)
        assert_true(fabs(field.value[i] - pressure[i]) < 1e-12 * fabs(88.5 - pressure[i]));
    field_release(&field);

    TreeSummary summary;
    must(derive_summary(&tree, &no_options, &summary, &err), &err);
    assert_true(summary.has.terminal_pressure);
    tree.radius_mm[3] = 0.0005; /* closed */
    must(derive_summary(&tree, &no_options, &summary, &err), &err);
    assert_false(summary.has.terminal_pressure);
    tree.meta.known[META_HEMATOCRIT] = false;
    must(derive_summary(&tree, &no_options, &summary, &err), &err);
    assert_false(summary.has.terminal_pressure);
    tree_release(&tree);
}

static void a_viscosity_given_alone_means_a_constant_one(void **state)
{
    (void)state;
    Tree tree = read_tree("tests/data/bifurcation.swc");
    meta_set_number(&tree.meta, META_VISCOSITY_LAW, VISCOSITY_PRIES);
    TreeMeta params = {SAYS(VISCOSITY, 3.45)};
    const double wss[] = {none, 1.146757918267365, 1.7159827102602663, 0.8865944950177453};
    assert_field(&tree, &params, "wss", "Pa", wss);

    meta_set_number(&params, META_VISCOSITY_LAW, VISCOSITY_PRIES);
    meta_set_number(&params, META_PLASMA_VISCOSITY, 1.25);
    Field field;
    Err err;
    assert_int_equal(derive_field(&tree, &params, "wss", &field, &err), STATUS_INPUT);
    assert_string_equal(
        err.text, "the field wss needs the hematocrit, which is not stored in this tree; give "
                  "`hematocrit` or the header key hematocrit");
    params.known[META_PLASMA_VISCOSITY] = false;
    assert_int_equal(derive_field(&tree, &params, "wss", &field, &err), STATUS_INPUT);
    assert_string_equal(
        err.text, "the field wss needs the viscosity of the plasma, which is not stored in "
                  "this tree; give `plasma_viscosity_cP` or the header key plasma_viscosity_cP");
    tree_release(&tree);
}

static void the_summary_of_a_bifurcation(void **state)
{
    (void)state;
    Tree tree = read_tree("tests/data/bifurcation.swc");
    TreeSummary summary;
    Err err;
    must(derive_summary(&tree, &no_options, &summary, &err), &err);
    assert_int_equal(summary.nodes, 4);
    assert_int_equal(summary.roots, 1);
    assert_int_equal(summary.segments, 3);
    assert_int_equal(summary.terminals, 2);
    assert_int_equal(summary.bifurcations, 1);
    assert_close(summary.total_length_mm, 49.398097452097645);
    assert_close(summary.volume_mm3, 655.8768346619131);
    assert_true(summary.has.target && summary.has.lambda && summary.lambda == 2);
    assert_close(summary.target, 208.77208059181845);
    assert_true(summary.gamma.n == 1 && summary.gamma.value[0] == 2.7);
    assert_true(summary.root_radius_mm == 2.385);
    assert_true(summary.min_radius_mm == 1.655);
    assert_int_equal(summary.max_level, 1);
    assert_int_equal(summary.max_strahler, 2);
    assert_true(summary.bounds.low.y == -31.125 - 1.655);
    assert_true(summary.bounds.high.z == 2.385);
    assert_true(summary.has.terminal_pressure);
    assert_close(summary.terminal_pressure_min_mmhg, 96.90108418011108);
    assert_close(summary.terminal_pressure_mean_mmhg, 96.99102510497525);
    assert_close(summary.terminal_pressure_max_mmhg, 97.0809660298394);

    TreeMeta params = {SAYS(LAMBDA, 0.7)};
    must(derive_summary(&tree, &params, &summary, &err), &err);
    assert_true(summary.lambda == 0.7);
    assert_close(summary.target, 80.96151134235501);
    tree_release(&tree);
}

static void the_summary_of_a_measured_tree_says_what_it_cannot_know(void **state)
{
    (void)state;
    Tree tree = read_tree("tests/data/trifurcation.swc");
    TreeSummary summary;
    Err err;
    must(derive_summary(&tree, &no_options, &summary, &err), &err);
    assert_int_equal(summary.roots, 2);
    assert_int_equal(summary.segments, 8);
    assert_int_equal(summary.terminals, 5);
    assert_int_equal(summary.bifurcations, 2);
    assert_int_equal(summary.max_level, 2);
    assert_int_equal(summary.max_strahler, 2);
    assert_true(summary.root_radius_mm == 1.875);
    assert_true(summary.min_radius_mm == 0.5375);
    assert_false(summary.has.target || summary.gamma.n > 0 || summary.has.lambda ||
                 summary.has.terminal_pressure);
    tree_release(&tree);
}

static void a_lone_root_has_a_summary(void **state)
{
    (void)state;
    const int32_t parent[] = {-1};
    const double radius[] = {1.375};
    Tree tree = make_tree(1, parent, radius);
    tree.meta = (TreeMeta){SAYS(Q_PERF, 32.5), SAYS(P_PERF, 88.5), SAYS(VISCOSITY, 3.6)};
    TreeSummary summary;
    Err err;
    must(derive_summary(&tree, &no_options, &summary, &err), &err);
    assert_int_equal(summary.segments + summary.terminals + summary.bifurcations, 0);
    assert_true(summary.root_radius_mm == 1.375 && isnan(summary.min_radius_mm));
    assert_int_equal(summary.max_level + summary.max_strahler, 0);
    assert_false(summary.has.terminal_pressure);
    static const char *const names[] = {"radius",   "flow",   "pressure",
                                        "strahler", "branch", "diameter-strahler"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        Field field;
        must(derive_field(&tree, &no_options, names[i], &field, &err), &err);
        assert_true(isnan(field.value[0]));
        field_release(&field);
    }
    tree_release(&tree);
}

/* Odd nodes are the spine; the even node after each is a twig at the same place. */
static void a_spine_of_half_a_million_bifurcations_needs_no_stack(void **state)
{
    (void)state;
    enum { N = 1000002 };
    Err err;
    Tree tree;
    must(tree_init(&tree, N, &err), &err);
    for (int32_t i = 0; i < N; i++) {
        bool twig = i % 2 == 0;
        tree.id[i] = i + 1;
        tree.parent[i] = i < 2 ? i - 1 : twig ? i - 1 : i - 2;
        tree.position[i] = vec3(0.125 * i, twig, 0);
        tree.radius_mm[i] = twig ? 0.375 : 2.385;
    }
    TreeSummary summary;
    must(tree_check(&tree, &err), &err);
    must(derive_summary(&tree, &no_options, &summary, &err), &err);
    assert_int_equal(summary.segments, N - 1);
    assert_int_equal(summary.terminals, 500001);
    assert_int_equal(summary.bifurcations, 500000);
    assert_int_equal(summary.max_level, 500000);
    assert_int_equal(summary.max_strahler, 2);
    Field branch;
    must(derive_field(&tree, &no_options, "branch", &branch, &err), &err);
    assert_true(branch.value[N - 1] == 1);
    assert_true(branch.value[N - 2] == 500001);
    field_release(&branch);
    tree_release(&tree);
}

/* The pieces of a tree's segments: three per segment, of 1/5, 1/5 and 3/5 of its length, with the
 * radii 1.2, 0.9 and 1 times that of the segment. Roots have one piece. */
static Tree divide(const Tree *tree, uint32_t *segment)
{
    static const double part[] = {0.2, 0.4, 1}, ratio[] = {1.2, 0.9, 1};
    size_t last[16] = {0}, n = 0;
    Tree pieces;
    assert_int_equal(tree_init(&pieces, 3 * tree->n, NULL), STATUS_OK);
    for (size_t i = 0; i < tree->n; i++) {
        const bool is_root = !tree_is_segment(tree, i);
        for (int k = is_root ? 2 : 0; k < 3; k++, n++) {
            const Vec3 start = tree->position[is_root ? i : (size_t)tree->parent[i]];
            pieces.parent[n] = is_root  ? TREE_NO_PARENT
                               : k == 0 ? (int32_t)last[tree->parent[i]]
                                        : (int32_t)n - 1;
            pieces.position[n] =
                vec3_add_scaled(start, vec3_sub(tree->position[i], start), part[k]);
            pieces.radius_mm[n] = tree->radius_mm[i] * ratio[k];
            segment[n] = (uint32_t)i;
        }
        last[i] = n - 1;
    }
    pieces.n = n;
    return pieces;
}

/* Checks a field of the first two pieces of each segment against `first` and `second` times the
 * value of the segment, and the last piece against the segment. */
static void assert_along(const DividedTree *divided, const TreeMeta *said, const char *name,
                         double first, double second)
{
    FieldSeries whole, pieces;
    Err err;
    must(derive_series(divided->tree, said, name, &whole, &err), &err);
    must(derive_pieces(divided, said, &whole, &pieces, &err), &err);
    assert_int_equal(pieces.field.n, divided->pieces->n);
    assert_string_equal(pieces.field.name, name);
    assert_string_equal(pieces.field.unit, whole.field.unit);
    for (size_t i = 0, k = 0; i < divided->tree->n; i++) {
        const double value = whole.field.value[i];
        if (tree_is_segment(divided->tree, i)) {
            assert_close(pieces.field.value[k++], first * value);
            assert_close(pieces.field.value[k++], second * value);
            assert_true(pieces.field.value[k++] == value);
        } else {
            assert_true(isnan(pieces.field.value[k++]));
        }
    }
    fieldseries_release(&whole);
    fieldseries_release(&pieces);
}

/* The flow is the same all along a segment; the radius is not. */
static void fields_follow_the_radius_along_a_segment(void **state)
{
    (void)state;
    uint32_t segment[16];
    Tree tree = read_tree("tests/data/bifurcation.swc"), pieces = divide(&tree, segment);
    const DividedTree divided = {&tree, &pieces, segment};
    assert_along(&divided, &no_options, "radius", 1.2, 0.9);
    assert_along(&divided, &no_options, "velocity", 1 / 1.44, 1 / 0.81);
    assert_along(&divided, &no_options, "wss", 1 / 1.728, 1 / 0.729);
    assert_along(&divided, &no_options, "reynolds", 1 / 1.2, 1 / 0.9);
    assert_along(&divided, &no_options, "flow", 1, 1);
    assert_along(&divided, &no_options, "length", 1, 1);
    assert_along(&divided, &no_options, "strahler", 1, 1);
    tree_release(&tree);
    tree_release(&pieces);
}

/* By the law of Pries the viscosity changes with the radius, too. */
static void viscosity_follows_the_radius_along_a_segment(void **state)
{
    (void)state;
    static const int32_t parent[] = {-1, 0};
    static const double radius[] = {0.005, 0.005};
    const TreeMeta said = {SAYS(Q_PERF, 1e-6), SAYS(VISCOSITY_LAW, VISCOSITY_PRIES),
                           SAYS(PLASMA_VISCOSITY, 1.2), SAYS(HEMATOCRIT, 0.45)};
    uint32_t segment[8];
    Tree tree = make_tree(2, parent, radius), pieces = divide(&tree, segment);
    const DividedTree divided = {&tree, &pieces, segment};
    const double own = viscosity_pries_pa_s(0.005, 0.45, 1.2e-3);
    const double ratio[] = {viscosity_pries_pa_s(0.006, 0.45, 1.2e-3) / own,
                            viscosity_pries_pa_s(0.0045, 0.45, 1.2e-3) / own};
    assert_true(ratio[0] < 0.9 && ratio[1] > 1.1);
    assert_along(&divided, &said, "wss", ratio[0] / 1.728, ratio[1] / 0.729);
    assert_along(&divided, &said, "reynolds", 1 / (1.2 * ratio[0]), 1 / (0.9 * ratio[1]));
    tree_release(&tree);
    tree_release(&pieces);
}

/* The first segment begins at the perfusion pressure, 97.3 mmHg. */
static void pressure_falls_linearly_along_a_segment(void **state)
{
    (void)state;
    uint32_t segment[16];
    Tree tree = read_tree("tests/data/bifurcation.swc"), pieces = divide(&tree, segment);
    const DividedTree divided = {&tree, &pieces, segment};
    FieldSeries whole, along;
    Err err;
    must(derive_series(&tree, &no_options, "pressure", &whole, &err), &err);
    must(derive_pieces(&divided, &no_options, &whole, &along, &err), &err);
    const double *at = whole.field.value, *piece = along.field.value;
    assert_close(piece[1], 97.3 + 0.2 * (at[1] - 97.3));
    assert_close(piece[2], 97.3 + 0.4 * (at[1] - 97.3));
    assert_true(piece[3] == at[1]);
    assert_close(piece[4], at[1] + 0.2 * (at[2] - at[1]));
    assert_close(piece[8], at[1] + 0.4 * (at[3] - at[1]));
    fieldseries_release(&whole);
    fieldseries_release(&along);
    tree_release(&tree);
    tree_release(&pieces);
}

/* A column holds values of segments, also if it has the name of a field. */
static void columns_are_constant_along_a_segment(void **state)
{
    (void)state;
    uint32_t segment[16];
    Tree tree = read_tree("tests/data/bifurcation.swc"), pieces = divide(&tree, segment);
    const DividedTree divided = {&tree, &pieces, segment};
    double *value;
    assert_int_equal(tree_add_column(&tree, "wss", "Pa", &value, NULL), STATUS_OK);
    for (size_t i = 0; i < tree.n; i++)
        value[i] = 3 + (double)i;
    assert_along(&divided, &no_options, "wss", 1, 1);
    tree_release(&tree);
    tree_release(&pieces);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fields_of_a_bifurcation_are_what_a_calculator_says),
        cmocka_unit_test(options_override_the_header),
        cmocka_unit_test(orders_of_a_trifurcation_and_a_second_root),
        cmocka_unit_test(two_of_three_daughters_of_the_largest_order_raise_it),
        cmocka_unit_test(the_first_of_equally_thick_daughters_continues_the_branch),
        cmocka_unit_test(what_a_radius_of_zero_leaves_undefined_is_nan),
        cmocka_unit_test(a_step_of_length_zero_drops_no_pressure),
        cmocka_unit_test(missing_data_are_asked_for_by_option),
        cmocka_unit_test(an_unknown_field_is_answered_with_the_known_ones),
        cmocka_unit_test(flow_goes_by_the_shares_of_the_nodes),
        cmocka_unit_test(pressures_follow_the_law_of_pries_vessel_by_vessel),
        cmocka_unit_test(a_viscosity_given_alone_means_a_constant_one),
        cmocka_unit_test(the_summary_of_a_bifurcation),
        cmocka_unit_test(the_summary_of_a_measured_tree_says_what_it_cannot_know),
        cmocka_unit_test(a_lone_root_has_a_summary),
        cmocka_unit_test(a_spine_of_half_a_million_bifurcations_needs_no_stack),
        cmocka_unit_test(fields_follow_the_radius_along_a_segment),
        cmocka_unit_test(viscosity_follows_the_radius_along_a_segment),
        cmocka_unit_test(pressure_falls_linearly_along_a_segment),
        cmocka_unit_test(columns_are_constant_along_a_segment),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
