/* An order of a tree's nodes that tells on which side of a segment a node is. */
#ifndef CORCAST_MESH_REGIONS_TREEORDER_H
#define CORCAST_MESH_REGIONS_TREEORDER_H

#include "base/base.h"
#include "scene/scene.h"

/* The nodes of each tree in order from its lowest node outwards, one branch after the other. All
 * arrays are per node and owned. */
typedef struct TreeOrder {
    uint32_t
        *previous; /* the node before it on the path from the lowest node; at the lowest, itself */
    uint32_t *position;    /* its position in the order */
    uint32_t *last_beyond; /* the position of the last node beyond it */
} TreeOrder;

/* Orders the nodes. `incident` lists the segments at each node. Release the order with
 * treeorder_release. Errors: STATUS_MEMORY. O(n). */
MUST_CHECK Status treeorder_make(const VesselTree *tree, const IndexLists *incident, TreeOrder *out,
                                 Err *err);
void treeorder_release(TreeOrder *order);

/* Returns true if the path from the lowest node to `node` leads through `through`. */
static inline bool treeorder_is_beyond(const TreeOrder *order, uint32_t node, uint32_t through)
{
    return order->position[node] >= order->position[through] &&
           order->position[node] <= order->last_beyond[through];
}

/* Returns the end, 0 or 1, of a segment from which another segment of the same tree is reached. */
int treeorder_end_towards(const TreeOrder *order, const VesselTree *tree, uint32_t segment,
                          uint32_t other);

#endif
