/* Trees in CSV: reading, writing, errors. */
#include "any_file.h"
#include "derive/derive.h"
#include "treeio/treeio.h"
#include "unit.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[] = "/tmp/corcast-csv-XXXXXX";
static char input[64], output[64];

static int make_folder(void **state)
{
    (void)state;
    if (!mkdtemp(folder))
        return -1;
    snprintf(input, sizeof input, "%s/in.csv", folder);
    snprintf(output, sizeof output, "%s/out.csv", folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    unlink(input);
    unlink(output);
    return rmdir(folder);
}

static Tree read_text(const char *text)
{
    Tree tree = {0};
    Err err;
    must(file_write(input, text, strlen(text), &err), &err);
    must(tree_read(&tree, input, &err), &err);
    must(tree_check(&tree, &err), &err);
    return tree;
}

static void assert_written(const Tree *tree, const char *expected)
{
    char *bytes = NULL;
    size_t size = 0;
    Err err;
    must(tree_write(tree, output, &err), &err);
    must(file_read(output, &any_file, &bytes, &size, &err), &err);
    assert_string_equal(bytes, expected);
    free(bytes);
}

/* `expected` goes on from the file's name. */
static void assert_refused(const char *text, const char *expected)
{
    Tree tree = {.n = 77};
    Err err;
    must(file_write(input, text, strlen(text), &err), &err);
    assert_int_equal(tree_read(&tree, input, &err), STATUS_INPUT);
    assert_memory_equal(err.text, input, strlen(input));
    assert_string_equal(err.text + strlen(input), expected);
    assert_int_equal(tree.n, 77);
}

static const char tidy[] = "# gamma: 2.7\n"
                           "# by hand\n"
                           "id,parent,x_mm,y_mm,z_mm,radius_mm,type,flow_share,\"wss [Pa]\",\"a, "
                           "\"\"b\"\" [\"\"]\"\n"
                           "12,-1,0.5,1.25,-2,2.385,3,0,,\n"
                           "7,12,3.5,5.25,-2,2.385,3,0,3.125,-7\n"
                           "30,7,9.5,4.75,1.5,1.655,5,0.75,1e-12,\n"
                           "9,7,2.5,11.5,0.5,2.0625,3,1.5,,0.1\n";

static void what_is_written_reads_back_to_the_same_bytes(void **state)
{
    (void)state;
    Tree tree = read_text(tidy);
    assert_int_equal(tree.n_columns, 2);
    assert_string_equal(tree.column[0].name, "wss");
    assert_string_equal(tree.column[0].unit, "Pa");
    assert_string_equal(tree.column[1].name, "a, \"b\"");
    assert_string_equal(tree.column[1].unit, "\"");
    assert_true(isnan(tree.column[0].value[0]) && tree.column[0].value[1] == 3.125);
    assert_true(tree.column[1].value[3] == 0.1 && tree.flow_share[2] == 0.75);
    assert_true(tree.type[2] == 5 && tree.meta.number[META_GAMMA] == 2.7);
    assert_written(&tree, tidy);
    tree_release(&tree);
}

static void reads_columns_and_rows_in_any_order(void **state)
{
    (void)state;
    Tree tree = read_text("\n# kept\nradius_mm,\"z_mm\" , y_mm,x_mm,age [a],parent,id\r\n"
                          " 1.655 ,-2,\"5.25\",3.5,NA,12,7\n\n"
                          "2.385,-2,1.25,.5,NaN,,12.0\n"
                          "0,1.5,4.75,9.5,41.5,7,30\n");
    assert_written(&tree, "# kept\nid,parent,x_mm,y_mm,z_mm,radius_mm,type,\"age [a]\"\n"
                          "12,-1,0.5,1.25,-2,2.385,3,\n"
                          "7,12,3.5,5.25,-2,1.655,3,\n"
                          "30,7,9.5,4.75,1.5,0,3,41.5\n");
    tree_release(&tree);
}

static void a_column_is_a_field_and_pruning_keeps_it(void **state)
{
    (void)state;
    Tree tree = read_text(tidy), pruned;
    Field field;
    Err err;
    must(tree_prune_copy(&tree, 2, &pruned, &err), &err);
    must(derive_field(&pruned, &(TreeMeta){0}, "a, \"b\"", &field, &err), &err);
    assert_int_equal(field.n, 3);
    assert_true(isnan(field.value[0]) && field.value[1] == -7 && field.value[2] == 0.1);
    field_release(&field);
    must(derive_field(&tree, &(TreeMeta){0}, "strahler", &field, &err), &err);
    field_release(&field);
    assert_int_equal(derive_field(&tree, &(TreeMeta){0}, "b", &field, &err), STATUS_USAGE);
    assert_non_null(strstr(err.text, "wss, a, \"b\""));
    tree_release(&pruned);
    tree_release(&tree);
}

static void rejects_titles_that_make_no_table(void **state)
{
    (void)state;
    assert_refused("id,parent,x_mm,y_mm,radius_mm\n1,,0,0,1\n",
                   ":1: no column is called z_mm; a CSV of nodes needs id, parent, x_mm, y_mm, "
                   "z_mm and radius_mm");
    assert_refused("# x\nid,parent,x_mm,y_mm,z_mm,radius_mm,id\n",
                   ":2: two columns are called 'id'");
    assert_refused("id,parent,x_mm,y_mm,z_mm,radius_mm,q [a],q [b]\n",
                   ":1: two columns are called 'q'");
    assert_refused("id,parent,x_mm,y_mm,z_mm,radius_mm,\n", ":1: a column has no name");
    assert_refused("id,\"parent\n", ":1: a quoted field has no closing quote");
    assert_refused("\"id\"2,parent\n", ":1: a quoted field is followed by '2,parent'; a separator "
                                       "or the end of the line must follow");
    assert_refused("id,parent,x_mm,y_mm,z_mm,radius_mm\n# only\n",
                   ": the file has no nodes; a tree has at least one");
}

static void rejects_columns_beyond_number(void **state)
{
    (void)state;
    Text text = TEXT_INIT;
    text_puts(&text, "id,parent,x_mm,y_mm,z_mm,radius_mm");
    for (int k = 0; k <= BUILDER_MAX_COLUMNS; k++)
        text_printf(&text, ",c%d", k);
    assert_refused(text_chars(&text), ":1: there are more than 10000 columns");
    text_release(&text);
}

static void rejects_rows_naming_line_and_column(void **state)
{
    (void)state;
    static const struct {
        const char *row, *sentence;
    } bad[] = {
        {"1,,0,0,0,1", ":3: the row has 6 fields; it must have 8, one per column"},
        {"1,,0,0,0,1,,,9", ":3: the row has 9 fields; it must have 8, one per column"},
        {"0,,0,0,0,1,,", ":3: the id is '0'; it must be an integer from 1 to 100000000"},
        {"1,-2,0,0,0,1,,", ":3: the parent is '-2'; it must be an integer from -1 to 100000000"},
        {"1,,O,0,0,1,,", ":3: the x_mm is 'O'; it must be a finite number"},
        {"1,,0,,0,1,,", ":3: the y_mm is ''; it must be a finite number"},
        {"1,,0,0,0,-1,,", ":3: the radius_mm is '-1'; it must be a finite number of 0 or more"},
        {"1,,0,0,0,1,-3,", ":3: the flow_share is '-3'; it must be a finite number of 0 or more"},
        {"1,,0,0,0,1,,high", ":3: the wss is 'high'; it must be a finite number"},
        {"1,,0,0,0,1,,inf", ":3: the wss is 'inf'; it must be a finite number"},
        {"7,4,0,0,0,1,,", ":3: the id 7 is already that of line 2; every node needs its own"},
        {"1,8,0,0,0,1,,",
         ":3: the parent is 8, which is not the id of a node; it must be the id of a node, "
         "or -1 for a root"},
        {"1,1,0,0,0,1,,", ":3: node 1 is its own parent; parents must lead to a root, whose parent "
                          "is -1"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char text[200];
        snprintf(text, sizeof text,
                 "id,parent,x_mm,y_mm,z_mm,radius_mm,flow_share,wss [Pa]\n7,,0,0,0,1,,\n%s\n",
                 bad[i].row);
        assert_refused(text, bad[i].sentence);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_reads_back_to_the_same_bytes),
        cmocka_unit_test(reads_columns_and_rows_in_any_order),
        cmocka_unit_test(a_column_is_a_field_and_pruning_keeps_it),
        cmocka_unit_test(rejects_titles_that_make_no_table),
        cmocka_unit_test(rejects_columns_beyond_number),
        cmocka_unit_test(rejects_rows_naming_line_and_column),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
