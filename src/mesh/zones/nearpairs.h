/* Vessels without a common node whose walls come near. */
#ifndef CORCAST_MESH_ZONES_NEARPAIRS_H
#define CORCAST_MESH_ZONES_NEARPAIRS_H

#include "mesh/meshreport.h"

/* Pairs of segments without a common node and with a gap below NEAR_GAP of the thinner radius, in
 * *pairs (owned), by rising indices. */
MUST_CHECK Status nearpairs_find(const VesselTree *tree, int threads, NearPair **pairs, size_t *n,
                                 Err *err);

/* The distance of the point x from a segment, and between two segments, mm. */
double segment_distance_to(const FieldSegment *segment, Vec3 x);
double segments_distance(const FieldSegment *a, const FieldSegment *b);

/* Returns the box about a segment, `radius_mm` wider on all sides. */
Box segment_box(const FieldSegment *segment, double radius_mm);
/* Builds a tree of the boxes of all vessels of the tree, which must have one. STATUS_MEMORY. */
MUST_CHECK Status segments_boxtree(const VesselTree *tree, BoxTree *out, Err *err);

#endif
