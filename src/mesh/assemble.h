/* Joins the surfaces of junction regions, tubes and caps into one mesh. */
#ifndef CORCAST_MESH_ASSEMBLE_H
#define CORCAST_MESH_ASSEMBLE_H

#include "mesh/junctionmesh.h"

/* How the tubes and caps are made. */
typedef struct TubeParams {
    uint32_t sides;   /* of a cap, and of a rim between the two rims of a tube */
    double tube_edge; /* maximum length of a tube's triangles along it, in radii; 0: no limit */
    double grid_mm;   /* coordinates are rounded to integer multiples of it */
} TubeParams;

/* Joins the meshes of all regions, and the tubes between them. Every segment that is a tube has
 * triangles then.
 *
 * meshes   per region; released while they are joined.
 * mesh     receives the mesh; owned by the caller.
 * deviation  is raised to the largest distance of a tube's triangle from its surface.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status assemble_mesh(const VesselTree *tree, const Junctions *junctions,
                                JunctionMesh *meshes, const TubeParams *params, VesselMesh *mesh,
                                MeshDeviation *deviation, Err *err);

#endif
