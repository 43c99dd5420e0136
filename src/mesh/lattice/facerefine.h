/* Smaller triangles where they are too far off the wall. */
#ifndef CORCAST_MESH_LATTICE_FACEREFINE_H
#define CORCAST_MESH_LATTICE_FACEREFINE_H

#include "mesh/lattice/octree.h"
#include "mesh/lattice/pairtable.h"
#include "mesh/lattice/patch.h"
#include "mesh/meshreport.h"

/* Workspace of a thread; zeroed before the first use. */
typedef struct Refiner {
    PairTable edges; /* edge to be split -> point that it is split at */
    uint8_t *states; /* one a triangle */
    uint32_t *renamed;
    size_t state_capacity, renamed_capacity;
} Refiner;

void refiner_release(Refiner *refiner);

/* Splits edges of triangles that are farther off the wall than `limit`, over the local radius, at
 * points of the wall; edges on rims stay. What the patch is topologically does not change. *off is
 * widened by how far the triangles are off in the end, at their middles and at those of their
 * longest edges. */
MUST_CHECK Status refine_make(Refiner *refiner, const ZonePlan *plan, const ZoneTree *tree,
                              double limit, Patch *patch, MeshOff *off, Err *err);

#endif
