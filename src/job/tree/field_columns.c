/* One field after the other, each copied into a column of its own. */
#include "job/tree/field_columns.h"

#include "derive/derive.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Radius and length are in all files, as numbers or as where segments end. */
static bool is_in_files(const char *name)
{
    return strcmp(name, "radius") == 0 || strcmp(name, "length") == 0;
}

static Status add_field(Tree *tree, const TreeMeta *said, const char *name, Err *err)
{
    Field field;
    double *value;
    if (tree_column(tree, name))
        return STATUS_OK;
    TRY(derive_field(tree, said, name, &field, err));
    Status status = STATUS_OK;
    if (!tree_column(tree, field.name)) {
        status = tree_add_column(tree, field.name, field.unit, &value, err);
        if (status == STATUS_OK)
            memcpy(value, field.value, tree->n * sizeof *value);
    }
    field_release(&field);
    return status;
}

static Status add_all(Tree *tree, const TreeMeta *said, bool quiet, Err *err)
{
    Text lacking = TEXT_INIT;
    Status status = STATUS_OK;
    const char *name;
    for (size_t i = 0, n = 0; status == STATUS_OK && (name = derive_field_name(i)); i++) {
        if (is_in_files(name))
            continue;
        status = add_field(tree, said, name, err);
        if (status == STATUS_INPUT) {
            text_printf(&lacking, "%s%s", n++ ? ", " : "", name);
            status = STATUS_OK;
        }
    }
    if (status == STATUS_OK)
        status = text_check(&lacking, err);
    const char *names = text_chars(&lacking);
    if (status == STATUS_OK && !quiet && *names)
        fprintf(stderr,
                "corcast convert: %s are left out: neither the tree nor an option says what they "
                "need\n",
                names);
    text_release(&lacking);
    return status;
}

Status field_columns_add(Tree *tree, const TreeMeta *said, const char *list, bool quiet, Err *err)
{
    if (strcmp(list, "all") == 0)
        return add_all(tree, said, quiet, err);
    char *copy = NULL;
    TRY(mem_strdup(&copy, list, err));
    Status status = STATUS_OK;
    char *rest = copy;
    for (char *name; status == STATUS_OK && (name = text_field(&rest));)
        status = add_field(tree, said, name, err);
    free(copy);
    return status;
}
