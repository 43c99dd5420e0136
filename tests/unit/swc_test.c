/* Trees in SWC: reading, writing, errors. */
#include "any_file.h"
#include "treeio/treeio.h"
#include "unit.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[] = "/tmp/corcast-swc-XXXXXX";
static char input[64], output[64], again[64];

static int make_folder(void **state)
{
    (void)state;
    if (!mkdtemp(folder))
        return -1;
    snprintf(input, sizeof input, "%s/in.swc", folder);
    snprintf(output, sizeof output, "%s/out.swc", folder);
    snprintf(again, sizeof again, "%s/again.swc", folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    unlink(input);
    unlink(output);
    unlink(again);
    return rmdir(folder);
}

static Tree read_path(const char *path)
{
    Tree tree = {0};
    Err err;
    must(tree_read(&tree, path, &err), &err);
    must(tree_check(&tree, &err), &err);
    return tree;
}

static Tree read_bytes(const char *bytes, size_t size)
{
    Err err;
    must(file_write(input, bytes, size, &err), &err);
    return read_path(input);
}

static Tree read_text(const char *text)
{
    return read_bytes(text, strlen(text));
}

/* The bytes that the tree is written as (owned). */
static char *written(const Tree *tree)
{
    char *bytes = NULL;
    size_t size = 0;
    Err err;
    must(tree_write(tree, output, &err), &err);
    must(file_read(output, &any_file, &bytes, &size, &err), &err);
    return bytes;
}

static void assert_written(const Tree *tree, const char *expected)
{
    char *bytes = written(tree);
    assert_string_equal(bytes, expected);
    free(bytes);
}

/* Reads, writes, reads and writes: the same bytes both times. */
static void assert_round_trip(const char *path)
{
    Tree first = read_path(path);
    char *once = written(&first);
    Tree second = read_path(output);
    char *twice = written(&second);
    assert_string_equal(once, twice);
    assert_int_equal(first.n, second.n);
    assert_memory_equal(first.position, second.position, first.n * sizeof *first.position);
    assert_memory_equal(first.radius_mm, second.radius_mm, first.n * sizeof *first.radius_mm);
    assert_memory_equal(first.parent, second.parent, first.n * sizeof *first.parent);
    free(once);
    free(twice);
    tree_release(&first);
    tree_release(&second);
}

/* `expected` goes on from the file's name. */
static void assert_refused_bytes(const char *bytes, size_t size, const char *expected)
{
    Tree tree = {.n = 77};
    Err err;
    must(file_write(input, bytes, size, &err), &err);
    assert_int_equal(tree_read(&tree, input, &err), STATUS_INPUT);
    assert_memory_equal(err.text, input, strlen(input));
    assert_string_equal(err.text + strlen(input), expected);
    assert_int_equal(tree.n, 77);
}

static void assert_refused(const char *text, const char *expected)
{
    assert_refused_bytes(text, strlen(text), expected);
}

static void reads_a_messy_file(void **state)
{
    (void)state;
    Tree tree = read_path("tests/data/messy.swc");
    assert_true(tree.meta.known[META_GAMMA] && tree.meta.number[META_GAMMA] == 2.85);
    assert_false(tree.meta.known[META_LAMBDA]);
    assert_written(&tree, "# ORIGINAL_SOURCE  by hand \n"
                          "# \tVERSION_DATE 2007-07-24\n"
                          "# gamma: 2.85\n"
                          "# late: remark\n"
                          "#\n"
                          "4 2 1.125 0.25 6 0.625 -1\n"
                          "9 2 2.5 1.5 8 0.625 4\n"
                          "17 2 3.75 -0.5 10 0.375 9\n"
                          "23 0 5.5 2.25 9.5 0 9\n");
    tree_release(&tree);
}

static void line_ends_may_be_cr_lf_or_both(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "#a\n1 2 .5 .25 0 1.5 -1\n3 2 1 2 4 .5 1\n",
        "#a\r1 2 .5 .25 0 1.5 -1\r3 2 1 2 4 .5 1\r",
        "#a\r\n1 2 .5 .25 0 1.5 -1\r\n3 2 1 2 4 .5 1\r\n",
        "#a\n1 2 .5 .25 0 1.5 -1\n3 2 1 2 4 .5 1",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        Tree tree = read_text(texts[i]);
        assert_written(&tree, "# a\n1 2 0.5 0.25 0 1.5 -1\n3 2 1 2 4 0.5 1\n");
        tree_release(&tree);
    }
}

static void every_known_key_fills_its_field_and_unknown_lines_stay(void **state)
{
    (void)state;
    static const char text[] = "# generator: corcast 1.2\n"
                               "# seed: 18446744073709551615\n"
                               "# dimension: 3\n"
                               "# domain: ball:28.794\n"
                               "# gamma: 2.7\n"
                               "# lambda: 0\n"
                               "# p_perf_mmHg: 97.3\n"
                               "# p_term_mmHg: -3.25\n"
                               "# q_perf_ml_min: 212.5\n"
                               "# viscosity_cP: 3.4500000000000002\n"
                               "# viscosity_law:pries \n"
                               "# hematocrit: 0.4375\n"
                               "# plasma_viscosity_cP: 1.1875\n"
                               "# terminal_flow: equal\n"
                               "#\n"
                               "# gamma rays: 7\n"
                               "1 5 0 0 0 2.385 -1\n";
    Tree tree = read_text(text);
    const TreeMeta *meta = &tree.meta;
    static const struct {
        MetaKey key;
        double number;
    } expected[] = {{META_DIMENSION, 3},
                    {META_GAMMA, 2.7},
                    {META_LAMBDA, 0},
                    {META_P_PERF, 97.3},
                    {META_P_TERM, -3.25},
                    {META_Q_PERF, 212.5},
                    {META_VISCOSITY, 3.45},
                    {META_VISCOSITY_LAW, VISCOSITY_PRIES},
                    {META_HEMATOCRIT, 0.4375},
                    {META_PLASMA_VISCOSITY, 1.1875},
                    {META_TERMINAL_FLOW, TERMINAL_FLOW_EQUAL}};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        assert_true(meta->known[expected[i].key]);
        assert_true(meta->number[expected[i].key] == expected[i].number);
    }
    assert_true(meta->known[META_SEED] && meta->seed == UINT64_MAX);
    assert_string_equal(meta->text[META_GENERATOR], "corcast 1.2");
    assert_string_equal(meta->text[META_DOMAIN], "ball:28.794");
    assert_int_equal(meta->n_lines, 16);

    char *bytes = written(&tree);
    assert_non_null(strstr(bytes, "# viscosity_cP: 3.45\n# viscosity_law: pries\n# hematocrit: "
                                  "0.4375\n# plasma_viscosity_cP: 1.1875\n# terminal_flow: "
                                  "equal\n#\n# gamma rays: 7\n1 5 "));
    assert_non_null(strstr(bytes, "# seed: 18446744073709551615\n# dimension: 3\n# domain"));
    free(bytes);
    tree_release(&tree);
}

static void known_fields_are_written_whether_a_line_names_them_or_not(void **state)
{
    (void)state;
    Err err;
    Tree tree = read_text("# gamma: 2.7\n# kept\n# seed: 41\n1 0 0 0 0 .5 -1\n");
    tree.meta.number[META_GAMMA] = 2.85;
    tree.meta.known[META_SEED] = false;
    must(meta_set_text(&tree.meta, META_DOMAIN, "disc:50", &err), &err);
    meta_set_number(&tree.meta, META_DIMENSION, 2);
    must(meta_add_text(&tree.meta, META_COMMAND, "corcast refine", &err), &err);
    must(meta_add_text(&tree.meta, META_COMMAND, "corcast convert", &err), &err);
    assert_written(&tree, "# gamma: 2.85\n# kept\n# command: corcast refine\n# command: corcast "
                          "convert\n# dimension: 2\n# domain: disc:50\n"
                          "1 0 0 0 0 0.5 -1\n");
    tree_release(&tree);
}

static void a_key_that_says_the_same_again_is_fine(void **state)
{
    (void)state;
    Tree tree = read_text("# gamma: 2.5\n1 0 0 0 0 .5 -1\n# gamma: 2.50\n");
    assert_written(&tree, "# gamma: 2.5\n1 0 0 0 0 0.5 -1\n");
    tree_release(&tree);
}

static void rejects_a_known_key_of_bad_value(void **state)
{
    (void)state;
    assert_refused("# x\n# gamma: high\n",
                   ":2: gamma is 'high'; it must be a number above 0 and at most 10");
    assert_refused("# gamma: 0", ":1: gamma is '0'; it must be a number above 0 and at most 10");
    assert_refused("# gamma: 10.5",
                   ":1: gamma is '10.5'; it must be a number above 0 and at most 10");
    assert_refused("# gamma:", ":1: gamma is ''; it must be a number above 0 and at most 10");
    assert_refused("# lambda: -1", ":1: lambda is '-1'; it must be a number of at least 0");
    assert_refused("# lambda: inf", ":1: lambda is 'inf'; it must be a number of at least 0");
    assert_refused("# dimension: 2.5", ":1: dimension is '2.5'; it must be an integer from 2 to 3");
    assert_refused("# p_perf_mmHg: nan", ":1: p_perf_mmHg is 'nan'; it must be a finite number");
    assert_refused("# p_term_mmHg: 1 2", ":1: p_term_mmHg is '1 2'; it must be a finite number");
    assert_refused("# q_perf_ml_min: 0", ":1: q_perf_ml_min is '0'; it must be a number above 0");
    assert_refused("# viscosity_cP: -3", ":1: viscosity_cP is '-3'; it must be a number above 0");
    assert_refused("# viscosity_law: casson",
                   ":1: viscosity_law is 'casson'; it must be constant or pries");
    assert_refused("# hematocrit: 0.951",
                   ":1: hematocrit is '0.951'; it must be a number from 0 to 0.95");
    assert_refused("# terminal_flow:",
                   ":1: terminal_flow is ''; it must be equal or territory or demand");
    assert_refused("# terminal_flow: equal\n#terminal_flow: territory",
                   ":2: terminal_flow is 'territory', but an earlier line has another value");
    static const char seed[] = "it must be an integer from 0 to 18446744073709551615";
    char expected[120];
    snprintf(expected, sizeof expected, ":1: seed is '-1'; %s", seed);
    assert_refused("# seed: -1", expected);
    snprintf(expected, sizeof expected, ":1: seed is '18446744073709551616'; %s", seed);
    assert_refused("# seed: 18446744073709551616", expected);
    assert_refused("# gamma: 2.5\n#gamma: 3\n",
                   ":2: gamma is '3', but an earlier line has another value");
}

static void flow_shares_follow_their_nodes(void **state)
{
    (void)state;
    Tree tree = read_text("# flow_share: 9 0.75\n"
                          "# terminal_flow: territory\n"
                          "17 3 1 2 3 .5 4\n"
                          "4 3 1 2 0 .5 -1\n"
                          "9 3 4 2 3 .25 17\n"
                          "12 3 0 2 3 .25 17\n"
                          "#\tflow_share :12\t1.0625e0 \n");
    static const double expected[] = {0, 0, 0.75, 1.0625};
    assert_memory_equal(tree.flow_share, expected, sizeof expected);
    tree_renumber(&tree);
    assert_written(&tree, "# terminal_flow: territory\n"
                          "# flow_share: 3 0.75\n"
                          "# flow_share: 4 1.0625\n"
                          "1 3 1 2 0 0.5 -1\n"
                          "2 3 1 2 3 0.5 1\n"
                          "3 3 4 2 3 0.25 2\n"
                          "4 3 0 2 3 0.25 2\n");
    tree_release(&tree);
    assert_round_trip(output);
}

static void rejects_flow_shares_that_make_no_sense(void **state)
{
    (void)state;
    static const char *const bad[] = {"", "2", "2 0", "2 -1", "2 1 1", "2 nan", "2.5 1", "0 1"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char text[100], expected[200];
        snprintf(text, sizeof text, "1 0 0 0 0 1 -1\n# flow_share: %s\n", bad[i]);
        snprintf(expected, sizeof expected,
                 ":2: flow_share is '%s'; it must be the id of a node and a number above 0",
                 bad[i]);
        assert_refused(text, expected);
    }
    assert_refused("1 0 0 0 0 1 -1\n# flow_share: 2 1.5\n",
                   ":2: flow_share names the node 2, which is not the id of a node");
    assert_refused("# flow_share: 1 1.5\n# flow_share: 1 1.5\n1 0 0 0 0 1 -1\n",
                   ":2: the flow share of node 1 is stated twice");
    assert_refused("# terminal_flow: territory\n1 0 0 0 0 1 -1\n",
                   ": terminal_flow is territory, but there are no flow shares");
    assert_refused("# terminal_flow: equal\n# flow_share: 1 2\n1 0 0 0 0 1 -1\n",
                   ": terminal_flow is equal, but there are flow shares");
}

static void fields_may_be_parted_by_commas_and_a_line_may_name_them(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "id,type,X,Y,Z,radius,parent\n1,2,.5,.25,0,1.5,-1\n3, 2, 1, 2, 4, .5, 1\n",
        "1;2;.5;.25;0;1.5;-1\n3;2;1;2;4;.5;1 # end\n",
        "n\ttype\tx\ty\tz\tradius\tparent\n1.0\t2\t.5\t+.25\t0\t1.5\t-1\n3\t2\t1\t2\t4\t.5\t1\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        Tree tree = read_text(texts[i]);
        assert_written(&tree, "1 2 0.5 0.25 0 1.5 -1\n3 2 1 2 4 0.5 1\n");
        tree_release(&tree);
    }
}

static void ids_may_start_at_0_and_the_parent_of_a_root_may_be_0(void **state)
{
    (void)state;
    Tree tree = read_text("0 2 .5 0 0 1.5 -1\n1 2 1 2 4 .5 0\n2 2 3 2 4 .25 1\n");
    assert_written(&tree, "1 2 0.5 0 0 1.5 -1\n2 2 1 2 4 0.5 1\n3 2 3 2 4 0.25 2\n");
    tree_release(&tree);
    tree = read_text("4 2 .5 0 0 1.5 0\n1 2 1 2 4 .5 4\n");
    assert_written(&tree, "4 2 0.5 0 0 1.5 -1\n1 2 1 2 4 0.5 4\n");
    tree_release(&tree);
    assert_refused("# flow_share: 1 2.5\n0 2 .5 0 0 1.5 -1\n1 2 1 2 4 .5 0\n",
                   ": the ids start at 0, but a flow_share refers to nodes by ids from 1 on");
}

static void more_columns_become_columns_of_the_tree(void **state)
{
    (void)state;
    Tree tree = read_text("##n type x y z radius parent seg_id level mode timestamp TFresindex\n"
                          "1 2 .5 0 0 1.5 -1 0 2.5 0 NA 7\n2 2 1 2 4 .5 1 1 3 0 12.5 nan\n");
    assert_int_equal(tree.n_columns, 5);
    assert_string_equal(tree.column[1].name, "level");
    assert_true(tree.column[1].value[0] == 2.5 && tree.column[1].value[1] == 3);
    assert_true(isnan(tree.column[3].value[0]) && tree.column[3].value[1] == 12.5);
    tree_release(&tree);
    tree = read_text("# n type x y z radius parent\n1 2 .5 0 0 1.5 -1 4.75\n");
    assert_string_equal(tree.column[0].name, "column 8");
    assert_true(tree.column[0].value[0] == 4.75);
    tree_release(&tree);
    assert_refused("1 2 .5 0 0 1.5 -1 high\n",
                   ":1: the value is 'high'; it must be a finite number");
}

static void rejects_a_wrong_field_count(void **state)
{
    (void)state;
    assert_refused("1 2 0 0 0 .5 -1\n2 2 1 1 1 .5\n",
                   ":2: the row has 6 fields; it must have 7: id type x y z radius parent");
    assert_refused("\n\nhello\n",
                   ":3: the row has 1 field; it must have 7: id type x y z radius parent");
    assert_refused("1,2,0,0,,.5,-1\n",
                   ":1: the row has 6 fields; it must have 7: id type x y z radius parent");
    assert_refused("1 2 0 0 0 .5 -1\n2 2 1 1 1 .5 1 8\n",
                   ":2: the row has 8 fields; it must have 7: id type x y z radius parent");
    assert_refused("1 2 0 0 0 .5 -1 8 9\n2 2 1 1 1 .5 1\n",
                   ":2: the row has 7 fields; earlier rows have 9");
}

static void rejects_what_is_not_a_number(void **state)
{
    (void)state;
    assert_refused("1 2 0 O 0 .5 -1\n", ":1: the y coordinate is 'O'; it must be a finite number");
    assert_refused("1 2 0 0 0 .5mm -1\n",
                   ":1: the radius is '.5mm'; it must be a finite number of 0 or more");
    assert_refused("1 2 0 0 0x1p3 .5 -1\n",
                   ":1: the z coordinate is '0x1p3'; it must be a finite number");
    assert_refused("one 2 0 0 0 .5 -1\n",
                   ":1: the id is 'one'; it must be an integer from 1 to 100000000");
    assert_refused("1 axon 0 0 0 .5 -1\n", ":1: the type is 'axon'; it must be an integer from "
                                           "-2147483648 to 2147483647");
    assert_refused("1 2 0 0 0 .5 none\n",
                   ":1: the parent is 'none'; it must be an integer from -1 to 100000000");
}

static void rejects_what_is_not_finite(void **state)
{
    (void)state;
    assert_refused("1 2 nan 0 0 .5 -1\n",
                   ":1: the x coordinate is 'nan'; it must be a finite number");
    assert_refused("1 2 0 0 -inf .5 -1\n",
                   ":1: the z coordinate is '-inf'; it must be a finite number");
    assert_refused("1 2 0 1e999 0 .5 -1\n",
                   ":1: the y coordinate is '1e999'; it must be a finite number");
    assert_refused("1 2 0 0 0 NaN -1\n",
                   ":1: the radius is 'NaN'; it must be a finite number of 0 "
                   "or more (`repair_radii` replaces it, from its neighbors)");
}

static void rejects_a_negative_radius_and_takes_zero(void **state)
{
    (void)state;
    assert_refused("1 2 0 0 0 -0.375 -1\n",
                   ":1: the radius is '-0.375'; it must be a finite number of 0 or more "
                   "(`repair_radii` replaces it, from its neighbors)");
    Tree tree = read_text("1 2 0 0 0 0 -1\n");
    assert_true(tree.radius_mm[0] == 0);
    tree_release(&tree);
}

static void rejects_ids_out_of_range(void **state)
{
    (void)state;
    static const char allowed[] = "; it must be an integer from 1 to 100000000";
    static const char *const ids[] = {"-3", "100000001", "1.5", "nan", "99999999999999999999"};
    for (size_t i = 0; i < sizeof ids / sizeof *ids; i++) {
        char text[80], expected[120];
        snprintf(text, sizeof text, "#\n%s 2 0 0 0 .5 -1\n", ids[i]);
        snprintf(expected, sizeof expected, ":2: the id is '%s'%s", ids[i], allowed);
        assert_refused(text, expected);
    }
    assert_refused("7 2 0 0 0 .5 -1\n0 2 0 0 1 .5 7\n",
                   ":2: the id is '0'; it must be an integer from 1 to 100000000");
    assert_refused("0 2 0 0 0 .5 -1\n100000000 2 0 0 1 .5 0\n",
                   ":2: the id is '100000000'; it must be an integer from 0 to 99999999");
    Tree tree = read_text("100000000 2 0 0 0 .5 -1\n1e1 2 0 0 1 .5 100000000.0\n");
    assert_int_equal(tree.id[0], 100000000);
    assert_int_equal(tree.id[1], 10);
    tree_release(&tree);
}

static void rejects_a_duplicate_id_naming_both_lines(void **state)
{
    (void)state;
    assert_refused("7 2 0 0 0 .5 -1\n#\n8 2 0 0 1 .5 7\n7 2 0 0 2 .5 8\n",
                   ":4: the id 7 is already that of line 1; every node needs its own");
}

static void rejects_an_unknown_parent(void **state)
{
    (void)state;
    static const char *const parents[] = {"3", "100000000"};
    for (size_t i = 0; i < sizeof parents / sizeof *parents; i++) {
        char text[80], expected[160];
        snprintf(text, sizeof text, "7 2 0 0 0 .5 -1\n8 2 0 0 1 .5 %s\n", parents[i]);
        snprintf(expected, sizeof expected,
                 ":2: the parent is %s, which is not the id of a node; it must be the id of a "
                 "node, or -1 for "
                 "a root",
                 parents[i]);
        assert_refused(text, expected);
    }
    assert_refused("7 2 0 0 0 .5 -2\n",
                   ":1: the parent is '-2'; it must be an integer from -1 to 100000000");
}

static void rejects_cycles(void **state)
{
    (void)state;
    static const char rule[] = "parents must lead to a root, whose parent is -1";
    char expected[120];
    snprintf(expected, sizeof expected, ":2: node 8 is its own parent; %s", rule);
    assert_refused("7 2 0 0 0 .5 -1\n8 2 0 0 1 .5 8\n", expected);
    snprintf(expected, sizeof expected, ":3: node 9 is its own ancestor; %s", rule);
    assert_refused("1 2 0 0 0 .5 -1\n7 2 0 0 0 .5 9\n9 2 0 0 1 .5 8\n8 2 0 0 1 .5 9\n", expected);
}

static void rejects_files_without_rows(void **state)
{
    (void)state;
    static const char sentence[] = ": the file has no nodes; a tree has at least one";
    assert_refused("", sentence);
    assert_refused("\xef\xbb\xbf", sentence);
    assert_refused("# only\n\n \t\n", sentence);
    assert_refused("\n", sentence);
}

static void rejects_binary_files(void **state)
{
    (void)state;
    static const char bytes[] = "# a\n1 2 0 0\0 0 .5 -1\n";
    assert_refused_bytes(bytes, sizeof bytes - 1, ":2: a zero byte; an SWC file is plain text");
    assert_refused_bytes("\0", 1, ":1: a zero byte; an SWC file is plain text");
}

static void rejects_missing_files_and_unknown_extensions(void **state)
{
    (void)state;
    Tree tree = {0};
    Err err;
    assert_int_equal(tree_read(&tree, "/nonexistent/t.swc", &err), STATUS_INPUT);
    assert_int_equal(tree_read(&tree, "t.swq", &err), STATUS_USAGE);
    assert_memory_equal(err.text, "t.swq: unknown extension of a tree file; use .swc, ", 51);
    assert_non_null(strstr(err.text, ", or - for standard input or output; did you mean .swc?"));
    assert_int_equal(tree_write(&tree, "t", &err), STATUS_USAGE);
    assert_true(tree_format_known("a.b/T.SWC") && tree_format_known("-"));
    assert_false(tree_format_known("swc") || tree_format_known("t.swc.gz"));
}

static void an_unwritable_place_is_an_io_failure(void **state)
{
    (void)state;
    Err err;
    Tree tree = read_path("tests/data/bifurcation.swc");
    assert_int_equal(tree_write(&tree, "/nonexistent/t.swc", &err), STATUS_IO);
    tree_release(&tree);
}

static void ancestors_move_ahead_and_the_rest_keeps_file_order(void **state)
{
    (void)state;
    Tree tree = read_text("5 0 0 0 0 .5 3\n" /* needs 3, which needs 9 */
                          "4 0 0 0 0 .5 9\n"
                          "8 0 0 0 0 .5 -1\n"
                          "9 0 0 0 0 .5 -1\n"
                          "3 0 0 0 0 .5 9\n"
                          "1 0 0 0 0 .5 8\n");
    static const int32_t id[] = {9, 3, 5, 4, 8, 1};
    static const int32_t parent[] = {-1, 0, 1, 0, -1, 4};
    assert_memory_equal(tree.id, id, sizeof id);
    assert_memory_equal(tree.parent, parent, sizeof parent);
    tree_release(&tree);
}

/* A random forest with ids in no order, as text rows in random order. */
static void random_rows(Random *random, size_t n, Text *text)
{
    size_t *order = NULL;
    int32_t *id = NULL;
    Err err;
    must(mem_calloc(&order, n, sizeof *order, "rows", &err), &err);
    must(mem_calloc(&id, n, sizeof *id, "ids", &err), &err);
    for (size_t i = 0; i < n; i++) { /* both a shuffle as it grows */
        size_t at = random_bits(random) % (i + 1);
        order[i] = order[at];
        order[at] = i;
        at = random_bits(random) % (i + 1);
        id[i] = id[at];
        id[at] = (int32_t)(1 + i * 37);
    }
    int32_t *parent = NULL;
    must(mem_calloc(&parent, n, sizeof *parent, "parents", &err), &err);
    for (size_t i = 0; i < n; i++)
        parent[i] = i == 0 || random_uniform(random) < 0.03 ? -1 : id[random_bits(random) % i];
    for (size_t k = 0; k < n; k++) {
        size_t i = order[k];
        text_printf(text, "%d %d", id[i], (int)(random_bits(random) % 8));
        for (int axis = 0; axis < 4; axis++) {
            double value = random_uniform(random) * pow(10, (double)(random_bits(random) % 9) - 4);
            text_puts(text, " ");
            text_number(text, axis == 3 ? value : value - 1.75);
        }
        text_printf(text, " %d\n", parent[i]);
    }
    free(order);
    free(id);
    free(parent);
}

static void random_forests_in_random_order_survive_the_round_trip(void **state)
{
    (void)state;
    Random random;
    Err err;
    random_seed(&random, 20240817);
    for (int round = 0; round < 60; round++) {
        Text text = TEXT_INIT;
        random_rows(&random, 1 + random_bits(&random) % 300, &text);
        must(file_write(input, text.chars, text.length, &err), &err);
        assert_round_trip(input);
        text_release(&text);
    }
}

static void damaged_files_are_read_or_refused(void **state)
{
    (void)state;
    static const char letters[] = "0123456789-+.e# \t\r\n\v:nax\0\xef\xff";
    char *original = NULL;
    size_t size = 0;
    Err err;
    Random random;
    random_seed(&random, 77003);
    must(file_read("tests/data/messy.swc", &any_file, &original, &size, &err), &err);
    for (int round = 0; round < 2000; round++) {
        char damaged[1024];
        assert_true(size < sizeof damaged);
        memcpy(damaged, original, size);
        for (int hit = 0; hit < 3; hit++)
            damaged[random_bits(&random) % size] = letters[random_bits(&random) % sizeof letters];
        must(file_write(input, damaged, random_bits(&random) % (size + 1), &err), &err);
        Tree tree = {0};
        Status status = tree_read(&tree, input, &err);
        assert_true(status == STATUS_OK || status == STATUS_INPUT);
        if (status == STATUS_OK)
            must(tree_check(&tree, &err), &err);
        tree_release(&tree);
    }
    free(original);
}

static void the_hand_made_trees_survive_the_round_trip(void **state)
{
    (void)state;
    assert_round_trip("tests/data/bifurcation.swc");
    assert_round_trip("tests/data/trifurcation.swc");
    assert_round_trip("tests/data/messy.swc");
}

static void measured_trees_are_read(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        size_t n, lines;
    } files[] = {{"brava/BG0002records.swc", 3514, 0}, {"brava/test1.swc", 8, 14}};
    const char *shared = getenv("CORCAST_SHARED");
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/data/%s", shared ? shared : "../shared", files[i].name);
        if (access(path, R_OK) != 0) {
            print_message("SKIPPED: %s is not here; CORCAST_SHARED names its folder\n", path);
            skip();
        }
        Tree tree = read_path(path);
        assert_int_equal(tree.n, files[i].n);
        assert_int_equal(tree.meta.n_lines, files[i].lines);
        tree_release(&tree);
        assert_round_trip(path);
    }
}

static void a_chain_of_a_million_rows_in_reverse_is_read(void **state)
{
    (void)state;
    enum { N = 1000000 };
    Text text = TEXT_INIT;
    for (int32_t id = N; id > 0; id--)
        text_printf(&text, "%d 0 %d 0 .5 .25 %d\n", id, id % 7, id > 1 ? id - 1 : -1);
    Tree tree = read_bytes(text.chars, text.length);
    text_release(&text);
    assert_int_equal(tree.n, N);
    assert_int_equal(tree.id[0], 1);
    assert_int_equal(tree.id[N - 1], N);
    tree_release(&tree);
}

/* Rows of a chain, in which row `odd` stands as said; the file has many blocks of them. */
static Text chain_with(int32_t odd, const char *row)
{
    Text text = TEXT_INIT;
    for (int32_t id = 1; id <= 60000; id++)
        if (id == odd)
            text_puts(&text, row);
        else
            text_printf(&text, "%d 3 %d.385 0 -2.5e-7 .25 %d\n", id, id % 71, id > 1 ? id - 1 : -1);
    return text;
}

static void any_line_may_stand_among_the_rows_of_a_large_file(void **state)
{
    (void)state;
    Text text =
        chain_with(31007, "# flow_share: 31007 2.385\n\n31007 3 1,.5;0 2.385 31006 # odd\n");
    Tree tree = read_bytes(text.chars, text.length);
    text_release(&text);
    assert_int_equal(tree.n, 60000);
    for (size_t i = 0; i < tree.n; i++) {
        bool is_odd = i + 1 == 31007;
        assert_int_equal(tree.id[i], i + 1);
        assert_int_equal(tree.parent[i], (int32_t)i - 1);
        assert_true(tree.position[i].x == (is_odd ? 1 : (double)((i + 1) % 71) + .385));
        assert_true(tree.radius_mm[i] == (is_odd ? 2.385 : .25));
        assert_true(tree.flow_share[i] == (is_odd ? 2.385 : 0));
    }
    tree_release(&tree);
}

static void a_bad_row_of_a_large_file_is_named_by_its_line(void **state)
{
    (void)state;
    const struct {
        const char *row, *sentence;
    } cases[] = {
        {"31007 3 0 0 0 -1 1\n",
         ":31007: the radius is '-1'; it must be a finite number of 0 or more"},
        {"# remark\n7 3 0 0 0 1 1\n",
         ":31008: the id 7 is already that of line 7; every node needs "
         "its own"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Text text = chain_with(31007, cases[i].row);
        Tree tree;
        Err err;
        must(file_write(input, text.chars, text.length, &err), &err);
        text_release(&text);
        assert_int_equal(tree_read(&tree, input, &err), STATUS_INPUT);
        assert_non_null(strstr(err.text, cases[i].sentence));
    }
}

static void a_tree_that_breaks_a_promise_is_not_written(void **state)
{
    (void)state;
    Tree tree = read_text("1 3 0 0 0 1.5 -1\n2 3 0 7 0 1.25 1\n");
    Err err;
    remove(output);
    tree.radius_mm[1] = NAN;
    assert_int_equal(tree_write(&tree, output, &err), STATUS_INPUT);
    assert_string_equal(err.text, "node 2: radius nan; it must be finite and not negative");
    tree.radius_mm[1] = 1.25;
    tree.parent[1] = 1;
    assert_int_equal(tree_write(&tree, output, &err), STATUS_INPUT);
    assert_string_equal(err.text, "node 2: its parent does not come before it");
    assert_int_not_equal(access(output, F_OK), 0);
    tree.parent[1] = 0;
    tree_release(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tree_that_breaks_a_promise_is_not_written),
        cmocka_unit_test(reads_a_messy_file),
        cmocka_unit_test(line_ends_may_be_cr_lf_or_both),
        cmocka_unit_test(every_known_key_fills_its_field_and_unknown_lines_stay),
        cmocka_unit_test(known_fields_are_written_whether_a_line_names_them_or_not),
        cmocka_unit_test(a_key_that_says_the_same_again_is_fine),
        cmocka_unit_test(rejects_a_known_key_of_bad_value),
        cmocka_unit_test(flow_shares_follow_their_nodes),
        cmocka_unit_test(rejects_flow_shares_that_make_no_sense),
        cmocka_unit_test(fields_may_be_parted_by_commas_and_a_line_may_name_them),
        cmocka_unit_test(ids_may_start_at_0_and_the_parent_of_a_root_may_be_0),
        cmocka_unit_test(more_columns_become_columns_of_the_tree),
        cmocka_unit_test(rejects_a_wrong_field_count),
        cmocka_unit_test(rejects_what_is_not_a_number),
        cmocka_unit_test(rejects_what_is_not_finite),
        cmocka_unit_test(rejects_a_negative_radius_and_takes_zero),
        cmocka_unit_test(rejects_ids_out_of_range),
        cmocka_unit_test(rejects_a_duplicate_id_naming_both_lines),
        cmocka_unit_test(rejects_an_unknown_parent),
        cmocka_unit_test(rejects_cycles),
        cmocka_unit_test(rejects_files_without_rows),
        cmocka_unit_test(rejects_binary_files),
        cmocka_unit_test(rejects_missing_files_and_unknown_extensions),
        cmocka_unit_test(an_unwritable_place_is_an_io_failure),
        cmocka_unit_test(ancestors_move_ahead_and_the_rest_keeps_file_order),
        cmocka_unit_test(random_forests_in_random_order_survive_the_round_trip),
        cmocka_unit_test(damaged_files_are_read_or_refused),
        cmocka_unit_test(the_hand_made_trees_survive_the_round_trip),
        cmocka_unit_test(measured_trees_are_read),
        cmocka_unit_test(a_chain_of_a_million_rows_in_reverse_is_read),
        cmocka_unit_test(any_line_may_stand_among_the_rows_of_a_large_file),
        cmocka_unit_test(a_bad_row_of_a_large_file_is_named_by_its_line),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
