/* Splits triangles of a patch that are too far from the exact surface, as happens in the crotch of
 * a bifurcation. Private to the module mesh. */
#ifndef CORCAST_MESH_LATTICE_FACEREFINE_H
#define CORCAST_MESH_LATTICE_FACEREFINE_H

#include "mesh/lattice/patch.h"
#include "mesh/meshreport.h"

/* Workspace of one thread. Zero it before first use; release it with refiner_release. */
typedef struct Refiner {
    KeyMap edges;          /* edge to be split -> index of the point that splits it */
    ARRAY(uint8_t) states; /* per triangle: TriangleState of facerefine.c */
} Refiner;

void refiner_release(Refiner *refiner);

/* Splits edges of triangles that are farther from the surface than `limit` local radii. The new
 * points are on the surface, and are appended to the patch. Edges on rims are not split. The
 * topology of the patch does not change. Some triangles may stay farther away, because a split
 * would turn a triangle over.
 *
 * deviation  is raised to the largest distance of a triangle from the surface after the splits,
 *          measured at the middles of triangles and of their longest edges.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status facerefine_apply(Refiner *refiner, const JunctionSurface *surface, double limit,
                                   MeshDeviation *deviation, Err *err);

#endif
