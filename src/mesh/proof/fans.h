/* Points of a mesh whose triangles cannot cross each other. */
#ifndef CORCAST_MESH_PROOF_FANS_H
#define CORCAST_MESH_PROOF_FANS_H

#include "base/base.h"
#include "scene/scene.h"

/* Sets is_fan[i], one a point, zeroed before, where it is proved that no two of the triangles at
 * point i meet elsewhere than in a corner or edge that they share. Coordinates are whole multiples
 * of a grid, so that their differences are exact in double precision. O(n). */
MUST_CHECK Status fans_find(const VesselMesh *mesh, int threads, bool *is_fan, Err *err);

#endif
