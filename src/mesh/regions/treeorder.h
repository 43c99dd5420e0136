/* A depth-first order of the nodes of a forest. With this order, a range check of positions decides
 * on which side of a segment a node is.
 *
 * The root of a tree is its node of lowest index. The nodes are listed in depth-first order from
 * the root, so the nodes of each subtree are consecutive. A network with loops is ordered along a
 * spanning forest. Private to the module mesh. */
#ifndef CORCAST_MESH_REGIONS_TREEORDER_H
#define CORCAST_MESH_REGIONS_TREEORDER_H

#include "base/base.h"
#include "scene/scene.h"

/* The order. All arrays are per node and owned. */
typedef struct TreeOrder {
    uint32_t *parent;   /* the previous node on the path from the root; at the root, the root
                         * itself */
    uint32_t *position; /* position in the order */
    uint32_t *last;     /* position of the last node of the node's subtree */
} TreeOrder;

/* Orders the nodes.
 *
 * incident  per node: the segments with an end there.
 * out       receives the order; release it with treeorder_release.
 * Errors    STATUS_MEMORY.
 * Cost      O(n). */
MUST_CHECK Status treeorder_make(const VesselTree *tree, const IndexLists *incident, TreeOrder *out,
                                 Err *err);
void treeorder_release(TreeOrder *order);

/* Returns true if `node` is in the subtree of `root`, which includes `root` itself. Returns false
 * for nodes of different trees. */
static inline bool treeorder_in_subtree(const TreeOrder *order, uint32_t node, uint32_t root)
{
    return order->position[node] >= order->position[root] &&
           order->position[node] <= order->last[root];
}

/* Returns true if a segment is in the spanning forest. A segment that closes a loop is not. The
 * ends of the segment must be different nodes. */
bool treeorder_has_segment(const TreeOrder *order, const VesselTree *tree, uint32_t segment);

/* Returns the end of `segment`, 0 or 1, through which the path to `other` leads. Both segments must
 * be in the same tree. Segments that share a node: returns the end at this node. If both are in one
 * loop, there are two paths; returns the end that is nearer to the middle of `other` in space. */
int treeorder_end_towards(const TreeOrder *order, const VesselTree *tree, uint32_t segment,
                          uint32_t other);

#endif
