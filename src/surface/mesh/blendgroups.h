/* Which segments blend at which nodes of a tree. */
#ifndef CORCAST_SURFACE_BLENDGROUPS_H
#define CORCAST_SURFACE_BLENDGROUPS_H

#include "surface/mesh/vesselmesh.h"

/* Lists of indices, one a node: items[first[n] .. first[n + 1]), rising. */
typedef struct NodeLists {
    uint32_t *first, *items; /* owned */
} NodeLists;

void nodelists_release(NodeLists *lists);

/* The segments with an end at each node. */
MUST_CHECK Status nodelists_incident(const VesselTree *tree, NodeLists *out, Err *err);
/* The segments that blend at each node: those that a way of at most BLEND_REACH of their own radii
 * leads to. O(size of the result). */
MUST_CHECK Status nodelists_blending(const VesselTree *tree, const NodeLists *incident,
                                     NodeLists *out, Err *err);

/* Whether the rising lists of two nodes hold `segment`. */
bool nodelists_hold(const NodeLists *lists, uint32_t node, uint32_t segment);

/* The end, 0 or 1, of a segment that lies at a node, which must be one of its two. */
static inline int segment_end_at(const VesselTree *tree, uint32_t segment, uint32_t node)
{
    return tree->nodes[segment][1] == node;
}

#endif
