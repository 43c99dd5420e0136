/* How points and lines become a tree: merging, cutting, roots, directions. */
#include "tree/tree.h"
#include "unit.h"

#include <stdlib.h>
#include <string.h>

#define NONE ((double)NAN)

/* Points and lines as tests write them; records are 100 + number and 200 + number. */
typedef struct Net {
    Graph graph;
    TreeReading reading;
    ReadOptions options;
    Err err;
} Net;

static void put_point(Net *net, double x, double y, double z, double radius)
{
    const GraphPoint point = {
        .position = {x, y, z}, .radius = radius, .record = 100 + net->graph.n_points};
    must(graph_point(&net->graph, &point, &net->err), &net->err);
}

static void put_line(Net *net, size_t a, size_t b, double radius)
{
    const GraphLine line = {.a = a, .b = b, .radius = radius, .record = 200 + net->graph.n_lines};
    must(graph_line(&net->graph, &line, &net->err), &net->err);
}

static Status build(Net *net, Tree *tree)
{
    TreeBuilder builder = {.name = "net"};
    net->graph.name = "net";
    net->graph.options = &net->options;
    net->graph.reading = &net->reading;
    Status status = graph_build(&net->graph, &builder, &net->err);
    if (status == STATUS_OK)
        status = builder_build(&builder, tree, &net->err);
    if (status == STATUS_OK)
        status = reading_measure(&net->reading, tree, &net->err);
    builder_release(&builder);
    graph_release(&net->graph);
    return status;
}

static void release(Net *net, Tree *tree)
{
    tree_release(tree);
    reading_release(&net->reading);
}

/* The tree as "ID<PARENT:RADIUS ...". */
static void assert_tree(const Tree *tree, const char *expected)
{
    char text[400] = "", *at = text;
    for (size_t i = 0; i < tree->n; i++) {
        int parent = tree_is_segment(tree, i) ? tree->id[tree->parent[i]] : -1;
        at += snprintf(at, sizeof text - (size_t)(at - text), "%s%d<%d:%g", i ? " " : "",
                       tree->id[i], parent, tree->radius_mm[i]);
    }
    assert_string_equal(text, expected);
}

static void refused(Net *net, const char *sentence)
{
    Tree tree = {0};
    assert_int_equal(build(net, &tree), STATUS_INPUT);
    assert_string_equal(net->err.text, sentence);
    release(net, &tree);
}

static void directs_lines_away_from_the_thickest_end(void **state)
{
    (void)state;
    Net net = {0};
    Tree tree;
    put_point(&net, 0, 0, 0, 0.7);
    put_point(&net, 2.5, 0, 0, 1.3);
    put_point(&net, 4, 1, 0, 2.385);
    put_point(&net, 4, -1.5, 0, 0.9);
    put_line(&net, 0, 1, NONE);
    put_line(&net, 1, 3, NONE);
    put_line(&net, 2, 1, NONE);
    must(build(&net, &tree), &net.err);
    assert_tree(&tree, "3<-1:1.3 2<3:1.3 1<2:0.7 4<2:0.9");
    assert_int_equal(net.reading.n_roots, 1);
    assert_int_equal(net.reading.root[0].id, 3);
    assert_int_equal(net.reading.root[0].reason, ROOT_THICKEST);
    assert_int_equal(net.reading.root[0].nodes, 4);
    assert_int_equal(net.reading.degree[1], 3);
    assert_int_equal(net.reading.degree[3], 1);
    release(&net, &tree);
}

static void a_line_has_its_own_radius_before_its_points(void **state)
{
    (void)state;
    Net net = {0};
    Tree tree;
    put_point(&net, 0, 0, 0, 5);
    put_point(&net, 2.5, 0, 0, 4);
    put_point(&net, 6, 1, 0, 3);
    put_line(&net, 0, 1, 1.75);
    put_line(&net, 1, 2, NONE);
    must(build(&net, &tree), &net.err);
    assert_tree(&tree, "3<-1:4 2<3:4 1<2:1.75");
    release(&net, &tree);
}

static void the_file_says_the_root_by_an_inlet_or_else_by_directions(void **state)
{
    (void)state;
    for (int inlet = 0; inlet < 2; inlet++) {
        Net net = {0};
        Tree tree;
        for (int i = 0; i < 4; i++)
            put_point(&net, i, 0.5 * i * i, 0, 3 - 0.5 * i);
        for (size_t i = 0; i < 3; i++) {
            const GraphLine line = {.a = i + 1, .b = i, .radius = NONE, .is_directed = true};
            must(graph_line(&net.graph, &line, &net.err), &net.err);
        }
        net.graph.point[1].is_inlet = inlet;
        must(build(&net, &tree), &net.err);
        assert_int_equal(net.reading.root[0].id, inlet ? 2 : 4);
        assert_int_equal(net.reading.root[0].reason, inlet ? ROOT_STATED : ROOT_DIRECTION);
        assert_int_equal(net.reading.network.against, inlet ? 2 : 0);
        release(&net, &tree);
    }
}

static void an_inlet_among_merged_points_is_one_and_others_are_told(void **state)
{
    (void)state;
    Net net = {0};
    Tree tree;
    for (int i = 0; i < 6; i++)
        put_point(&net, (i + 1) / 2, 0.25, 0, 1 + 0.125 * i);
    for (size_t i = 0; i < 6; i += 2)
        put_line(&net, i, i + 1, NONE);
    net.graph.point[2].is_inlet = net.graph.point[0].is_inlet = true;
    must(build(&net, &tree), &net.err);
    assert_int_equal(net.reading.root[0].id, 2);
    assert_int_equal(net.reading.root[0].reason, ROOT_STATED);
    assert_string_equal(
        net.reading.note[0],
        "inlets stated in the file that are not roots: 1 (each tree has one root, the "
        "thickest of its inlets)");
    release(&net, &tree);
}

static void merges_points_at_one_place_and_drops_what_is_not_needed(void **state)
{
    (void)state;
    Net net = {0};
    Tree tree;
    put_point(&net, 9, 9, 9, 1); /* unused */
    put_point(&net, 0, 0, 0, 2);
    put_point(&net, 1.5, 0.0, 0, 1.5);
    put_point(&net, 1.5, -0.0, 0, 1.25); /* as the one before */
    put_point(&net, 3.5, 1, 0, 0.75);
    put_point(&net, 1.5, 0, 1e-4, 1.125); /* nearly so */
    put_point(&net, 3.5, -1, 0, 0.5);
    put_line(&net, 1, 2, NONE);
    put_line(&net, 3, 4, NONE);
    put_line(&net, 5, 6, NONE);
    put_line(&net, 2, 3, NONE); /* without length */
    put_line(&net, 2, 1, NONE); /* again */
    net.options.merge_tolerance_mm = 2e-4;
    must(build(&net, &tree), &net.err);
    assert_tree(&tree, "2<-1:1.5 3<2:1.5 5<3:0.75 7<3:0.5");
    assert_int_equal(net.reading.network.merged, 2);
    assert_int_equal(net.reading.network.unused, 1);
    assert_int_equal(net.reading.network.without_length, 1);
    assert_int_equal(net.reading.network.repeated, 1);
    release(&net, &tree);
}

static void what_is_not_connected_is_a_forest(void **state)
{
    (void)state;
    Net net = {0};
    Tree tree;
    put_point(&net, 0, 0, 0, 0.4);
    put_point(&net, 1, 0, 0, 0.3);
    put_point(&net, 0, 7, 0, 0.2);
    put_point(&net, 1, 7, 0, 0.6);
    put_line(&net, 2, 3, 0.25);
    put_line(&net, 0, 1, 0.35);
    must(build(&net, &tree), &net.err);
    assert_tree(&tree, "1<-1:0.35 2<1:0.35 3<-1:0.25 4<3:0.25");
    assert_int_equal(net.reading.n_roots, 2);
    release(&net, &tree);
}

/* A square 1 2 3 4 whose thinnest side is 3 - 4, with a tail 0 - 1. */
static void put_square(Net *net)
{
    static const double radius[] = {0.9, 0.8, 0.7, 0.2, 0.6};
    put_point(net, -1, 0, 0, NONE);
    for (int i = 0; i < 4; i++)
        put_point(net, (i == 1 || i == 2) * 1.5, (i > 1) * 2.5, 0, NONE);
    for (size_t i = 0; i < 4; i++)
        put_line(net, i, i + 1, radius[i]);
    put_line(net, 4, 1, radius[4]);
}

static void keeps_loops_by_links_at_the_ends_of_vessels(void **state)
{
    (void)state;
    Net net = {0};
    Tree tree;
    put_square(&net);
    must(build(&net, &tree), &net.err);
    must(tree_check(&tree, &net.err), &net.err);
    assert_tree(&tree, "1<-1:0.9 2<1:0.9 3<2:0.8 4<3:0.7 5<4:0.2 6<5:0.6");
    assert_int_equal(tree.link[5], 1);
    assert_int_equal(net.reading.network.links, 1);
    assert_int_equal(net.reading.network.loops, 0);
    release(&net, &tree);
}

static void a_loop_of_parents_is_refused(void **state)
{
    (void)state;
    Net net = {.graph.is_tree = true};
    put_square(&net);
    refused(&net, "net:204: the line closes a loop at 0, 2.5, 0 mm (loops in the network: 1); "
                  "use `break_loops` to cut each loop at its thinnest segment");
}

static void cuts_a_loop_at_its_thinnest_line(void **state)
{
    (void)state;
    Net net = {.options.break_loops = true};
    Tree tree;
    put_square(&net);
    must(build(&net, &tree), &net.err);
    assert_tree(&tree, "1<-1:0.9 2<1:0.9 3<2:0.8 4<3:0.7 5<2:0.6");
    assert_int_equal(net.reading.network.loops, 1);
    assert_int_equal(net.reading.network.n_cuts, 1);
    assert_int_equal(net.reading.network.cut[0].record, 203);
    assert_float_equal(net.reading.network.cut[0].radius_mm, 0.2, 0);
    assert_float_equal(net.reading.network.cut[0].position.x, 0.75, 0);
    release(&net, &tree);
}

static void joined_points_are_one_wherever_they_lie(void **state)
{
    (void)state;
    Net net = {0};
    Tree tree;
    for (int i = 0; i < 6; i++)
        put_point(&net, i, i % 3, 0.5, 1 - 0.125 * i);
    put_line(&net, 0, 1, NONE);
    put_line(&net, 2, 3, NONE);
    put_line(&net, 4, 5, NONE);
    must(graph_join(&net.graph, 4, 2, &net.err), &net.err);
    must(graph_join(&net.graph, 1, 4, &net.err), &net.err);
    must(build(&net, &tree), &net.err);
    assert_tree(&tree, "1<-1:0.875 2<1:0.875 4<2:0.625 6<2:0.375");
    release(&net, &tree);
}

static void scales_units_and_voxels(void **state)
{
    (void)state;
    Net net = {
        .options = {
            .has_unit = true, .unit = LENGTH_UM, .has_voxel_size = true, .voxel_size = {2, 4, 8}}};
    Tree tree;
    put_point(&net, 10, 20, 30, 6.5);
    put_point(&net, 40, 50, 60, 6.5);
    put_line(&net, 0, 1, NONE);
    must(build(&net, &tree), &net.err);
    assert_float_equal(tree.position[1].x, 0.08, 1e-12);
    assert_float_equal(tree.position[1].y, 0.2, 1e-12);
    assert_float_equal(tree.position[1].z, 0.48, 1e-12);
    assert_float_equal(tree.radius_mm[1], 0.0065, 1e-12);
    release(&net, &tree);
}

static void finds_the_unit_in_which_radii_are_plausible_for_vessels(void **state)
{
    (void)state;
    static const struct {
        double radius;
        LengthUnit plausible;
    } cases[] = {{0.35, LENGTH_MM}, {12.5, LENGTH_UM}, {0.0007, LENGTH_M}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Net net = {0};
        Tree tree;
        put_point(&net, 0.5, 0, 0, cases[i].radius);
        put_point(&net, 1, 0, 0, cases[i].radius);
        put_line(&net, 0, 1, NONE);
        must(build(&net, &tree), &net.err);
        assert_int_equal(net.reading.unit, LENGTH_MM);
        assert_false(net.reading.unit_is_stated);
        assert_true(net.reading.has_plausible_unit);
        assert_int_equal(net.reading.plausible_unit, cases[i].plausible);
        release(&net, &tree);
    }
}

static void values_of_lines_and_of_distal_points_come_along(void **state)
{
    (void)state;
    Net net = {0};
    Tree tree;
    size_t of_points, of_lines, same;
    Err *err = &net.err;
    put_point(&net, 0, 0, 0, 1);
    put_point(&net, 1, 0, 0, 0.5);
    put_point(&net, 1, 0, 0, 0.25);
    put_point(&net, 2, 1, 0, 0.125);
    put_line(&net, 0, 1, NONE);
    put_line(&net, 3, 2, NONE);
    must(graph_column(&net.graph, GRAPH_POINTS, "p", "Pa", &of_points, err), err);
    must(graph_column(&net.graph, GRAPH_LINES, "q", "", &of_lines, err), err);
    must(graph_column(&net.graph, GRAPH_LINES, "p", "", &same, err), err);
    for (size_t i = 4; i-- > 0;)
        must(graph_value(&net.graph, of_points, i, 10.5 + (double)i, err), err);
    must(graph_value(&net.graph, of_lines, 1, 3.25, err), err);
    must(graph_value(&net.graph, same, 0, 7.75, err), err);
    must(build(&net, &tree), err);
    const double *p = tree_column(&tree, "p of points")->value;
    assert_true(p[0] == 10.5 && p[1] == 11.5 && p[2] == 13.5);
    const double *q = tree_column(&tree, "q")->value;
    assert_true(isnan(q[0]) && isnan(q[1]) && q[2] == 3.25);
    assert_true(tree_column(&tree, "p")->value[1] == 7.75);
    assert_string_equal(tree_column(&tree, "p of points")->unit, "Pa");
    release(&net, &tree);
}

static void refuses_what_no_tree_can_be_made_of(void **state)
{
    (void)state;
    Net net = {0};
    put_point(&net, 1, 2, 3, 4);
    refused(&net, "net: the file has no lines; a tree has at least one");
    put_point(&net, 1, 2, 3, 4);
    put_line(&net, 0, 7, NONE);
    refused(&net, "net:200: the line leads to point 7; there are 1 points, numbered from 0 on");
    put_point(&net, 1, 2, 3, 4);
    put_point(&net, 1, 2, 3.5, NONE);
    put_line(&net, 0, 1, NONE);
    refused(&net,
            "net:200: neither the line nor its distal point has a radius; set one with `radius`");
    put_point(&net, 1, 2, 3, 4);
    put_point(&net, 1, 2, 3, 4);
    put_line(&net, 0, 1, NONE);
    refused(&net, "net: each line has both ends at the same position; a tree needs a line that is "
                  "longer than 0");
    const GraphPoint bad = {.position = {0, 0, 0}, .radius = -0.5};
    assert_int_equal(graph_point(&net.graph, &bad, &net.err), STATUS_INPUT);
    assert_string_equal(net.err.text, "the radius is '-0.5'; it must be a finite number of 0 or "
                                      "more (`repair_radii` replaces it, from its neighbors)");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directs_lines_away_from_the_thickest_end),
        cmocka_unit_test(a_line_has_its_own_radius_before_its_points),
        cmocka_unit_test(the_file_says_the_root_by_an_inlet_or_else_by_directions),
        cmocka_unit_test(an_inlet_among_merged_points_is_one_and_others_are_told),
        cmocka_unit_test(merges_points_at_one_place_and_drops_what_is_not_needed),
        cmocka_unit_test(what_is_not_connected_is_a_forest),
        cmocka_unit_test(keeps_loops_by_links_at_the_ends_of_vessels),
        cmocka_unit_test(a_loop_of_parents_is_refused),
        cmocka_unit_test(cuts_a_loop_at_its_thinnest_line),
        cmocka_unit_test(joined_points_are_one_wherever_they_lie),
        cmocka_unit_test(scales_units_and_voxels),
        cmocka_unit_test(finds_the_unit_in_which_radii_are_plausible_for_vessels),
        cmocka_unit_test(values_of_lines_and_of_distal_points_come_along),
        cmocka_unit_test(refuses_what_no_tree_can_be_made_of),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
