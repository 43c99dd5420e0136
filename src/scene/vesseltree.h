/* A tree of vessels as segments with radii, and the nodes that connect them. Surfaces (meshes) and
 * volumes are built from it. In an implicit surface, vessels blend only where they are connected:
 * vesseltree_incident and vesseltree_blending list the segments at each node, and vesseltree_blend
 * builds the groups of segments that blend. stage_vessels [stage/stage.h] makes a VesselTree. */
#ifndef CORCAST_SCENE_VESSELTREE_H
#define CORCAST_SCENE_VESSELTREE_H

#include "scene/geometry.h"

/* The solid that is built from the segments. */
typedef enum VesselBody {
    BODY_POTENTIAL, /* the points where the potential exceeds FIELD_LEVEL; free ends are cut flat */
    BODY_ROUND      /* the union of cylinders, and of a ball at each node; the ball's radius is the
                     * largest of the segments that meet there */
} VesselBody;

/* Segments with their ends a and b, and the nodes at these ends. The segments form any number of
 * connected trees or networks. The two nodes of a segment are different, and no two segments have
 * the same two nodes; the functions below do not check this. Coordinates are in mm. All arrays are
 * owned. */
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

/* Reach of a segment's blend, in units of its radius. A segment blends at its two nodes. It also
 * blends at every node that is connected to it by a path of at most BLEND_REACH times its radius
 * along other segments. With a shorter reach, the vessel of a finely sampled centreline would get
 * thinner [METHODS section 2.5]. */
#define BLEND_REACH 2

/* Lists, for each node, the segments that end there. Release *out with indexlists_release, also
 * after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status vesseltree_incident(const VesselTree *tree, IndexLists *out, Err *err);

/* Lists, for each node, the segments that blend there. `incident` is the result of
 * vesseltree_incident. Release *out with indexlists_release, also after an error. Errors:
 * STATUS_MEMORY. Cost: O(size of the result). */
MUST_CHECK Status vesseltree_blending(const VesselTree *tree, const IndexLists *incident,
                                      IndexLists *out, Err *err);

/* Builds the blend groups of the tree's segments. There is one group per node: the segments that
 * blend at the node. A node whose segments are a subset of another node's segments has no group; of
 * several nodes with the same segments, the first has one.
 * The solid is the union, over all groups, of the sets where the sum of the group's terms exceeds
 * FIELD_LEVEL.
 *
 * out      receives the groups, which are stored in a Geometry; geometry_release frees them.
 *          Unchanged on error.
 * Errors   STATUS_MEMORY.
 * Cost     O(n) if few segments blend at each node. */
MUST_CHECK Status vesseltree_blend(const VesselTree *tree, Blend *out, Err *err);

#endif
