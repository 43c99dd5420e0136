/* Points of a mesh whose triangles cannot cross each other. */
#ifndef CORCAST_MESH_PROOF_FANS_H
#define CORCAST_MESH_PROOF_FANS_H

#include "base/base.h"
#include "scene/scene.h"

/* Sets is_fan[i] for each point i where it is proved that no two triangles at the point have more
 * in common than a corner or an edge that they share.
 *
 * mesh     its coordinates are integer multiples of a grid, so that their differences are exact in
 *          double precision.
 * is_fan   per point; must be false before.
 * Errors   STATUS_MEMORY.
 * Cost     O(triangles). */
MUST_CHECK Status fans_find(const VesselMesh *mesh, int threads, bool *is_fan, Err *err);

#endif
