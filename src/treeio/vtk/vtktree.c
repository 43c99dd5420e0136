/* Points of one id are one node: the branches of a file of the program's own have points of their
 * own where they meet. Lines lead away from the root, so that each gives its distal node a parent,
 * in tables by id. Nodes are handed over in the order of their ids, which is that of the tree when
 * it was written. */
#include "treeio/comments.h"
#include "treeio/formats.h"
#include "treeio/vtk/vtkmeaning.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static Status read_remark(TreeBuilder *builder, const char *line, Err *err)
{
    Text comment = TEXT_INIT;
    text_printf(&comment, " %s", line);
    Status status = text_check(&comment, err);
    if (status == STATUS_OK)
        status = comment_read(&builder->meta, text_chars(&comment), err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", builder->name);
    text_release(&comment);
    return status;
}

static Status read_remarks(const VtkArray *remarks, TreeBuilder *builder, Err *err)
{
    for (size_t at = 0; at < remarks->text_size; at += strlen(remarks->text + at) + 1)
        TRY(read_remark(builder, remarks->text + at, err));
    return STATUS_OK;
}

static int by_id(const void *a, const void *b)
{
    const int32_t *one = a, *other = b;
    return (*one > *other) - (*one < *other);
}

/* The nodes by their ids. Per node: the point and the cell that have its values, + 1, and the id of
 * its parent; 0 for none. */
typedef struct Nodes {
    int32_t *id; /* rising */
    uint32_t *point, *cell;
    int32_t *parent;
    size_t n;
} Nodes;

static int32_t id_at(const VtkMeaning *meaning, size_t point)
{
    return (int32_t)meaning->id->value[point];
}

/* The node of an id that is there: ids without gaps begin at 1. */
static size_t node_of(const Nodes *nodes, int32_t id)
{
    if ((size_t)nodes->id[nodes->n - 1] == nodes->n)
        return (size_t)id - 1;
    const int32_t *found = bsearch(&id, nodes->id, nodes->n, sizeof id, by_id);
    return (size_t)(found - nodes->id);
}

/* A node's values are at the end of the line to it, a root's at its first point. */
static Status find_nodes(const VtkMeaning *meaning, const VtkData *data, const Graph *graph,
                         Nodes *nodes, Err *err)
{
    for (size_t i = data->n_points; i-- > 0;)
        nodes->point[node_of(nodes, id_at(meaning, i))] = (uint32_t)i + 1;
    for (size_t i = 0, at = 0; i < data->n_lines; at = data->end[i++])
        for (size_t k = at + 1; k < data->end[i]; k++) {
            size_t from = (size_t)data->corner[k - 1], to = (size_t)data->corner[k];
            size_t node = node_of(nodes, id_at(meaning, to));
            if (nodes->parent[node])
                return graph_blame(graph, GRAPH_LINES, data->cell[i],
                                   err_set(err, STATUS_INPUT,
                                           "it leads to node %d, as another line does",
                                           nodes->id[node]),
                                   err);
            nodes->parent[node] = id_at(meaning, from);
            nodes->point[node] = (uint32_t)to + 1;
            nodes->cell[node] = (uint32_t)data->cell[i] + 1;
        }
    return STATUS_OK;
}

static Status make_nodes(const VtkMeaning *meaning, const VtkData *data, const Graph *graph,
                         Nodes *nodes, Err *err)
{
    size_t points = meaning->id->n;
    TRY(mem_calloc(&nodes->id, points, sizeof *nodes->id, "nodes", err));
    for (size_t i = 0; i < points; i++)
        nodes->id[i] = id_at(meaning, i);
    qsort(nodes->id, points, sizeof *nodes->id, by_id);
    for (size_t i = 0; i < points; i++)
        if (i == 0 || nodes->id[i] != nodes->id[i - 1])
            nodes->id[nodes->n++] = nodes->id[i];
    TRY(mem_calloc(&nodes->point, nodes->n, sizeof *nodes->point, "nodes", err));
    TRY(mem_calloc(&nodes->cell, nodes->n, sizeof *nodes->cell, "nodes", err));
    TRY(mem_calloc(&nodes->parent, nodes->n, sizeof *nodes->parent, "nodes", err));
    return find_nodes(meaning, data, graph, nodes, err);
}

static Status add_node(const VtkMeaning *meaning, const VtkData *data, TreeBuilder *builder,
                       const Nodes *nodes, size_t at, Err *err)
{
    size_t i = nodes->point[at] - 1;
    double type = meaning->type ? meaning->type->value[i] : TREE_VESSEL_TYPE;
    double share = meaning->share ? meaning->share->value[i] : 0;
    if (!(fabs(type) <= INT32_MAX))
        return err_set(err, STATUS_INPUT, "the type is %g, which is no whole number", type);
    const BuilderNode node = {.id = nodes->id[at],
                              .parent = nodes->parent[at] ? nodes->parent[at] : TREE_NO_PARENT,
                              .type = (int32_t)type,
                              .position = vtk_position(data, i),
                              .radius_mm = meaning->radius->value[i],
                              .record = i};
    TRY(builder_node(builder, &node, err));
    return isnan(share) || share == 0 ? STATUS_OK : builder_share(builder, node.id, share, i, err);
}

/* The arrays that are columns, those of points first; the builder has them in this order. */
typedef struct Columns {
    const VtkArray **array;
    size_t n, of_points;
} Columns;

static Status add_column_of(const VtkArray *array, TreeBuilder *builder, Err *err)
{
    char *title = NULL;
    size_t number;
    TRY(mem_strdup(&title, array->name, err));
    const char *unit = csv_unit(title);
    if (vtk_is_own(title))
        title[strlen(title) - 1] = '\0';
    Status status = builder_column(builder, title, unit, &number, err);
    free(title);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", builder->name);
    return status;
}

static Status list_columns(const VtkMeaning *meaning, const VtkArrays *arrays, TreeBuilder *builder,
                           Columns *columns, Err *err)
{
    for (size_t i = 0; i < arrays->n; i++) {
        const VtkArray *array = &arrays->array[i];
        if (vtk_is_used(meaning, array) || !array->value)
            continue;
        TRY(add_column_of(array, builder, err));
        columns->array[columns->n++] = array;
    }
    return STATUS_OK;
}

static Status add_values_of(const Columns *columns, const Nodes *nodes, size_t node,
                            TreeBuilder *builder, Err *err)
{
    for (size_t k = 0; k < columns->n; k++) {
        size_t at = k < columns->of_points ? nodes->point[node] : nodes->cell[node];
        double value = at ? columns->array[k]->value[at - 1] : (double)NAN;
        if (!isnan(value))
            TRY(builder_value(builder, k, value, err));
    }
    return STATUS_OK;
}

static Status add_nodes(const VtkMeaning *meaning, const VtkData *data, TreeBuilder *builder,
                        const Nodes *nodes, Err *err)
{
    Columns columns = {0};
    Status status = STATUS_OK;
    TRY(mem_calloc(&columns.array, data->of_points.n + data->of_cells.n, sizeof(VtkArray *),
                   "columns", err));
    TRY_GOTO(list_columns(meaning, &data->of_points, builder, &columns, err));
    columns.of_points = columns.n;
    TRY_GOTO(list_columns(meaning, &data->of_cells, builder, &columns, err));
    for (size_t k = 0; k < nodes->n; k++) {
        status = add_node(meaning, data, builder, nodes, k, err);
        TRY_GOTO(builder_blame(builder, nodes->point[k] - 1, status, err));
        TRY_GOTO(add_values_of(&columns, nodes, k, builder, err));
    }
done:
    free(columns.array);
    return status;
}

Status vtk_to_tree(const VtkMeaning *meaning, const VtkData *data, Graph *graph, Err *err)
{
    Nodes nodes = {0};
    TreeBuilder *builder = graph->tree;
    builder->record = graph->point_record;
    TRY(read_remarks(vtk_find_known(data), builder, err));
    Status status = make_nodes(meaning, data, graph, &nodes, err);
    if (status == STATUS_OK)
        status = add_nodes(meaning, data, builder, &nodes, err);
    free(nodes.id);
    free(nodes.point);
    free(nodes.cell);
    free(nodes.parent);
    return status;
}
