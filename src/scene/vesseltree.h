/* Vessels as lines with radii, and how they hang together: what an implicit surface is made from
 * whose vessels blend only where they meet. */
#ifndef CORCAST_SCENE_VESSELTREE_H
#define CORCAST_SCENE_VESSELTREE_H

#include "scene/geometry.h"

/* What is made of vessels. */
typedef enum VesselBody {
    BODY_POTENTIAL, /* what exceeds FIELD_LEVEL; cut off flat at ends */
    BODY_ROUND      /* cylinders, and at each node a ball of the largest radius that meets there */
} VesselBody;

/* Segments, and the nodes at their ends a and b. Any number of trees; a segment joins two different
 * nodes, and segments make no loops. */
typedef struct VesselTree {
    FieldSegment *segments; /* owned, as all of it */
    uint32_t (*nodes)[2];   /* of each segment; below n_nodes */
    uint32_t *ids;          /* SWC id of each segment */
    size_t n_segments, n_nodes;
    VesselBody body;
} VesselTree;

/* Frees the arrays and zeroes *tree. */
void vesseltree_release(VesselTree *tree);

/* The end, 0 or 1, of a segment that lies at a node, which must be one of its two. */
static inline int segment_end_at(const VesselTree *tree, uint32_t segment, uint32_t node)
{
    return tree->nodes[segment][1] == node;
}

/* A segment blends at both its nodes and at those that a way through other segments of at most so
 * many of its own radii leads to. */
#define BLEND_REACH 2

/* The segments with an end at each node. */
MUST_CHECK Status vesseltree_incident(const VesselTree *tree, IndexLists *out, Err *err);
/* The segments that blend at each node. O(size of the result). */
MUST_CHECK Status vesseltree_blending(const VesselTree *tree, const IndexLists *incident,
                                      IndexLists *out, Err *err);

/* The blend of the tree's segments: the solid is the union over the nodes of where the sum of the
 * terms of those that blend there exceeds FIELD_LEVEL. A group stands for each node whose segments
 * are not all among those of another. O(n) where few segments blend. *out is owned; it is released
 * with the geometry that holds it. STATUS_MEMORY. */
MUST_CHECK Status vesseltree_blend(const VesselTree *tree, Blend *out, Err *err);

#endif
