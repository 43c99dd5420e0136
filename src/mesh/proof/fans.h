/* Finds points of a mesh whose triangles cannot cross each other, so that the exact test of
 * crossings can skip pairs of triangles at such a point. Private to the module mesh. */
#ifndef CORCAST_MESH_PROOF_FANS_H
#define CORCAST_MESH_PROOF_FANS_H

#include "base/base.h"
#include "scene/scene.h"

/* Sets is_fan[i] to true for each point i whose triangles are proved to form a fan: no two of them
 * meet except at a corner or an edge that they share. A point without the proof stays false; its
 * triangles may cross or not.
 *
 * mesh     its coordinates are integer multiples of a grid, so that their differences are exact in
 *          double precision.
 * threads  number of threads; 0: one per processor.
 * is_fan   per point; owned by the caller; must be false before.
 * Errors   STATUS_MEMORY.
 * Cost     O(triangles). */
MUST_CHECK Status fans_find(const VesselMesh *mesh, int threads, bool *is_fan, Err *err);

#endif
