/* Sets the flow shares of the terminals: equal, or by a power of the radius. Flow shares are
 * relative, so any common factor is allowed. Radii are divided by the largest radius before they
 * are raised to a power, so that no power overflows. */
#include "tree/outlets.h"

#include "tree/tree.h"
#include <stdlib.h>

void tree_set_flow_shares(Tree *tree, double *share)
{
    free(tree->flow_share);
    tree->flow_share = share;
    tree->meta.known[META_TERMINAL_FLOW] = false;
}

void tree_set_flow_equal(Tree *tree)
{
    tree_set_flow_shares(tree, NULL);
}

Status tree_set_flow_by_radius(Tree *tree, double gamma, Err *err)
{
    int32_t *children = NULL;
    double *share = NULL, largest = 0;
    Status status;
    TRY_GOTO(tree_child_counts(tree, &children, err));
    TRY_GOTO(mem_calloc(&share, tree->n, sizeof *share, "flow shares", err));
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i) && children[i] == 0)
            largest = fmax(largest, share[i] = tree->radius_mm[i]);
    if (!(largest > 0))
        TRY_GOTO(err_set(err, STATUS_INPUT,
                         "no terminal has a radius above 0, so flow cannot be divided by radius"));
    for (size_t i = 0; i < tree->n; i++)
        share[i] = share[i] > 0 ? elementary_pow(share[i] / largest, gamma) : 0;
    tree_set_flow_shares(tree, share);
    share = NULL;
done:
    free(share);
    free(children);
    return status;
}
