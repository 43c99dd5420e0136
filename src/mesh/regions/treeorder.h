/* An order of the nodes of a forest that answers on which side of a segment a node is. A network
 * with loops is ordered along a spanning forest.
 *
 * The root of a tree is its node of lowest index. The nodes are listed in depth-first order from
 * the root, so the nodes beyond a given node are consecutive. Private to the module mesh. */
#ifndef CORCAST_MESH_REGIONS_TREEORDER_H
#define CORCAST_MESH_REGIONS_TREEORDER_H

#include "base/base.h"
#include "scene/scene.h"

/* All arrays are per node and owned. */
typedef struct TreeOrder {
    uint32_t
        *previous; /* the node before it on the path from the lowest node; at the lowest, itself */
    uint32_t *position;    /* its position in the order */
    uint32_t *last_beyond; /* the position of the last node beyond it */
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

/* Returns true if the path from the root to `node` leads through `through`, or if both are the same
 * node. Returns false for nodes of different trees. */
static inline bool treeorder_is_beyond(const TreeOrder *order, uint32_t node, uint32_t through)
{
    return order->position[node] >= order->position[through] &&
           order->position[node] <= order->last_beyond[through];
}

/* Returns true if a segment is in the spanning forest. Its ends must be different nodes. */
bool treeorder_has(const TreeOrder *order, const VesselTree *tree, uint32_t segment);

/* Returns the end of `segment`, 0 or 1, through which the path to `other` leads. Both segments must
 * be in one tree. If a loop holds both segments, that is the end at which they meet, or else the
 * end that is nearer to `other`. */
int treeorder_end_towards(const TreeOrder *order, const VesselTree *tree, uint32_t segment,
                          uint32_t other);

#endif
