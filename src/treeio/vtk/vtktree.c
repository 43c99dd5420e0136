/* Restores a tree that corcast wrote as a network.
 *
 * Points with the same id are one node, because each branch has its own points. Lines lead away
 * from the root, so each line gives its distal node a parent. The distal point of a line that
 * closes a loop has the id of a node that already has a parent; the id of the node with the link is
 * then the `link_id` of the point or of the line. Nodes are added by rising id, which was their
 * order in the tree that was written. */
#include "treeio/comments.h"
#include "treeio/formats.h"
#include "treeio/vtk/vtkmeaning.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* A node. All members are 0 if there is none of them. */
typedef struct VtkNode {
    uint32_t point, cell; /* 1 + the point and the cell that have the node's values */
    int32_t parent, link; /* id of the parent; id of the node that the link names */
} VtkNode;

/* The state of reading. */
typedef struct VtkTree {
    const VtkMeaning *meaning;
    const VtkData *data;
    const Graph *graph;
    TreeBuilder *builder;
    int32_t *id;   /* the ids of all nodes, rising; owned */
    VtkNode *node; /* per id; owned */
    size_t n;
    const VtkArray **column; /* the arrays that are columns, in the order of the builder: arrays of
                              * points, then of cells; owned */
    size_t n_columns, n_point_columns;
} VtkTree;

static Status read_remarks(const VtkTree *tree, Err *err)
{
    const VtkArray *remarks = vtk_find_metadata(tree->data);
    Status status = STATUS_OK;
    for (size_t at = 0; at < remarks->text_size && status == STATUS_OK;
         at += strlen(remarks->text + at) + 1)
        status = metadata_read_line(&tree->builder->meta, remarks->text + at, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", tree->builder->name);
    return status;
}

/* ---- nodes ----------------------------------------------------------------------------------- */

static int compare_ids(const void *a, const void *b)
{
    const int32_t *one = a, *other = b;
    return (*one > *other) - (*one < *other);
}

static int32_t id_at(const VtkTree *tree, size_t point)
{
    return (int32_t)tree->meaning->id->value[point];
}

/* Returns the index of the node with this id, which must exist. Ids without gaps are 1, 2, ... */
static size_t node_of(const VtkTree *tree, int32_t id)
{
    if ((size_t)tree->id[tree->n - 1] == tree->n)
        return (size_t)id - 1;
    const int32_t *found = bsearch(&id, tree->id, tree->n, sizeof id, compare_ids);
    return (size_t)(found - tree->id);
}

/* Returns the link_id of a point or of a cell, or 0 if it has none. */
static int32_t link_id(const VtkTree *tree, GraphElement of, size_t at)
{
    const VtkArray *array = tree->meaning->link[of];
    double id = array ? array->value[at] : 0;
    return id >= 1 && id <= TREE_MAX_ID && id == floor(id) ? (int32_t)id : 0;
}

/* Lists the ids, each once, by rising id. */
static Status list_ids(VtkTree *tree, Err *err)
{
    size_t points = tree->meaning->id->n, cells = tree->data->n_cells, n = 0;
    TRY(mem_calloc(&tree->id, 2 * points + cells, sizeof *tree->id, "nodes", err));
    for (size_t i = 0; i < points; i++)
        tree->id[n++] = id_at(tree, i);
    for (int of = GRAPH_POINTS; of <= GRAPH_LINES; of++)
        for (size_t i = 0; i < (of == GRAPH_POINTS ? points : cells); i++)
            if (link_id(tree, (GraphElement)of, i) > 0)
                tree->id[n++] = link_id(tree, (GraphElement)of, i);
    qsort(tree->id, n, sizeof *tree->id, compare_ids);
    for (size_t i = 0; i < n; i++)
        if (i == 0 || tree->id[i] != tree->id[i - 1])
            tree->id[tree->n++] = tree->id[i];
    return mem_calloc(&tree->node, tree->n, sizeof *tree->node, "nodes", err);
}

/* Finds the parents and links. The values of a node are those of the distal point of its line; the
 * values of a root are those of its first point. */
static Status find_parents(VtkTree *tree, Err *err)
{
    const VtkData *data = tree->data;
    for (size_t i = data->n_points; i-- > 0;)
        tree->node[node_of(tree, id_at(tree, i))].point = (uint32_t)i + 1;
    for (size_t i = 0, at = 0; i < data->n_lines; at = data->end[i++])
        for (size_t k = at + 1; k < data->end[i]; k++) {
            size_t from = (size_t)data->corner[k - 1], to = (size_t)data->corner[k];
            int32_t of_point = link_id(tree, GRAPH_POINTS, to);
            int32_t link = of_point ? of_point : link_id(tree, GRAPH_LINES, data->cell[i]);
            size_t index = node_of(tree, link ? link : id_at(tree, to));
            VtkNode *node = &tree->node[index];
            if (node->parent)
                return graph_blame(
                    tree->graph, GRAPH_LINES, data->cell[i],
                    err_set(err, STATUS_INPUT,
                            "it ends at node %d, as another line does; each node has one parent",
                            tree->id[index]),
                    err);
            *node = (VtkNode){.point = (uint32_t)to + 1,
                              .cell = (uint32_t)data->cell[i] + 1,
                              .parent = id_at(tree, from),
                              .link = link ? id_at(tree, to) : 0};
        }
    return STATUS_OK;
}

/* Returns the radius of a node. In files whose lines have radii, the point of a line that closes a
 * loop has the radius of another segment. */
static double radius_of(const VtkTree *tree, size_t node)
{
    const VtkArray *of_cells = tree->meaning->cell_radius;
    return tree->node[node].link && of_cells
               ? of_cells->value[tree->node[node].cell - 1]
               : tree->meaning->radius->value[tree->node[node].point - 1];
}

/* Adds a node with its link and its flow share. */
static Status add_node(const VtkTree *tree, size_t node, Err *err)
{
    const VtkMeaning *meaning = tree->meaning;
    size_t i = tree->node[node].point - 1;
    double type = meaning->type ? meaning->type->value[i] : TREE_VESSEL_TYPE;
    double share = meaning->flow_share ? meaning->flow_share->value[i] : 0;
    if (!(fabs(type) <= INT32_MAX))
        return err_set(err, STATUS_INPUT, "the type is %g; it must be an integer", type);
    const BuilderNode made = {.id = tree->id[node],
                              .parent = tree->node[node].parent ? tree->node[node].parent
                                                                : TREE_NO_PARENT,
                              .type = (int32_t)type,
                              .position = vtk_position(tree->data, i),
                              .radius_mm = radius_of(tree, node),
                              .record = i};
    TRY(builder_node(tree->builder, &made, err));
    if (tree->node[node].link)
        return builder_link(tree->builder, made.id, tree->node[node].link, i, err);
    return isnan(share) || share == 0 ? STATUS_OK
                                      : builder_share(tree->builder, made.id, share, i, err);
}

/* ---- columns --------------------------------------------------------------------------------- */

/* Adds the column of an array, whose title has an underscore if corcast has an array of its own of
 * this name. */
static Status add_column(VtkTree *tree, const VtkArray *array, Err *err)
{
    char *title = NULL;
    size_t number;
    TRY(mem_strdup(&title, array->name, err));
    const char *unit = csv_unit(title);
    if (vtk_is_own(title))
        title[strlen(title) - 1] = '\0';
    Status status = builder_column(tree->builder, title, unit, &number, err);
    free(title);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", tree->builder->name);
    tree->column[tree->n_columns++] = array;
    return status;
}

static Status list_columns(VtkTree *tree, Err *err)
{
    const VtkArrays *arrays = tree->data->arrays;
    TRY(mem_calloc(&tree->column, arrays[GRAPH_POINTS].n + arrays[GRAPH_LINES].n,
                   sizeof *tree->column, "columns", err));
    for (int of = GRAPH_POINTS; of <= GRAPH_LINES; of++) {
        for (size_t i = 0; i < arrays[of].n; i++)
            if (!vtk_has_meaning(tree->meaning, &arrays[of].array[i]) && arrays[of].array[i].value)
                TRY(add_column(tree, &arrays[of].array[i], err));
        if (of == GRAPH_POINTS)
            tree->n_point_columns = tree->n_columns;
    }
    return STATUS_OK;
}

static Status add_values(const VtkTree *tree, size_t node, Err *err)
{
    for (size_t k = 0; k < tree->n_columns; k++) {
        size_t at = k < tree->n_point_columns ? tree->node[node].point : tree->node[node].cell;
        double value = at ? tree->column[k]->value[at - 1] : (double)NAN;
        if (!isnan(value))
            TRY(builder_value(tree->builder, k, value, err));
    }
    return STATUS_OK;
}

Status vtk_to_tree(const VtkMeaning *meaning, const VtkData *data, Graph *graph, Err *err)
{
    VtkTree tree = {.meaning = meaning, .data = data, .graph = graph, .builder = graph->tree};
    Status status = STATUS_OK;
    tree.builder->record = graph->point_record;
    TRY_GOTO(read_remarks(&tree, err));
    TRY_GOTO(list_ids(&tree, err));
    TRY_GOTO(find_parents(&tree, err));
    TRY_GOTO(list_columns(&tree, err));
    for (size_t k = 0; k < tree.n; k++) {
        TRY_GOTO(builder_blame(tree.builder, tree.node[k].point - 1, add_node(&tree, k, err), err));
        TRY_GOTO(add_values(&tree, k, err));
    }
done:
    free(tree.id);
    free(tree.node);
    free(tree.column);
    return status;
}
