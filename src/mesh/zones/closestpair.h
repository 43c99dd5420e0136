/* How near vessels come that do not belong together. */
#ifndef CORCAST_MESH_ZONES_CLOSESTPAIR_H
#define CORCAST_MESH_ZONES_CLOSESTPAIR_H

#include "mesh/meshreport.h"

/* Finds the two segments without a common junction zone whose walls are the nearest to each other;
 * false when there are none. Expected O(n log n) for vessels that fill a space evenly. */
MUST_CHECK Status leastgap_find(const VesselTree *tree, const MeshParams *params, NearPair *pair,
                                bool *found, Err *err);

#endif
