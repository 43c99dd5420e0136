/* Vessels as lines with radii, and how they hang together: what an implicit surface is made from
 * whose vessels blend only where they meet. */
#ifndef CORCAST_SCENE_VESSELTREE_H
#define CORCAST_SCENE_VESSELTREE_H

#include "scene/geometry.h"

/* Segments, and the nodes at their ends a and b. Any number of trees; a segment joins two different
 * nodes, and segments make no loops. */
typedef struct VesselTree {
    FieldSegment *segments; /* owned, as all of it */
    uint32_t (*nodes)[2];   /* of each segment; below n_nodes */
    uint32_t *ids;          /* SWC id of each segment */
    size_t n_segments, n_nodes;
} VesselTree;

/* Frees the arrays and zeroes *tree. */
void vesseltree_release(VesselTree *tree);

#endif
