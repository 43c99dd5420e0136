/* Vessels without a common node whose walls come near. */
#ifndef CORCAST_SURFACE_NEARPAIRS_H
#define CORCAST_SURFACE_NEARPAIRS_H

#include "surface/mesh/vesselmesh.h"

/* Pairs of segments without a common node and with a gap below NEAR_GAP of the thinner radius, in
 * *pairs (owned), by rising indices. */
MUST_CHECK Status nearpairs_find(const VesselTree *tree, int threads, NearPair **pairs, size_t *n,
                                 Err *err);

/* The distance of the point x from a segment, and between two segments, mm. */
double segment_distance_to(const FieldSegment *segment, Vec3 x);
double segments_distance(const FieldSegment *a, const FieldSegment *b);

#endif
