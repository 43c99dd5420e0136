/* Converts the arbor of refinement back to a Tree.
 *
 * Radii are r = q g rho [law.h]: rho is in the arbor's sums, and g is multiplied from the root
 * down. Both only add and multiply positive numbers, so every radius is exact to a few units in the
 * last place. */
#include "grow/refine/refine_arbor.h"

#include <float.h>
#include <stdlib.h>

/* The state of writing the arbor into `tree`; `was` is the tree that the arbor was made of. */
typedef struct ResultWriter {
    const Tree *was;
    const Arbor *arbor;
    Tree *tree;
    int32_t *place; /* per node of the arbor: its index in the tree; owned, like `gauge` */
    double *gauge;  /* per node of the arbor [law.h] */
} ResultWriter;

/* Writes node i of the arbor as node `at` of the tree. */
static void write_node(ResultWriter *writer, int32_t i, int32_t at)
{
    int32_t node = writer->arbor->node[i];
    writer->place[i] = at;
    writer->tree->type[at] = writer->was->type[node];
    writer->tree->position[at] = writer->arbor->shape[i].to;
    if (writer->was->flow_share)
        writer->tree->flow_share[at] = writer->was->flow_share[node];
}

/* Writes segment i as node `at`. Its parent has been written. */
static Status write_segment(ResultWriter *writer, int32_t i, int32_t at, Err *err)
{
    const Branch *branch = &writer->arbor->branch[i];
    double *gauge = writer->gauge;
    Reduced reduced = arbor_reduce(writer->arbor, i);
    double radius = writer->arbor->radius_unit * gauge[i] * reduced.rho;
    if (!(radius >= DBL_MIN) || !isfinite(radius))
        return err_set(err, STATUS_INFEASIBLE,
                       "the radii span more than a double can hold; move gamma towards 3");
    for (int side = 0; side < 2; side++)
        if (branch->child[side] >= 0)
            gauge[branch->child[side]] = gauge[i] * reduced.widening;
    write_node(writer, i, at);
    writer->tree->radius_mm[at] = radius;
    writer->tree->parent[at] = writer->place[branch->parent];
    return STATUS_OK;
}

/* Writes all nodes depth first, tree after tree. */
static Status write_nodes(ResultWriter *writer, Err *err)
{
    const Arbor *arbor = writer->arbor;
    double *radius = writer->tree->radius_mm;
    int32_t at = 0, inlet = -1;
    for (int32_t i = arbor_first(arbor); i != 0; i = arbor_next(arbor, i)) {
        int32_t above = arbor->branch[i].parent;
        bool is_root = arbor_is_inlet(arbor, above);
        if (is_root)
            writer->gauge[i] = 1;
        if (is_root && above != inlet) {
            writer->tree->parent[at] = TREE_NO_PARENT;
            write_node(writer, above, at++);
            inlet = above;
        }
        TRY(write_segment(writer, i, at, err));
        if (is_root)
            radius[writer->place[above]] = fmax(radius[writer->place[above]], radius[at]);
        at++;
    }
    return STATUS_OK;
}

/* Copies the column of the pairs of terminals, which refinement does not change. */
static Status write_pairs(const ResultWriter *writer, Err *err)
{
    const TreeColumn *column = tree_column(writer->was, tree_pairs_name);
    double *number;
    if (!column)
        return STATUS_OK;
    TRY(tree_add_column(writer->tree, column->name, column->unit, &number, err));
    for (size_t i = 0; i < writer->arbor->n; i++)
        number[writer->place[i]] = column->value[writer->arbor->node[i]];
    return STATUS_OK;
}

Status arbor_to_tree(const Arbor *arbor, const Tree *was, Tree *tree, Err *err)
{
    Tree made = {0};
    ResultWriter writer = {.was = was, .arbor = arbor, .tree = &made};
    size_t n = arbor->n;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&writer.place, n, sizeof *writer.place, "nodes to renumber", err));
    TRY_GOTO(mem_calloc(&writer.gauge, n, sizeof *writer.gauge, "gauges", err));
    TRY_GOTO(tree_init(&made, n, err));
    if (was->flow_share)
        TRY_GOTO(tree_add_flow_shares(&made, err));
    TRY_GOTO(write_nodes(&writer, err));
    tree_renumber(&made);
    TRY_GOTO(write_pairs(&writer, err));
    *tree = made;
    made = (Tree){0};
done:
    free(writer.place);
    free(writer.gauge);
    tree_release(&made);
    return status;
}
