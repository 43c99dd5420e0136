/* Implements the trees of the library: reads them from files, bytes and arrays, gives access to
 * their arrays and fields, and writes them. */
#include "api/request.h"
#include "api/sink.h"

#include "derive/derive.h"
#include "job/tree/blood.h"
#include "options/output.h"
#include "options/reading.h"
#include "treeio/treeio.h"
#include <stdlib.h>
#include <string.h>

/* The commands whose options may be passed for reading a tree. */
static const char of_reading[] =
    "info convert grow refine certify render scene export diagram verify";

Status tree_handle_new(Tree *tree, const char *name, corcast_tree **out, Err *err)
{
    corcast_tree *made = NULL;
    char *copy = NULL;
    if (name)
        TRY(mem_strdup(&copy, name, err));
    Status status = handle_new(&made, HANDLE_TREE, sizeof *made, err);
    if (status != STATUS_OK) {
        free(copy);
        return status;
    }
    made->tree = *tree;
    made->name = copy;
    *tree = (Tree){0};
    *out = made;
    return STATUS_OK;
}

/* Makes a handle of a tree if `status` is STATUS_OK; otherwise releases the tree. Returns the first
 * error. */
static Status hand_over(Status status, Tree *tree, const char *name, corcast_tree **out, Err *err)
{
    TRY_GOTO(status);
    status = tree_handle_new(tree, name, out, err);
done:
    tree_release(tree);
    return status;
}

/* ---- reading --------------------------------------------------------------------------------- */

/* A file on disk or in memory. */
typedef struct TreeFile {
    const char *path;
    const MemoryFile *bytes; /* NULL: the file is on disk */
} TreeFile;

/* Reads a tree with the input options of a request, as commands do. */
static Status read_file(const Parsed *parsed, const TreeFile *file, Tree *tree, Err *err)
{
    return file->bytes ? reading_tree_bytes(parsed, file->bytes, tree, err)
                       : reading_tree(parsed, file->path, tree, NULL, err);
}

static Status read_tree(const TreeFile *file, const corcast_options *options, corcast_tree **out,
                        const Call *call, Err *err)
{
    const RequestArguments form = {
        .commands = of_reading, .options = options, .operand = file->path};
    Request request = {0};
    Tree tree = {0};
    Status status = STATUS_OK;
    if (file->bytes)
        TRY(argument_check(file->bytes->bytes, "bytes", err));
    TRY(path_check(file->path, file->bytes ? "name" : "path", err));
    TRY(argument_check(out, "out", err));
    TRY_GOTO(request_open(&request, &form, call, err));
    status = read_file(&request.parsed, file, &tree, err);
done:
    status = request_close(&request, status, err);
    return hand_over(status, &tree, file->path, out, err);
}

int corcast_tree_read(const char *path, const corcast_options *options, corcast_tree **out,
                      corcast_error *error)
{
    Call call = call_begin(error);
    const TreeFile file = {.path = path};
    return call_end(&call, read_tree(&file, options, out, &call, &call.err));
}

int corcast_tree_read_bytes(const void *bytes, size_t size, const char *name,
                            const corcast_options *options, corcast_tree **out,
                            corcast_error *error)
{
    Call call = call_begin(error);
    const MemoryFile in_memory = {.name = name, .bytes = bytes, .size = size};
    const TreeFile file = {.path = name, .bytes = &in_memory};
    return call_end(&call, read_tree(&file, options, out, &call, &call.err));
}

/* ---- arrays ---------------------------------------------------------------------------------- */

static Status fill_tree(const corcast_nodes *nodes, Tree *tree, Err *err)
{
    TRY(tree_init(tree, nodes->n, err));
    for (size_t i = 0; i < nodes->n; i++) {
        const double *at = &nodes->positions[3 * i];
        tree->id[i] = nodes->ids ? nodes->ids[i] : (int32_t)(i + 1);
        tree->type[i] = TREE_VESSEL_TYPE;
        tree->parent[i] = nodes->parents[i];
        tree->position[i] = vec3(at[0], at[1], at[2]);
        tree->radius_mm[i] = nodes->radii[i];
    }
    return tree_check(tree, err);
}

static Status from_nodes(const corcast_nodes *nodes, corcast_tree **out, Err *err)
{
    Tree tree = {0};
    TRY(argument_check(nodes, "nodes", err));
    TRY(argument_check(out, "out", err));
    TRY(argument_check(nodes->positions, "nodes->positions", err));
    TRY(argument_check(nodes->radii, "nodes->radii", err));
    TRY(argument_check(nodes->parents, "nodes->parents", err));
    if (nodes->n == 0)
        return err_set(err, STATUS_USAGE, "nodes->n is 0; a tree has 1 node or more");
    return hand_over(fill_tree(nodes, &tree, err), &tree, NULL, out, err);
}

int corcast_tree_from_nodes(const corcast_nodes *nodes, corcast_tree **out, corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, from_nodes(nodes, out, &call.err));
}

static Status copy_tree(const corcast_tree *tree, corcast_tree **out, Err *err)
{
    Tree copy = {0};
    TRY(handle_check(tree, HANDLE_TREE, "tree", err));
    TRY(argument_check(out, "out", err));
    return hand_over(tree_prune_copy(&tree->tree, 0, &copy, err), &copy, tree->name, out, err);
}

int corcast_tree_copy(const corcast_tree *tree, corcast_tree **out, corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, copy_tree(tree, out, &call.err));
}

_Static_assert(sizeof(Vec3) == 3 * sizeof(double), "positions are three doubles per node");

static Status get_nodes(const corcast_tree *tree, corcast_nodes *nodes, Err *err)
{
    TRY(handle_check(tree, HANDLE_TREE, "tree", err));
    TRY(argument_check(nodes, "nodes", err));
    *nodes = (corcast_nodes){.n = tree->tree.n,
                             .positions = &tree->tree.position->x,
                             .radii = tree->tree.radius_mm,
                             .parents = tree->tree.parent,
                             .ids = tree->tree.id};
    return STATUS_OK;
}

int corcast_tree_nodes(const corcast_tree *tree, corcast_nodes *nodes, corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, get_nodes(tree, nodes, &call.err));
}

/* ---- fields ---------------------------------------------------------------------------------- */

static void release_field(TreeField *field)
{
    free(field->name);
    free(field->unit);
    free(field->value);
    *field = (TreeField){0};
}

/* Frees the fields of a tree. */
static void forget_fields(corcast_tree *tree)
{
    for (size_t i = 0; i < tree->fields.n; i++)
        release_field(&tree->fields.items[i]);
    ARRAY_RELEASE(&tree->fields);
}

/* Keeps a field until the tree changes, in place of an earlier one of its name. */
static Status keep_field(corcast_tree *tree, TreeField *field, Err *err)
{
    for (size_t i = 0; i < tree->fields.n; i++)
        if (strcmp(tree->fields.items[i].name, field->name) == 0) {
            release_field(&tree->fields.items[i]);
            tree->fields.items[i] = *field;
            return STATUS_OK;
        }
    return ARRAY_PUSH(&tree->fields, "fields", err, *field);
}

void tree_handle_replace(corcast_tree *tree, Tree *made)
{
    forget_fields(tree);
    tree_release(&tree->tree);
    tree->tree = *made;
    *made = (Tree){0};
}

/* Computes a field of a copy of the tree, because options may divide its flow differently. */
static Status derive(const Parsed *parsed, const char *name, TreeField *out, Err *err)
{
    const Setting *row = parsed_find(parsed, "q-perf", strlen("q-perf"));
    const BloodOptions *blood = (const void *)row->base; /* what the table of q-perf sets */
    const TreeMeta said = blood_specified(blood);
    Tree copy = {0};
    Field field = {0};
    Status status = STATUS_OK;
    TRY_GOTO(reading_tree(parsed, parsed->operands[0], &copy, NULL, err));
    TRY_GOTO(blood_apply(blood, parsed, &copy, err));
    TRY_GOTO(derive_field(&copy, &said, name, &field, err));
    TRY_GOTO(mem_strdup(&out->name, name, err));
    TRY_GOTO(mem_strdup(&out->unit, field.unit, err));
    out->value = field.value;
    field.value = NULL;
done:
    field_release(&field);
    tree_release(&copy);
    return status;
}

static Status get_field(corcast_tree *tree, const char *name, const corcast_options *options,
                        TreeField *field, Call *call)
{
    Err *err = &call->err;
    const RequestArguments form = {.commands = "info", .options = options, .tree = tree};
    Request request = {0};
    Status status = STATUS_OK;
    TRY(handle_check(tree, HANDLE_TREE, "tree", err));
    TRY(argument_check(name, "name", err));
    TRY_GOTO(request_open(&request, &form, call, err));
    TRY_GOTO(derive(&request.parsed, name, field, err));
    status = keep_field(tree, field, err);
done:
    if (status != STATUS_OK)
        release_field(field);
    return request_close(&request, status, err);
}

int corcast_tree_field(corcast_tree *tree, const char *name, const corcast_options *options,
                       const double **values, const char **unit, corcast_error *error)
{
    Call call = call_begin(error);
    TreeField field = {0};
    Status status = argument_check(values, "values", &call.err);
    if (status != STATUS_OK)
        return call_end(&call, status);
    status = get_field(tree, name, options, &field, &call);
    if (status != STATUS_OK)
        return call_end(&call, status);
    *values = field.value;
    if (unit)
        *unit = field.unit;
    return call_end(&call, STATUS_OK);
}

/* ---- writing --------------------------------------------------------------------------------- */

static Status write_tree(const corcast_tree *tree, const char *path, Err *err)
{
    TRY(handle_check(tree, HANDLE_TREE, "tree", err));
    TRY(path_check(path, "path", err));
    return tree_write(&tree->tree, path, err);
}

int corcast_tree_write(const corcast_tree *tree, const char *path, corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, write_tree(tree, path, &call.err));
}

static Status write_bytes(const corcast_tree *tree, const char *name, const Sink *sink, Err *err)
{
    Text text = TEXT_INIT;
    Status status = STATUS_OK;
    TRY(handle_check(tree, HANDLE_TREE, "tree", err));
    TRY(path_check(name, "name", err));
    TRY_GOTO(tree_write_bytes(&tree->tree, name, &text, err));
    status = sink_give(sink, file_name(name), text_chars(&text), text.length, err);
done:
    text_release(&text);
    return status;
}

int corcast_tree_write_bytes(const corcast_tree *tree, const char *name, corcast_sink *sink,
                             void *user, corcast_error *error)
{
    Call call = call_begin(error);
    const Sink to = {sink, user, call.caller_locale};
    return call_end(&call, write_bytes(tree, name, &to, &call.err));
}

void corcast_tree_free(corcast_tree *tree)
{
    if (!handle_is(tree, HANDLE_TREE))
        return;
    tree_release(&tree->tree);
    free(tree->name);
    forget_fields(tree);
    handle_free(tree);
}
