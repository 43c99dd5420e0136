/* Fuzzes the reader of values of segments. The input is a column's name ("" for all columns) up
 * to the first zero byte, then a CSV. The result must be a field of the tree in which roots
 * have no value. */
#include "fuzz.h"

#include "derive/derive.h"
#include "treeio/treeio.h"
#include <math.h>

static const char swc[] = "1 3 0 0 0 1.5 -1\n2 3 4 0 0 1.5 1\n3 3 7 2 0 1 2\n7 3 7 -2 0 1.25 2\n";

static void check_series(const Tree *tree, const char *name)
{
    FieldSeries series;
    Err err;
    if (derive_series(tree, &(TreeMeta){0}, name, &series, &err) != STATUS_OK)
        return;
    assert(series.frames >= 1 && series.field.n == series.frames * tree->n);
    for (size_t k = 0; k < series.frames; k++)
        assert(isnan(series.field.value[k * tree->n]) &&
               (k == 0 || series.time[k] > series.time[k - 1]));
    fieldseries_release(&series);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    Tree tree;
    Err err = {{0}};
    char path[128], column[64] = "", *name = NULL;
    FuzzPart wanted = fuzz_part(&bytes, &size);
    if (wanted.size >= sizeof column)
        return 0;
    memcpy(column, wanted.bytes, wanted.size);
    Status status = tree_read(&tree, fuzz_file("tree.swc", swc, sizeof swc - 1), &err);
    assert(status == STATUS_OK);
    strcpy(path, fuzz_file("values.csv", bytes, size));
    status = tree_read_values(&tree, path, *column ? column : NULL, &name, &err);
    fuzz_check_refusal(status, &err, path);
    if (status == STATUS_OK)
        check_series(&tree, name);
    free(name);
    tree_release(&tree);
    return 0;
}
