/* Radii are r = q g rho [law.h]: rho is in the arbor's sums, g multiplied down from the root. Both
 * only add and multiply positive numbers, so every radius is exact to a few units in the last
 * place. */
#include "grow/refine/refine_result.h"

#include <float.h>
#include <stdlib.h>

/* Writes node `at` of *tree, which is node i of the arbor; `was` is what the arbor was made of. */
static void write_node(const Tree *was, const Arbor *arbor, int32_t i, int32_t at, Tree *tree)
{
    int32_t node = arbor->node[i];
    tree->type[at] = was->type[node];
    tree->position[at] = arbor->shape[i].to;
    if (was->flow_share)
        tree->flow_share[at] = was->flow_share[node];
}

/* Writes segment i as node `at`, whose parent is there already. */
static Status write_segment(const Tree *was, const Arbor *arbor, int32_t i, int32_t at,
                            double *gauge, Tree *tree, Err *err)
{
    Reduced reduced = arbor_reduce(arbor, i);
    double radius = arbor->radius_unit * gauge[i] * reduced.rho;
    if (!(radius >= DBL_MIN) || !isfinite(radius))
        return err_set(err, STATUS_INFEASIBLE,
                       "the radii span more than a double can hold; move gamma towards 3");
    for (int side = 0; side < 2; side++)
        if (arbor->branch[i].child[side] >= 0)
            gauge[arbor->branch[i].child[side]] = gauge[i] * reduced.widening;
    write_node(was, arbor, i, at, tree);
    tree->radius_mm[at] = radius;
    return STATUS_OK;
}

/* Writes all nodes depth first, tree after tree. `place` and `gauge` have room for one entry a
 * node.
 */
static Status write_nodes(const Tree *was, const Arbor *arbor, int32_t *place, double *gauge,
                          Tree *tree, Err *err)
{
    int32_t at = 0, inlet = -1;
    for (int32_t i = arbor_first(arbor); i != 0; i = arbor_next(arbor, i)) {
        int32_t above = arbor->branch[i].parent;
        if (arbor_is_inlet(arbor, above)) {
            gauge[i] = 1;
            if (above != inlet) {
                tree->parent[at] = TREE_NO_PARENT;
                write_node(was, arbor, above, at, tree);
                place[above] = at++;
                inlet = above;
            }
        }
        TRY(write_segment(was, arbor, i, at, gauge, tree, err));
        tree->parent[at] = place[above];
        if (arbor_is_inlet(arbor, above))
            tree->radius_mm[place[above]] =
                fmax(tree->radius_mm[place[above]], tree->radius_mm[at]);
        place[i] = at++;
    }
    return STATUS_OK;
}

/* Terminals stay, and with them their pairs. */
static Status write_pairs(const Tree *was, const Arbor *arbor, const int32_t *place, Tree *tree,
                          Err *err)
{
    const TreeColumn *column = tree_column(was, tree_pairs_name);
    double *number;
    if (!column)
        return STATUS_OK;
    TRY(tree_add_column(tree, column->name, column->unit, &number, err));
    for (size_t i = 0; i < arbor->n; i++)
        number[place[i]] = column->value[arbor->node[i]];
    return STATUS_OK;
}

Status result_make(const Arbor *arbor, const Tree *was, Tree *tree, Err *err)
{
    Tree made = {0};
    int32_t *place = NULL;
    double *gauge = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&place, arbor->n, sizeof *place, "nodes to renumber", err));
    TRY_GOTO(mem_calloc(&gauge, arbor->n, sizeof *gauge, "gauges", err));
    TRY_GOTO(tree_init(&made, arbor->n, err));
    if (was->flow_share)
        TRY_GOTO(tree_add_flow_shares(&made, err));
    TRY_GOTO(write_nodes(was, arbor, place, gauge, &made, err));
    tree_renumber(&made);
    TRY_GOTO(write_pairs(was, arbor, place, &made, err));
    *tree = made;
    made = (Tree){0};
done:
    free(place);
    free(gauge);
    tree_release(&made);
    return status;
}
