/* Finds points of a mesh at which no two triangles cross, so that the exact test for crossings can
 * skip the pairs of triangles at these points. Private to the module mesh. */
#ifndef CORCAST_MESH_PROOF_FANS_H
#define CORCAST_MESH_PROOF_FANS_H

#include "base/base.h"
#include "scene/scene.h"

/* Sets is_fan[i] to true for each point i whose triangles are proved to form a fan: no two of them
 * meet except at a common corner or edge. At other points is_fan[i] stays false; triangles there
 * may or may not cross.
 *
 * mesh     its coordinates are integer multiples of a grid step, so that their differences are
 *          exact in double precision.
 * threads  number of threads; 0: one per processor.
 * is_fan   per point; owned by the caller; must be false before.
 * Errors   STATUS_MEMORY.
 * Cost     O(triangles). */
MUST_CHECK Status fans_find(const VesselMesh *mesh, int threads, bool *is_fan, Err *err);

#endif
