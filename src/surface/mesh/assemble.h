/* Zones' walls, the tubes between them, and caps, as one mesh. */
#ifndef CORCAST_SURFACE_ASSEMBLE_H
#define CORCAST_SURFACE_ASSEMBLE_H

#include "surface/mesh/zonepiece.h"

/* Joins all into *mesh (owned by the caller), its points on a grid, whose step goes to *grid_mm; a
 * cap has at least `sides` sides. The pieces are released on the way. Every segment that is a tube
 * has triangles then. */
MUST_CHECK Status assemble_mesh(const VesselTree *tree, const Zones *zones, ZonePiece *pieces,
                                uint32_t sides, VesselMesh *mesh, double *grid_mm, Err *err);

#endif
