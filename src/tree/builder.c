/* Builds a tree from the rows of a file, which may be in any order.
 *
 * Rows, the nodes in the order of the file, are stored until the file is complete. An index of ids
 * then resolves the parents, and each row gets an index in the tree, with parents first.
 *
 * To place a row, a walk towards the root marks the ancestors that have no index yet. The topmost
 * of them gets the next index, then the one below it, and so on down to the row itself. Rows whose
 * parents come first therefore keep their order. A walk that meets its own mark has found a cycle.
 * The walks visit each row at most twice.
 *
 * Two shortcuts save memory: rows that are already in order become the tree without a copy, and
 * rows with the ids 1, 2, ... and parents first, as in most large files, need no index of ids. */
#include "tree/builder.h"

#include "tree/idindex.h"
#include "tree/tree.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct BuilderColumn {
    char *name, *unit;
    double *value; /* values of the first `n` rows */
    size_t n, capacity;
} BuilderColumn;

typedef struct BuilderShare {
    int32_t id;
    double share;
    size_t record;
} BuilderShare;

typedef struct BuilderPair {
    int32_t id[2];
    size_t record;
} BuilderPair;

enum { NO_ROW = -1 };

static const char share_name[] = "flow_share", link_name[] = "a link";

void builder_release(TreeBuilder *builder)
{
    for (size_t k = 0; k < builder->n_columns; k++) {
        free(builder->column[k].name);
        free(builder->column[k].unit);
        free(builder->column[k].value);
    }
    free(builder->id);
    free(builder->type);
    free(builder->parent);
    free(builder->position);
    free(builder->radius_mm);
    free(builder->row_record);
    free(builder->column);
    ARRAY_RELEASE(&builder->shares);
    ARRAY_RELEASE(&builder->pairs);
    ARRAY_RELEASE(&builder->links);
    meta_release(&builder->meta);
    *builder = (TreeBuilder){0};
}

Status builder_blame(const TreeBuilder *builder, size_t record, Status status, Err *err)
{
    if (status == STATUS_INPUT && builder->record)
        err_prefix(err, "%s: %s %zu: ", builder->name, builder->record, record);
    else if (status == STATUS_INPUT)
        err_prefix(err, "%s:%zu: ", builder->name, record);
    return status;
}

static bool is_id(int64_t id)
{
    return id >= 1 && id <= TREE_MAX_ID;
}

static Status unknown_parent(int64_t id, Err *err)
{
    return err_set(
        err, STATUS_INPUT,
        "the parent is %lld, which is not the id of a node; it must be the id of a node, or %d "
        "for a root",
        (long long)id, TREE_NO_PARENT);
}

/* Refuses an id that `what` (a pair, a link or a flow share) refers to. */
static Status unknown_node(const char *what, int64_t id, Err *err)
{
    return err_set(err, STATUS_INPUT, "%s names the node %lld, which is not the id of a node", what,
                   (long long)id);
}

static Status check_node(const BuilderNode *node, Err *err)
{
    if (!is_id(node->id))
        return err_set(err, STATUS_INPUT, "the id is '%lld'; it must be an integer from 1 to %d",
                       (long long)node->id, TREE_MAX_ID);
    if (node->parent != TREE_NO_PARENT && !is_id(node->parent))
        return unknown_parent(node->parent, err);
    if (!vec3_finite(node->position))
        return err_set(err, STATUS_INPUT, "the position is not finite");
    return STATUS_OK;
}

/* Accepts a missing radius, NAN, only if the options replace it after the tree was built. */
static Status check_radius(const ReadOptions *options, double *radius_mm, Err *err)
{
    bool is_filled = options && (options->repair_radii || options->radius_mm > 0);
    if (isnan(*radius_mm) && !is_filled)
        return reading_refuse_radius("radius", "nan", err);
    return reading_radius(options, radius_mm, err);
}

/* Reserves one more row in every array. */
static Status reserve_row(TreeBuilder *builder, Err *err)
{
    const struct {
        void *array;
        size_t size;
    } arrays[] = {
        {&builder->id, sizeof *builder->id},
        {&builder->type, sizeof *builder->type},
        {&builder->parent, sizeof *builder->parent},
        {&builder->position, sizeof *builder->position},
        {&builder->radius_mm, sizeof *builder->radius_mm},
        {&builder->row_record, sizeof *builder->row_record},
    };
    size_t capacity = builder->capacity;
    for (size_t k = 0; builder->n == builder->capacity && k < sizeof arrays / sizeof *arrays; k++) {
        capacity = builder->capacity;
        TRY(mem_reserve(arrays[k].array, &capacity, builder->n + 1, arrays[k].size, "nodes", err));
    }
    builder->capacity = capacity;
    return STATUS_OK;
}

Status builder_node(TreeBuilder *builder, const BuilderNode *node, Err *err)
{
    double radius_mm = node->radius_mm;
    TRY(check_node(node, err));
    TRY(check_radius(builder->options, &radius_mm, err));
    TRY(reserve_row(builder, err));
    size_t i = builder->n++;
    builder->id[i] = (int32_t)node->id;
    builder->type[i] = node->type;
    builder->parent[i] = (int32_t)node->parent;
    builder->position[i] = node->position;
    builder->radius_mm[i] = radius_mm;
    builder->row_record[i] = node->record;
    return STATUS_OK;
}

Status builder_column(TreeBuilder *builder, const char *name, const char *unit, size_t *column,
                      Err *err)
{
    if (!*name)
        return err_set(err, STATUS_INPUT, "a column has no name");
    if (builder->n_columns == BUILDER_MAX_COLUMNS)
        return err_set(err, STATUS_INPUT, "there are more than %d columns", BUILDER_MAX_COLUMNS);
    for (size_t k = 0; k < builder->n_columns; k++)
        if (strcmp(builder->column[k].name, name) == 0)
            return err_set(err, STATUS_INPUT, "two columns are called '%.40s'", name);
    BuilderColumn made = {0};
    Status status = STATUS_OK;
    TRY_GOTO(mem_strdup(&made.name, name, err));
    TRY_GOTO(mem_strdup(&made.unit, unit, err));
    TRY_GOTO(mem_reserve(&builder->column, &builder->columns_capacity, builder->n_columns + 1,
                         sizeof made, "columns", err));
    *column = builder->n_columns;
    builder->column[builder->n_columns++] = made;
    return STATUS_OK;
done:
    free(made.name);
    free(made.unit);
    return status;
}

/* Sets the values of a column that are missing in the first `n` rows to NAN. */
static Status fill_column(const TreeBuilder *builder, BuilderColumn *column, size_t n, Err *err)
{
    TRY(mem_reserve(&column->value, &column->capacity, builder->n, sizeof *column->value,
                    "values of a column", err));
    while (column->n < n)
        column->value[column->n++] = (double)NAN;
    return STATUS_OK;
}

Status builder_value(TreeBuilder *builder, size_t column_number, double value, Err *err)
{
    BuilderColumn *column = &builder->column[column_number];
    TRY(fill_column(builder, column, builder->n, err));
    column->value[builder->n - 1] = isfinite(value) ? value : (double)NAN;
    return STATUS_OK;
}

Status builder_share(TreeBuilder *builder, int64_t id, double share, size_t record, Err *err)
{
    char number[NUMBER_TEXT_SIZE];
    if (!(share > 0) || !isfinite(share))
        return err_set(err, STATUS_INPUT,
                       "the flow share is '%s'; it must be a finite number above 0",
                       number_text(share, number));
    if (!is_id(id))
        return unknown_node(share_name, id, err);
    return ARRAY_PUSH(&builder->shares, "flow shares", err,
                      (BuilderShare){(int32_t)id, share, record});
}

Status builder_pair(TreeBuilder *builder, int64_t id, int64_t other, size_t record, Err *err)
{
    if (!is_id(id) || !is_id(other))
        return unknown_node(tree_pairs_name, is_id(id) ? other : id, err);
    return ARRAY_PUSH(&builder->pairs, "pairs", err,
                      (BuilderPair){{(int32_t)id, (int32_t)other}, record});
}

Status builder_link(TreeBuilder *builder, int64_t id, int64_t other, size_t record, Err *err)
{
    if (!is_id(id) || !is_id(other))
        return unknown_node(link_name, is_id(id) ? other : id, err);
    return ARRAY_PUSH(&builder->links, "links", err,
                      (BuilderPair){{(int32_t)id, (int32_t)other}, record});
}

/* Indexes the rows by their ids, which must differ. */
static Status index_ids(const TreeBuilder *builder, IdIndex *index, Err *err)
{
    TRY(idindex_make(index, builder->id, builder->n, err));
    for (size_t i = 0; i < builder->n && index->has_duplicates; i++) {
        size_t first = idindex_find(index, builder->id[i]) - 1;
        if (first != i)
            return builder_blame(builder, builder->row_record[i],
                                 err_set(err, STATUS_INPUT,
                                         "the id %d is already that of %s %zu; every node needs "
                                         "its own",
                                         builder->id[i], builder->record ? builder->record : "line",
                                         builder->row_record[first]),
                                 err);
    }
    return STATUS_OK;
}

/* Returns the row of an id, or NO_ROW. An empty index means that the ids are 1, 2, ... in order. */
static int32_t row_of(const TreeBuilder *builder, const IdIndex *index, int32_t id)
{
    if (index->n > 0)
        return (int32_t)idindex_find(index, id) - 1;
    return id > (int32_t)builder->n ? NO_ROW : id - 1;
}

/* Returns true if the rows have the ids 1, 2, ..., and each parent comes before its children. */
static bool are_numbered(const TreeBuilder *builder)
{
    for (size_t i = 0; i < builder->n; i++)
        if (builder->id[i] != (int32_t)i + 1 || builder->parent[i] > (int32_t)i)
            return false;
    return true;
}

/* Replaces the id of each row's parent by the parent's row. */
static Status find_parents(TreeBuilder *builder, const IdIndex *index, Err *err)
{
    for (size_t i = 0; i < builder->n; i++) {
        int32_t id = builder->parent[i];
        if (id == TREE_NO_PARENT)
            continue;
        builder->parent[i] = row_of(builder, index, id);
        if (builder->parent[i] == NO_ROW)
            return builder_blame(builder, builder->row_record[i], unknown_parent(id, err), err);
    }
    return STATUS_OK;
}

enum { UNPLACED = -1, WALKED = -2 };

/* Assigns the next indices of the tree, from *placed, to the unplaced ancestors of row `start`,
 * topmost first, and then to the row itself. */
static Status place_with_ancestors(const TreeBuilder *builder, int32_t start, int32_t *place,
                                   int32_t *placed, Err *err)
{
    const int32_t *parent = builder->parent;
    int32_t length = 0, at = start;
    for (; at != TREE_NO_PARENT && place[at] == UNPLACED; at = parent[at]) {
        place[at] = WALKED;
        length++;
    }
    if (at != TREE_NO_PARENT && place[at] == WALKED)
        return builder_blame(builder, builder->row_record[at],
                             err_set(err, STATUS_INPUT,
                                     "node %d is its own %s; parents must lead to a root, whose "
                                     "parent is %d",
                                     builder->id[at], parent[at] == at ? "parent" : "ancestor",
                                     TREE_NO_PARENT),
                             err);
    at = start;
    for (int32_t below = length; below > 0; at = parent[at])
        place[at] = *placed + --below;
    *placed += length;
    return STATUS_OK;
}

/* Computes each row's index in the tree. The caller frees *place. */
static Status place_rows(const TreeBuilder *builder, int32_t **place, Err *err)
{
    int32_t *made = NULL, placed = 0;
    Status status = STATUS_OK;
    TRY(mem_calloc(&made, builder->n, sizeof *made, "places of nodes", err));
    for (size_t i = 0; i < builder->n; i++)
        made[i] = UNPLACED;
    for (size_t i = 0; i < builder->n; i++)
        TRY_GOTO(place_with_ancestors(builder, (int32_t)i, made, &placed, err));
    *place = made;
done:
    if (status != STATUS_OK)
        free(made);
    return status;
}

/* Returns the index of a row in the tree; if `place` is NULL, rows keep their order. */
static size_t place_of(const int32_t *place, size_t row)
{
    return place ? (size_t)place[row] : row;
}

static bool are_in_order(const TreeBuilder *builder, const int32_t *place)
{
    for (size_t i = 0; i < builder->n && place; i++)
        if (place[i] != (int32_t)i)
            return false;
    return true;
}

/* Moves the rows' arrays to the tree. The rows must be in the order of the tree. */
static void move_nodes(TreeBuilder *builder, Tree *tree)
{
    *tree = (Tree){.n = builder->n,
                   .id = builder->id,
                   .type = builder->type,
                   .parent = builder->parent,
                   .position = builder->position,
                   .radius_mm = builder->radius_mm};
    builder->id = builder->type = builder->parent = NULL;
    builder->position = NULL;
    builder->radius_mm = NULL;
}

/* Copies the rows to their places in the tree. */
static Status copy_nodes(const TreeBuilder *builder, const int32_t *place, Tree *tree, Err *err)
{
    TRY(tree_init(tree, builder->n, err));
    for (size_t i = 0; i < builder->n; i++) {
        int32_t at = place[i], parent = builder->parent[i];
        tree->id[at] = builder->id[i];
        tree->type[at] = builder->type[i];
        tree->parent[at] = parent == TREE_NO_PARENT ? TREE_NO_PARENT : place[parent];
        tree->position[at] = builder->position[i];
        tree->radius_mm[at] = builder->radius_mm[i];
    }
    return STATUS_OK;
}

/* Copies the values of the columns. Rows without a value get NAN. */
static Status fill_columns(const TreeBuilder *builder, const int32_t *place, Tree *tree, Err *err)
{
    for (size_t k = 0; k < builder->n_columns; k++) {
        BuilderColumn *column = &builder->column[k];
        double *value;
        TRY(fill_column(builder, column, builder->n, err));
        TRY(tree_add_column(tree, column->name, column->unit, &value, err));
        for (size_t i = 0; i < builder->n; i++)
            value[place_of(place, i)] = column->value[i];
    }
    return STATUS_OK;
}

/* Checks that the key terminal_flow agrees with the flow shares. */
static Status check_terminal_flow(const TreeBuilder *builder, Err *err)
{
    bool known = builder->meta.known[META_TERMINAL_FLOW];
    TerminalFlow flow = (TerminalFlow)builder->meta.number[META_TERMINAL_FLOW];
    if (!known || (flow != TERMINAL_FLOW_EQUAL) == (builder->shares.n > 0))
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "%s: terminal_flow is %s, but there are %sflow shares",
                   builder->name, terminal_flow_names[flow], builder->shares.n > 0 ? "" : "no ");
}

/* The rows, and how their nodes are found in the tree. */
typedef struct PlacedRows {
    const TreeBuilder *builder;
    IdIndex index;  /* of the ids; empty: the ids are 1, 2, ... in order */
    int32_t *place; /* per row: its index in the tree; NULL: rows keep their order. Owned */
} PlacedRows;

/* Finds the index in the tree of the node with this id. `what` refers to the node. */
static Status find_node(const PlacedRows *rows, const char *what, int32_t id, size_t *at, Err *err)
{
    int32_t row = row_of(rows->builder, &rows->index, id);
    if (row == NO_ROW)
        return unknown_node(what, id, err);
    *at = place_of(rows->place, (size_t)row);
    return STATUS_OK;
}

/* Sets one flow share. A share is above 0, so a node whose share is not 0 was stated before. */
static Status fill_share(const PlacedRows *rows, const BuilderShare *stated, Tree *tree, Err *err)
{
    size_t at = 0;
    TRY(find_node(rows, share_name, stated->id, &at, err));
    if (tree->flow_share[at] > 0)
        return err_set(err, STATUS_INPUT, "the flow share of node %d is stated twice", stated->id);
    tree->flow_share[at] = stated->share;
    return STATUS_OK;
}

/* Sets all flow shares of the tree. */
static Status fill_shares(const PlacedRows *rows, Tree *tree, Err *err)
{
    const TreeBuilder *builder = rows->builder;
    TRY(check_terminal_flow(builder, err));
    if (builder->shares.n > 0)
        TRY(tree_add_flow_shares(tree, err));
    for (size_t k = 0; k < builder->shares.n; k++) {
        const BuilderShare *stated = &builder->shares.items[k];
        TRY(builder_blame(builder, stated->record, fill_share(rows, stated, tree, err), err));
    }
    return STATUS_OK;
}

/* Writes the number of pair k, k + 1, to its two nodes. `number` has NAN at nodes without a pair.
 */
static Status fill_pair(const PlacedRows *rows, size_t k, double *number, Err *err)
{
    for (int side = 0; side < 2; side++) {
        int32_t id = rows->builder->pairs.items[k].id[side];
        size_t at = 0;
        TRY(find_node(rows, tree_pairs_name, id, &at, err));
        if (!isnan(number[at]))
            return err_set(err, STATUS_INPUT, "node %d is of a pair twice", id);
        number[at] = (double)(k + 1);
    }
    return STATUS_OK;
}

static Status fill_pairs(const PlacedRows *rows, Tree *tree, Err *err)
{
    const TreeBuilder *builder = rows->builder;
    double *number = NULL;
    if (builder->pairs.n > 0)
        TRY(tree_set_column(tree, tree_pairs_name, "", &number, err));
    for (size_t k = 0; k < builder->pairs.n; k++)
        TRY(builder_blame(builder, builder->pairs.items[k].record, fill_pair(rows, k, number, err),
                          err));
    return STATUS_OK;
}

/* Sets the link of one node. */
static Status fill_link(const PlacedRows *rows, const BuilderPair *link, Tree *tree, Err *err)
{
    size_t at[2] = {0};
    for (int side = 0; side < 2; side++)
        TRY(find_node(rows, link_name, link->id[side], &at[side], err));
    if (tree_has_link(tree, at[0]))
        return err_set(err, STATUS_INPUT, "node %d has two links", link->id[0]);
    tree->link[at[0]] = (int32_t)at[1];
    tree->position[at[0]] = tree->position[at[1]];
    return STATUS_OK;
}

/* Sets all links of the tree. */
static Status fill_links(const PlacedRows *rows, Tree *tree, Err *err)
{
    const TreeBuilder *builder = rows->builder;
    if (builder->links.n == 0)
        return STATUS_OK;
    TRY(tree_add_links(tree, err));
    for (size_t k = 0; k < builder->links.n; k++) {
        const BuilderPair *link = &builder->links.items[k];
        TRY(builder_blame(builder, link->record, fill_link(rows, link, tree, err), err));
    }
    Status status = tree_check_links(tree, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", builder->name);
    return status;
}

Status builder_build(TreeBuilder *builder, Tree *out, Err *err)
{
    if (builder->n == 0)
        return err_set(err, STATUS_INPUT, "%s: the file has no nodes; a tree has at least one",
                       builder->name);
    PlacedRows rows = {.builder = builder};
    Tree tree = {0};
    Status status = STATUS_OK;
    const bool numbered = are_numbered(builder);
    if (!numbered)
        TRY_GOTO(index_ids(builder, &rows.index, err));
    TRY_GOTO(find_parents(builder, &rows.index, err));
    if (!numbered)
        TRY_GOTO(place_rows(builder, &rows.place, err));
    if (are_in_order(builder, rows.place))
        move_nodes(builder, &tree);
    else
        TRY_GOTO(copy_nodes(builder, rows.place, &tree, err));
    TRY_GOTO(fill_columns(builder, rows.place, &tree, err));
    TRY_GOTO(fill_shares(&rows, &tree, err));
    TRY_GOTO(fill_pairs(&rows, &tree, err));
    TRY_GOTO(fill_links(&rows, &tree, err));
    tree.meta = builder->meta;
    builder->meta = (TreeMeta){0};
    *out = tree;
done:
    if (status != STATUS_OK)
        tree_release(&tree);
    idindex_release(&rows.index);
    free(rows.place);
    return status;
}
