/* Finds where along a segment the vessels at its ends no longer change its surface. From there on
 * the segment is a tube, and may be cut off from its junction region.
 *
 * The surface is tested on circles about the segment's axis, in steps from the far end towards the
 * tested end [freeends.c]. Private to the module mesh. */
#ifndef CORCAST_MESH_REGIONS_FREEENDS_H
#define CORCAST_MESH_REGIONS_FREEENDS_H

#include "mesh/meshreport.h"
#include "mesh/regions/treeorder.h"

/* The distances from one end of a segment up to which the vessels that meet at this end change the
 * segment's surface. Both distances are 0 if no other vessel changes it. */
typedef struct FreeEnd {
    double near_cylinder_mm; /* beyond this distance from the end, these vessels move the surface by
                              * at most 0.0125 radii: it is nearly a cylinder */
    double cylinder_mm;      /* beyond this distance from the end, these vessels move the surface by
                              * at most freeends_max_shift. The distance may be longer than the
                              * segment. */
} FreeEnd;

/* Returns the maximum distance by which other vessels may move the surface of a tube, in units of
 * the tube's radius: a quarter of MeshParams.tolerance, which is first clamped to [0.005, 0.02].
 * Below, long tubes would become parts of regions; above, a coarse mesh would show a step at the
 * end of a tube. */
double freeends_max_shift(const MeshParams *params);

/* The tree, with lists of segments per node. All pointers are borrowed. */
typedef struct FreeEndInput {
    const VesselTree *tree;
    const IndexLists *incident; /* per node: the segments with an end there */
    const IndexLists *blending; /* per node: the segments that blend there [vesseltree_blending] */
    const TreeOrder *order;
    const MeshParams *params;
} FreeEndInput;

/* Fills ends[segment][end] for both ends of each segment. The caller owns the array, which has
 * n_segments elements and must be zero before. Uses MeshParams.threads threads. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status freeends_find(const FreeEndInput *input, FreeEnd (*ends)[2], Err *err);

#endif
