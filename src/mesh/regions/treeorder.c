/* Orders the nodes of a forest depth first, so that a subtree is an interval of positions. Nodes
 * are taken from a stack, so that all nodes of a subtree follow its root in the order. Then the
 * nodes are visited from the last to the first; each node raises the last position of its parent's
 * subtree to that of its own. In a network a node may be on the stack several times. Such a node
 * takes its position and its parent from the copy that was pushed last. */
#include "mesh/regions/treeorder.h"

#include "mesh/regions/nearpairs.h"
#include <stdlib.h>

void treeorder_release(TreeOrder *order)
{
    free(order->parent);
    free(order->position);
    free(order->last);
    *order = (TreeOrder){0};
}

/* Appends the nodes of a tree, from `root` on, to the `n` nodes that are in order. Returns the new
 * number of these nodes. */
static uint32_t order_tree(const VesselTree *tree, const IndexLists *incident, uint32_t root,
                           uint32_t n, uint32_t *stack, uint32_t *ordered, TreeOrder *order)
{
    uint32_t top = 0;
    stack[top++] = root;
    order->parent[root] = root;
    while (top) {
        uint32_t node = stack[--top];
        if (order->position[node] != UINT32_MAX)
            continue;
        order->position[node] = order->last[node] = n;
        ordered[n++] = node;
        for (uint32_t i = incident->first[node]; i < incident->first[node + 1]; i++) {
            uint32_t segment = incident->items[i];
            uint32_t next = tree->nodes[segment][!segment_end_at(tree, segment, node)];
            if (order->position[next] != UINT32_MAX)
                continue;
            order->parent[next] = node;
            stack[top++] = next;
        }
    }
    return n;
}

Status treeorder_make(const VesselTree *tree, const IndexLists *incident, TreeOrder *out, Err *err)
{
    TreeOrder order = {0};
    uint32_t *stack = NULL, *ordered = NULL, n = 0;
    Status status;
    TRY_GOTO(mem_calloc(&order.parent, tree->n_nodes, sizeof *order.parent, "nodes", err));
    TRY_GOTO(mem_calloc(&order.position, tree->n_nodes, sizeof *order.position, "nodes", err));
    TRY_GOTO(mem_calloc(&order.last, tree->n_nodes, sizeof *order.last, "nodes", err));
    TRY_GOTO(mem_calloc(&stack, tree->n_segments + 1, sizeof *stack, "nodes", err));
    TRY_GOTO(mem_calloc(&ordered, tree->n_nodes, sizeof *ordered, "nodes", err));
    for (uint32_t i = 0; i < tree->n_nodes; i++)
        order.position[i] = UINT32_MAX;
    for (uint32_t i = 0; i < tree->n_nodes; i++)
        if (order.position[i] == UINT32_MAX)
            n = order_tree(tree, incident, i, n, stack, ordered, &order);
    for (uint32_t i = n; i-- > 0;) {
        uint32_t node = ordered[i], up = order.parent[node];
        if (order.last[up] < order.last[node])
            order.last[up] = order.last[node];
    }
    *out = order;
    order = (TreeOrder){0};
done:
    free(stack);
    free(ordered);
    treeorder_release(&order);
    return status;
}

bool treeorder_has_segment(const TreeOrder *order, const VesselTree *tree, uint32_t segment)
{
    const uint32_t *ends = tree->nodes[segment];
    return order->parent[ends[1]] == ends[0] || order->parent[ends[0]] == ends[1];
}

int treeorder_end_towards(const TreeOrder *order, const VesselTree *tree, uint32_t segment,
                          uint32_t other)
{
    const uint32_t *ends = tree->nodes[segment], *its = tree->nodes[other];
    for (int end = 0; end < 2; end++)
        if (its[0] == ends[end] || its[1] == ends[end])
            return end;
    int outer = order->parent[ends[1]] == ends[0];
    bool beyond[2];
    for (int end = 0; end < 2; end++)
        beyond[end] = treeorder_in_subtree(order, its[end], ends[outer]);
    if (!treeorder_has_segment(order, tree, segment) || beyond[0] != beyond[1])
        return segment_nearer_end(&tree->segments[segment], &tree->segments[other]);
    return beyond[0] ? outer : !outer;
}
