/* Values of segments in files of their own. */
#include "derive/derive.h"
#include "treeio/treeio.h"
#include "unit.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[] = "/tmp/corcast-values-XXXXXX";
static char input[64];

static int make_folder(void **state)
{
    (void)state;
    if (!mkdtemp(folder))
        return -1;
    snprintf(input, sizeof input, "%s/in.csv", folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    unlink(input);
    return rmdir(folder);
}

/* A root and four segments: 12 - 7 - 30, 7 - 8, 12 - 5, of which 30, 8 and 5 are terminals. */
static Tree make_tree(void)
{
    static const int32_t id[] = {12, 7, 30, 8, 5}, parent[] = {-1, 0, 1, 1, 0};
    static const double radius[] = {2.385, 2.385, 1.655, 0.75, 0};
    Tree tree;
    Err err;
    must(tree_init(&tree, 5, &err), &err);
    for (size_t i = 0; i < 5; i++) {
        tree.id[i] = id[i];
        tree.parent[i] = parent[i];
        tree.radius_mm[i] = radius[i];
        tree.position[i] = vec3(1.25 * (double)i, 0, 0);
    }
    return tree;
}

static void write_input(const char *text)
{
    Err err;
    must(file_write(input, text, strlen(text), &err), &err);
}

/* Of a tree with the values that `text` holds; `column` as tree_read_values has it. */
static void assert_values(const char *text, const char *column, const char *name,
                          const double *expected, size_t frames)
{
    Tree tree = make_tree();
    FieldSeries series;
    char *called = NULL;
    Err err;
    write_input(text);
    must(tree_read_values(&tree, input, column, &called, &err), &err);
    assert_string_equal(called, name);
    must(derive_series(&tree, &(TreeMeta){0}, called, &series, &err), &err);
    assert_int_equal(series.frames, frames);
    for (size_t k = 0; k < frames; k++)
        for (size_t i = 0; i < 5; i++) {
            double value = series.field.value[k * 5 + i], wanted = expected[k * 5 + i];
            if (isnan(wanted) ? !isnan(value) : value != wanted)
                fail_msg("frame %zu, node %zu is %g, not %g", k, i, value, wanted);
        }
    fieldseries_release(&series);
    free(called);
    tree_release(&tree);
}

static const double none = (double)NAN;

static void a_column_is_joined_by_id(void **state)
{
    (void)state;
    const double expected[] = {none, 3.125, none, -7.5, none};
    assert_values("# by hand\nid,wss [Pa],b\n8,-7.5,1\n7,3.125,2\n30,NA,3\n", "wss", "wss",
                  expected, 1);
}

static void columns_are_frames(void **state)
{
    (void)state;
    const double expected[] = {none, 1.5, none, none, 4, none, 2.5, none, none, 5};
    assert_values("id,0.25,0.5\n7,1.5,2.5\n5,4,5\n", NULL, "in", expected, 2);
    assert_values("id,0.5,0.25\n7,2.5,1.5\n5,5,4\n", "in", "in", expected, 2);
    assert_values("id,systole,diastole\n7,1.5,2.5\n5,4,5\n", NULL, "in", expected, 2);
    assert_values("id,q_TIME_1e-2,q_INCR_00004_TIME_2,q_more\n7,1.5,2.5,0\n5,4,5,0\n", "q", "q",
                  expected, 2);
}

static void rows_of_a_time_are_frames(void **state)
{
    (void)state;
    const double expected[] = {none, 1.5, none, none, 4, none, 2.5, none, none, 5};
    assert_values("name,time,flow_in,flow_out\n7,0.5,2.5,9\n5,0.5,5,9\n7,0.25,1.5,9\n5,0.25,4,9\n",
                  "flow_in", "flow_in", expected, 2);
}

static void a_branch_of_simvascular_is_all_its_segments(void **state)
{
    (void)state;
    Tree tree = make_tree();
    double *branch;
    char *called = NULL;
    Err err;
    must(tree_add_column(&tree, "BranchId", "", &branch, &err), &err);
    memcpy(branch, (const double[]){0, 0, 2, 2, 1}, 5 * sizeof *branch);
    write_input("name,time,flow_in\nbranch2_seg0,0,4.5\nbranch2_seg0,1,5.5\n");
    must(tree_read_values(&tree, input, NULL, &called, &err), &err);
    const TreeColumn *first = tree_column(&tree, "flow_in_0");
    assert_non_null(first);
    assert_true(isnan(first->value[1]) && first->value[2] == 4.5 && first->value[3] == 4.5);
    free(called);
    tree_release(&tree);
}

static void refuses_values_that_do_not_fit(void **state)
{
    (void)state;
    static const struct {
        const char *text, *column, *sentence;
    } cases[] = {
        {"", NULL, ": the file has no values"},
        {"a,b\n1,2\n", NULL,
         ":1: no column is called id or name, which must identify the segments"},
        {"id\n7\n", NULL, ":1: the file has no column of values"},
        {"id,name,a\n7,7,1\n", NULL, ":1: two columns state the segment; only one may"},
        {"id,a,\n7,7,1\n", NULL, ":1: column 3 has no name"},
        {"id,a,a\n7,7,1\n", "a", ":1: two columns are called 'a'"},
        {"id,a\n7,1\n9,1\n", "a", ":3: the tree has no segment with the id 9"},
        {"id,a\n7,1\nx,1\n", "a", ":3: the segment id is 'x'; it must be an integer"},
        {"id,a\n7,1\n\n7,1\n", "a", ":4: segment 7 already has a row, in line 2"},
        {"id,a\n7,1,3\n", "a", ":2: the row has 3 fields; it must have 2, one per column"},
        {"id,a\n7,1e999\n", "a", ":2: the a is '1e999'; it must be a finite number"},
        {"id,a,b\n7,1,2\n", "c", ":1: no column is called 'c'; the columns are a, b"},
        {"id,time,a,b\n7,1,2,3\n", NULL,
         ":1: the file has 2 columns of values; name one, as in FILE.csv:a"},
        {"id,time,a\n7,1,2\n7,2,2\n8,1,2\n", NULL,
         ": segment 8 has no row for time 2, which others have"},
        {"id,time,a\n7,1,2\n7,2,2\n7,1,2\n", NULL,
         ":4: segment 7 at time 1 already has a row, in line 2"},
        {"name,time,a\nbranch0_seg0,1,2\n", NULL,
         ":2: the tree has no segment with the id branch0_seg0"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Tree tree = make_tree();
        char *called = NULL;
        Err err;
        write_input(cases[k].text);
        assert_int_equal(tree_read_values(&tree, input, cases[k].column, &called, &err),
                         STATUS_INPUT);
        assert_memory_equal(err.text, input, strlen(input));
        assert_string_equal(err.text + strlen(input), cases[k].sentence);
        tree_release(&tree);
    }
}

static void names_of_columns_tell_their_time(void **state)
{
    (void)state;
    static const struct {
        const char *column, *name;
        double time;
    } cases[] = {{"pressure_0.5", "pressure", 0.5},
                 {"Pressure_mmHg_INCR_00004_TIME_0.20000", "Pressure_mmHg", 0.2},
                 {"a_b_TIME_-1e-3", "a_b", -1e-3},
                 {"pressure", NULL, 0},
                 {"_3", NULL, 0},
                 {"a_", NULL, 0},
                 {"a_inf", NULL, 0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        size_t length = 0;
        double time = 0;
        bool parsed = series_parse(cases[k].column, &length, &time);
        assert_int_equal(parsed, cases[k].name != NULL);
        if (!parsed)
            continue;
        assert_int_equal(length, strlen(cases[k].name));
        assert_true(time == cases[k].time);
    }
}

static void refuses_two_columns_of_one_time(void **state)
{
    (void)state;
    Tree tree = make_tree();
    double *value;
    Series series;
    Err err;
    must(tree_add_column(&tree, "q_0.5", "Pa", &value, &err), &err);
    must(tree_series(&tree, "q", &series, &err), &err);
    assert_int_equal(series.n, 0); /* one is no series */
    must(tree_add_column(&tree, "q_1", "mmHg", &value, &err), &err);
    assert_int_equal(tree_series(&tree, "q", &series, &err), STATUS_INPUT);
    assert_string_equal(err.text,
                        "the columns 'q_0.5' and 'q_1' have different units, 'Pa' and 'mmHg'");
    must(tree_add_column(&tree, "q_0.50", "Pa", &value, &err), &err);
    assert_int_equal(tree_series(&tree, "q", &series, &err), STATUS_INPUT);
    assert_string_equal(err.text, "the columns 'q_0.5' and 'q_0.50' have the same time");
    tree_release(&tree);
}

/* The flows of segments 7, 30, 8 and 5. */
static void assert_flows(Tree *tree, const double *expected)
{
    Field flow;
    Err err;
    must(derive_field(tree, &(TreeMeta){0}, "flow", &flow, &err), &err);
    for (size_t i = 1; i < 5; i++)
        if (!(fabs(flow.value[i] - expected[i - 1]) <= 1e-12 * expected[i - 1]))
            fail_msg("the flow of node %zu is %.17g, not %.17g", i, flow.value[i], expected[i - 1]);
    field_release(&flow);
}

static void flow_parts_as_is_asked_for(void **state)
{
    (void)state;
    Tree tree = make_tree();
    Err err;
    tree.meta.known[META_Q_PERF] = true;
    tree.meta.number[META_Q_PERF] = 90;
    assert_flows(&tree, (const double[]){60, 30, 30, 30});
    double thick = pow(1.655, 2.5), thin = pow(0.75, 2.5), all = thick + thin;
    must(tree_set_flow_by_radius(&tree, 2.5, &err), &err);
    assert_flows(&tree, (const double[]){90, 90 * thick / all, 90 * thin / all, 0});
    write_input("id,flow [ml/min]\n5,12.5\n8,2.5\n");
    must(tree_read_flows(&tree, input, &err), &err);
    assert_flows(&tree, (const double[]){2.5, 0, 2.5, 12.5});
    tree_set_flow_equal(&tree);
    assert_flows(&tree, (const double[]){10, 5, 5, 5});
    tree_release(&tree);
}

static void refuses_flows_that_make_no_sense(void **state)
{
    (void)state;
    Tree tree = make_tree();
    Err err;
    static const char *const cases[][2] = {
        {"id,flow\n8,-1\n", ": a flow is -1; it must be 0 or more"},
        {"id,flow\n8,0\n", ": all flows are 0; at least one must be above 0"},
        {"id,flow [m]\n8,1\n", ": the file must have exactly one column called flow, in ml/min"},
        {"id,flow_0,flow_1\n8,1,2\n",
         ": the file must have exactly one column called flow, in ml/min"}};
    for (size_t k = 0; k < 4; k++) {
        write_input(cases[k][0]);
        assert_int_equal(tree_read_flows(&tree, input, &err), STATUS_INPUT);
        assert_string_equal(err.text + strlen(input), cases[k][1]);
    }
    for (size_t i = 0; i < 5; i++)
        tree.radius_mm[i] = 0;
    assert_int_equal(tree_set_flow_by_radius(&tree, 3, &err), STATUS_INPUT);
    assert_null(tree.flow_share);
    tree_release(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_column_is_joined_by_id),
        cmocka_unit_test(columns_are_frames),
        cmocka_unit_test(rows_of_a_time_are_frames),
        cmocka_unit_test(a_branch_of_simvascular_is_all_its_segments),
        cmocka_unit_test(refuses_values_that_do_not_fit),
        cmocka_unit_test(names_of_columns_tell_their_time),
        cmocka_unit_test(refuses_two_columns_of_one_time),
        cmocka_unit_test(flow_parts_as_is_asked_for),
        cmocka_unit_test(refuses_flows_that_make_no_sense),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
