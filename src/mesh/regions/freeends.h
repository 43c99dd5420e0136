/* Where along a segment the vessels at its ends no longer change its surface, so that it may be cut
 * there. */
#ifndef CORCAST_MESH_REGIONS_FREEENDS_H
#define CORCAST_MESH_REGIONS_FREEENDS_H

#include "mesh/meshreport.h"
#include "mesh/regions/treeorder.h"

/* The influence of the vessels that meet at one end of a segment. Distances are from that end. */
typedef struct FreeEnd {
    double near_cylinder_mm; /* from here on, the surface is nearly the cylinder */
    double cylinder_mm; /* from here on, it is the cylinder as far as these vessels matter; may be
                         * beyond the other end */
} FreeEnd;

/* Returns the maximum distance by which other vessels may move the surface of a tube, in units of
 * its radius: a quarter of the tolerance, within bounds. */
double freeends_max_shift(const MeshParams *params);

/* The tree, with lists of segments per node. All pointers are borrowed. */
typedef struct FreeEndInput {
    const VesselTree *tree;
    const IndexLists *incident, *blending; /* segments with an end at the node; that blend there */
    const TreeOrder *order;
    const MeshParams *params;
} FreeEndInput;

/* Fills ends[segment][end] for each segment. The array must be zero. Errors: STATUS_MEMORY. */
MUST_CHECK Status freeends_find(const FreeEndInput *input, FreeEnd (*ends)[2], Err *err);

#endif
