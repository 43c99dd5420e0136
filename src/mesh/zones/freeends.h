/* Where a segment may be cut across. */
#ifndef CORCAST_MESH_ZONES_FREEENDS_H
#define CORCAST_MESH_ZONES_FREEENDS_H

#include "mesh/meshreport.h"
#include "mesh/zones/treeorder.h"

/* What the vessels that meet at one end of a segment do to its wall. */
typedef struct FreeEnd {
    double even_mm;  /* from here on, from the end, the wall is nearly the cylinder */
    double clear_mm; /* from here on it is the cylinder as far as those at this end matter; may be
                      * beyond the other end */
} FreeEnd;

/* How far others may move the wall of a tube at most, in radii: a quarter of the tolerance, within
 * bounds. */
double freeends_moved(const MeshParams *params);

/* Fills ends[], one pair a segment, zeroed before; `blending` lists the segments that blend at each
 * node. */
MUST_CHECK Status freeends_find(const VesselTree *tree, const NumberLists *incident,
                                const NumberLists *blending, const TreeOrder *order,
                                const MeshParams *params, FreeEnd (*ends)[2], Err *err);

#endif
