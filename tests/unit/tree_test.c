#include "tree/tree.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void must(Status status, const Err *err)
{
    if (status != STATUS_OK)
        fail_msg("%s", err->text);
}

/* 12 -> 7 -> { 30, 9 -> 41 }, and a root 5 of its own. */
static Tree small_tree(void)
{
    static const int32_t id[] = {12, 7, 30, 9, 41, 5};
    static const int32_t parent[] = {TREE_NO_PARENT, 0, 1, 1, 3, TREE_NO_PARENT};
    static const Vec3 position[] = {{0.5, 1.25, -2},  {3.5, 5.25, -2},  {9.5, 4.75, 1.5},
                                    {2.5, 11.5, 0.5}, {1.5, 14.25, -1}, {-20.5, 3.5, 7.75}};
    static const double radius[] = {2.385, 2.385, 1.655, 2.0625, 0.0875, 0.625};
    Tree tree;
    Err err;
    must(tree_init(&tree, 6, &err), &err);
    memcpy(tree.id, id, sizeof id);
    memcpy(tree.parent, parent, sizeof parent);
    memcpy(tree.position, position, sizeof position);
    memcpy(tree.radius_mm, radius, sizeof radius);
    return tree;
}

static void a_new_tree_is_all_roots_at_the_origin(void **state)
{
    (void)state;
    Tree tree;
    Err err;
    must(tree_init(&tree, 3, &err), &err);
    assert_int_equal(tree.n, 3);
    for (size_t i = 0; i < tree.n; i++) {
        assert_false(tree_is_segment(&tree, i));
        assert_true(tree.radius_mm[i] == 0 && vec3_length(tree.position[i]) == 0);
    }
    tree_release(&tree);
    assert_null(tree.id);
    tree_release(&tree);
}

static void more_nodes_than_ids_are_refused(void **state)
{
    (void)state;
    Tree tree = {.n = 77};
    Err err;
    assert_int_equal(tree_init(&tree, TREE_MAX_ID + (size_t)1, &err), STATUS_INFEASIBLE);
    assert_non_null(strstr(err.text, "16777216"));
    assert_int_equal(tree.n, 77);
}

static void a_segment_is_as_long_as_its_ends_are_apart(void **state)
{
    (void)state;
    Tree tree = small_tree();
    assert_true(tree_segment_length(&tree, 0) == 0);
    assert_true(tree_segment_length(&tree, 1) == 5);
    assert_true(tree_segment_length(&tree, 5) == 0);
    tree_release(&tree);
}

static void children_are_counted(void **state)
{
    (void)state;
    static const int32_t expected[] = {1, 2, 0, 1, 0, 0};
    Tree tree = small_tree();
    int32_t *count = NULL;
    Err err;
    must(tree_child_counts(&tree, &count, &err), &err);
    assert_memory_equal(count, expected, sizeof expected);
    free(count);
    tree_release(&tree);
}

static void check_names_the_node_at_fault(void **state)
{
    (void)state;
    Err err;
    Tree tree = small_tree();
    must(tree_check(&tree, &err), &err);

    tree.radius_mm[3] = -0.125;
    assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
    assert_string_equal(err.text, "node 9: radius -0.125; it must be finite and not negative");
    tree.radius_mm[3] = (double)NAN;
    assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
    tree.radius_mm[3] = 2.0625;

    tree.position[4].z = HUGE_VAL;
    assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
    assert_string_equal(err.text, "node 41: the position is not finite");
    tree.position[4].z = -1;

    tree.parent[2] = 3;
    assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
    assert_string_equal(err.text, "node 30: its parent does not come before it");
    tree.parent[2] = 1;

    tree.id[5] = 30;
    assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
    assert_string_equal(err.text, "node 30: another node has the same id");
    tree.id[5] = 0;
    assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
    tree.id[5] = TREE_MAX_ID + 1;
    assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
    tree.id[5] = TREE_MAX_ID;
    must(tree_check(&tree, &err), &err);
    tree_release(&tree);

    assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
}

static void pruning_drops_thin_segments_and_what_hangs_on_them(void **state)
{
    (void)state;
    Err err;
    Tree tree = small_tree();
    tree.header.has.gamma = true;
    tree.header.gamma = 2.7;
    must(tree_add_line(&tree, "domain: disc:50", &err), &err);
    tree.radius_mm[4] = 3.5; /* thick, behind a thin one */

    Tree pruned;
    must(tree_pruned(&tree, 2.125, &pruned, &err), &err);
    static const int32_t id[] = {12, 7, 5};
    static const int32_t parent[] = {TREE_NO_PARENT, 0, TREE_NO_PARENT};
    assert_int_equal(pruned.n, 3);
    assert_memory_equal(pruned.id, id, sizeof id);
    assert_memory_equal(pruned.parent, parent, sizeof parent);
    assert_true(pruned.position[1].y == 5.25);
    assert_true(pruned.header.has.gamma && pruned.header.gamma == 2.7);
    assert_int_equal(pruned.header.n_lines, 1);
    assert_string_equal(pruned.header.lines[0], "domain: disc:50");
    must(tree_check(&pruned, &err), &err);
    tree_release(&pruned);

    must(tree_pruned(&tree, 0, &pruned, &err), &err);
    assert_int_equal(pruned.n, tree.n);
    tree_release(&pruned);

    must(tree_pruned(&tree, 2.0625, &pruned, &err), &err); /* not thinner than itself */
    assert_int_equal(pruned.n, 5);
    tree_release(&pruned);
    tree_release(&tree);
}

static void pruning_leaves_the_flow_of_what_stays(void **state)
{
    (void)state;
    Err err;
    Tree tree = small_tree(), pruned;
    tree.header.has.terminal_flow = true; /* equal: 30 and 41 are the terminals */
    must(tree_pruned(&tree, 0, &pruned, &err), &err);
    assert_null(pruned.flow_share);
    assert_true(pruned.header.has.terminal_flow);
    tree_release(&pruned);

    must(tree_pruned(&tree, 1.75, &pruned, &err), &err); /* 12 -> 7 -> 9, and 5 */
    static const double counted[] = {0, 1, 1, 0};
    assert_int_equal(pruned.n, 4);
    assert_memory_equal(pruned.flow_share, counted, sizeof counted);
    assert_false(pruned.header.has.terminal_flow);
    tree_release(&pruned);

    must(tree_add_flow_shares(&tree, &err), &err);
    tree.flow_share[2] = 0.375;
    tree.flow_share[3] = 0.125; /* leaks */
    tree.flow_share[4] = 2.25;
    must(tree_pruned(&tree, 2.125, &pruned, &err), &err); /* 12 -> 7, and 5 */
    static const double summed[] = {0, 2.75, 0};
    assert_int_equal(pruned.n, 3);
    assert_memory_equal(pruned.flow_share, summed, sizeof summed);
    assert_true(pruned.header.has.terminal_flow);
    must(tree_check(&pruned, &err), &err);
    tree_release(&pruned);

    tree.flow_share[4] = -2.25;
    assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
    assert_string_equal(err.text, "node 41: flow share -2.25; it must be finite and not negative");
    tree_release(&tree);
}

static void renumbering_counts_from_one(void **state)
{
    (void)state;
    static const int32_t expected[] = {1, 2, 3, 4, 5, 6};
    Tree tree = small_tree();
    tree_renumber(&tree);
    assert_memory_equal(tree.id, expected, sizeof expected);
    tree_release(&tree);
}

static void the_bounds_hold_both_ends_with_the_segment_radius(void **state)
{
    (void)state;
    Tree tree = small_tree();
    tree.radius_mm[0] = 0.25;
    Box box = tree_bounds(&tree);
    assert_true(box.low.x == -20.5 - 0.625);
    assert_true(box.low.y == 1.25 - 2.385);
    assert_true(box.low.z == -2 - 2.385);
    assert_true(box.high.x == 9.5 + 1.655);
    assert_true(box.high.y == 14.25 + 0.0875);
    assert_true(box.high.z == 7.75 + 0.625);
    tree_release(&tree);
}

static void a_header_line_holds_no_line_end(void **state)
{
    (void)state;
    Err err;
    Tree tree = small_tree();
    char line[] = "remark: 3";
    must(tree_add_line(&tree, line, &err), &err);
    line[0] = 'R';
    assert_string_equal(tree.header.lines[0], "remark: 3");
    assert_int_equal(tree_add_line(&tree, "domain: mesh:a\nb.stl", &err), STATUS_INPUT);
    assert_int_equal(tree_add_line(&tree, "a\rb", &err), STATUS_INPUT);
    assert_int_equal(tree.header.n_lines, 1);
    tree_release(&tree);
}

static void a_chain_of_a_million_segments_is_no_deeper_than_a_bush(void **state)
{
    (void)state;
    enum { N = 1000001 };
    Err err;
    Tree tree, pruned;
    must(tree_init(&tree, N, &err), &err);
    for (int32_t i = 0; i < N; i++) {
        tree.id[i] = i + 1;
        tree.parent[i] = i - 1;
        tree.position[i] = vec3(0.125 * i, 0, 0);
        tree.radius_mm[i] = 2.385 - 1e-6 * i;
    }
    must(tree_check(&tree, &err), &err);
    assert_true(tree_bounds(&tree).low.x < 0);
    must(tree_pruned(&tree, 1.885, &pruned, &err), &err);
    assert_in_range(pruned.n, 499999, 500002);
    tree_release(&pruned);
    tree_release(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_new_tree_is_all_roots_at_the_origin),
        cmocka_unit_test(more_nodes_than_ids_are_refused),
        cmocka_unit_test(a_segment_is_as_long_as_its_ends_are_apart),
        cmocka_unit_test(children_are_counted),
        cmocka_unit_test(check_names_the_node_at_fault),
        cmocka_unit_test(pruning_drops_thin_segments_and_what_hangs_on_them),
        cmocka_unit_test(pruning_leaves_the_flow_of_what_stays),
        cmocka_unit_test(renumbering_counts_from_one),
        cmocka_unit_test(the_bounds_hold_both_ends_with_the_segment_radius),
        cmocka_unit_test(a_header_line_holds_no_line_end),
        cmocka_unit_test(a_chain_of_a_million_segments_is_no_deeper_than_a_bush),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
