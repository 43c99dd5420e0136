/* Which side of a segment a node of a tree lies on. */
#ifndef CORCAST_MESH_ZONES_TREEORDER_H
#define CORCAST_MESH_ZONES_TREEORDER_H

#include "base/base.h"
#include "scene/scene.h"

/* The nodes of each tree in order from its lowest one outwards, one branch after the other. */
typedef struct TreeOrder {
    uint32_t *up;    /* one a node, as all: the node before it on the way; its own at the lowest */
    uint32_t *place; /* in the order */
    uint32_t *last;  /* place of the last node beyond it */
} TreeOrder;

/* O(n). Release with treeorder_release. */
MUST_CHECK Status treeorder_make(const VesselTree *tree, const IndexLists *incident, TreeOrder *out,
                                 Err *err);
void treeorder_release(TreeOrder *order);

/* Whether the way from the lowest node to `node` leads through `through`. */
static inline bool treeorder_is_beyond(const TreeOrder *order, uint32_t node, uint32_t through)
{
    return order->place[node] >= order->place[through] &&
           order->place[node] <= order->last[through];
}

/* The end of the segment that another segment of the same tree is reached from. */
int treeorder_end_towards(const TreeOrder *order, const VesselTree *tree, uint32_t segment,
                          uint32_t other);

#endif
