/* A tree of vessels for surfaces and volumes: segments with radii, and the nodes that connect them.
 * An implicit surface is built from such a tree: its vessels blend only where they are connected.
 * vesseltree_blend decides which segments blend. */
#ifndef CORCAST_SCENE_VESSELTREE_H
#define CORCAST_SCENE_VESSELTREE_H

#include "scene/geometry.h"

/* The solid that is built from the segments. */
typedef enum VesselBody {
    BODY_POTENTIAL, /* points where the potential exceeds FIELD_LEVEL; ends are cut flat */
    BODY_ROUND      /* cylinders, and at each node a ball of the largest radius at that node */
} VesselBody;

/* Segments, each with its ends a and b, and the nodes at these ends. The segments form any number
 * of connected trees or networks. A segment connects two different nodes, and no two segments
 * connect the same two nodes, which is not checked. Coordinates are in mm. All arrays are owned. */
typedef struct VesselTree {
    FieldSegment *segments;
    uint32_t (*nodes)[2]; /* per segment: the nodes at a and b, each below n_nodes */
    uint32_t *ids;        /* per segment: its SWC id */
    size_t n_segments, n_nodes;
    VesselBody body;
} VesselTree;

/* Frees the arrays and zeroes *tree. */
void vesseltree_release(VesselTree *tree);

/* Returns the segment's end (0: a, 1: b) at `node`, which must be one of its two nodes. */
static inline int segment_end_at(const VesselTree *tree, uint32_t segment, uint32_t node)
{
    return tree->nodes[segment][1] == node;
}

/* Reach of a segment's blend, in units of its radius. A segment blends at its two nodes, and at
 * every node that a path of at most BLEND_REACH of its radii along other segments reaches. A finely
 * sampled centreline needs this reach, or the vessel gets thinner [METHODS section 2.5]. */
#define BLEND_REACH 2

/* Lists, for each node, the segments that end there. Release *out with indexlists_release, also
 * after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status vesseltree_incident(const VesselTree *tree, IndexLists *out, Err *err);

/* Lists, for each node, the segments that blend there. `incident` is the result of
 * vesseltree_incident. Release *out with indexlists_release, also after an error. Errors:
 * STATUS_MEMORY. Cost: O(size of the result). */
MUST_CHECK Status vesseltree_blending(const VesselTree *tree, const IndexLists *incident,
                                      IndexLists *out, Err *err);

/* Builds the blend groups of the tree's segments. At each node, the terms of the segments that
 * blend there are summed. The solid is the union, over all nodes, of the sets where this sum
 * exceeds FIELD_LEVEL. There is one group per node; a node whose segments are a subset of another
 * node's segments has none.
 *
 * out      receives the groups; a Geometry that takes them releases them. Unchanged on error.
 * Errors   STATUS_MEMORY.
 * Cost     O(n) if few segments blend at each node. */
MUST_CHECK Status vesseltree_blend(const VesselTree *tree, Blend *out, Err *err);

#endif
