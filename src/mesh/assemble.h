/* Zones' walls, the tubes between them, and caps, as one mesh. */
#ifndef CORCAST_MESH_ASSEMBLE_H
#define CORCAST_MESH_ASSEMBLE_H

#include "mesh/junctionmesh.h"

/* Joins all into *mesh (owned by the caller), its points on the grid; a cap has `sides` sides, and
 * so has a rim in between, of which a tube gets as many as make its triangles no longer than
 * `tube_edge` radii; 0: none. The
 * pieces are released on the way. Every segment that is a tube has triangles then. *off is widened
 * by what tubes are off their walls. */
MUST_CHECK Status assemble_mesh(const VesselTree *tree, const Zones *zones, ZonePiece *pieces,
                                uint32_t sides, double tube_edge, double grid_mm, VesselMesh *mesh,
                                MeshOff *off, Err *err);

#endif
