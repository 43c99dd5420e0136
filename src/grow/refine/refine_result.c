/* Radii are r = q g rho [law.h]: rho is in the arbor's sums, g multiplied down from the root. Both
 * only add and multiply positive numbers, so every radius is exact to a few units in the last
 * place. */
#include "grow/refine/refine_result.h"

#include <float.h>
#include <stdlib.h>

/* Writes node `at` of *tree, which is node i of the arbor and of the tree `was`. */
static void write_node(const Tree *was, const Arbor *arbor, int32_t i, int32_t at, Tree *tree)
{
    tree->type[at] = was->type[i];
    tree->position[at] = i ? arbor->shape[i].to : was->position[0];
    if (was->flow_share)
        tree->flow_share[at] = was->flow_share[i];
}

/* Writes all segments depth first. `place` and `gauge` have room for one entry a node. */
static Status write_segments(const Tree *was, const Arbor *arbor, int32_t *place, double *gauge,
                             Tree *tree, Err *err)
{
    int32_t at = 1;
    gauge[arbor_root(arbor)] = 1;
    for (int32_t i = arbor_root(arbor); i != 0; i = arbor_next(arbor, i)) {
        Reduced reduced = arbor_reduce(arbor, i);
        double radius = arbor->radius_unit * gauge[i] * reduced.rho;
        if (!(radius >= DBL_MIN) || !isfinite(radius))
            return err_set(err, STATUS_INFEASIBLE,
                           "the radii span more than a double can hold; move gamma, now %g, "
                           "towards 3",
                           arbor->law.gamma);
        for (int side = 0; side < 2; side++)
            if (arbor->branch[i].child[side] >= 0)
                gauge[arbor->branch[i].child[side]] = gauge[i] * reduced.widening;
        write_node(was, arbor, i, at, tree);
        tree->radius_mm[at] = radius;
        tree->parent[at] = place[arbor->branch[i].parent];
        place[i] = at++;
    }
    tree->radius_mm[0] = tree->radius_mm[1];
    return STATUS_OK;
}

Status result_write(const Arbor *arbor, Tree *tree, Err *err)
{
    Tree made = {0};
    int32_t *place = NULL;
    double *gauge = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&place, arbor->n, sizeof *place, "nodes to renumber", err));
    TRY_GOTO(mem_calloc(&gauge, arbor->n, sizeof *gauge, "gauges", err));
    TRY_GOTO(tree_init(&made, arbor->n, err));
    if (tree->flow_share)
        TRY_GOTO(tree_add_flow_shares(&made, err));
    write_node(tree, arbor, 0, 0, &made);
    TRY_GOTO(write_segments(tree, arbor, place, gauge, &made, err));
    tree_renumber(&made);
    made.meta = tree->meta;
    tree->meta = (TreeMeta){0};
    tree_release(tree);
    *tree = made;
    made = (Tree){0};
done:
    free(place);
    free(gauge);
    tree_release(&made);
    return status;
}
