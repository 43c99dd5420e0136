/* The public header of the module mesh: the surface of vessels as triangles.
 *
 * Segments blend only where they meet. Each node of a tree has a body: the points where the sum of
 * the terms of the segments that blend at the node exceeds FIELD_LEVEL. A segment blends at its two
 * nodes, and at every node that can be reached from them along other segments within BLEND_REACH
 * times the segment's radius. The surface is that of the union of the bodies. A vessel is cut off
 * flat at a node where nothing else meets it. */
#ifndef CORCAST_MESH_MESH_H
#define CORCAST_MESH_MESH_H

#include "base/base.h"
#include "mesh/meshreport.h"        // IWYU pragma: export
#include "mesh/precision.h"         // IWYU pragma: export
#include "mesh/proof/meshcheck.h"   // IWYU pragma: export
#include "mesh/regions/adjust.h"    // IWYU pragma: export
#include "mesh/regions/junctions.h" // IWYU pragma: export
#include "mesh/regions/nearpairs.h" // IWYU pragma: export
#include "scene/scene.h"

/* The expected cost of a mesh, in most cases right within a factor of 2. */
typedef struct MeshEstimate {
    double triangles;
    double bytes;   /* maximum memory in use */
    double seconds; /* on MeshParams.threads threads of a processor of 2023 */
} MeshEstimate;

/* Returns the estimate. O(n). */
MeshEstimate vesselmesh_estimate(const VesselTree *tree, const MeshParams *params);

/* Triangulates the surface of a tree, and finds the facts about the mesh. The result does not
 * depend on the number of threads.
 *
 * mesh     receives the triangles, valid or not; release it with vesselmesh_release.
 * report   receives the facts; check them with meshreport_check, and release them with
 *          meshreport_release.
 * Errors   STATUS_INPUT, with a pair of ids, if vessels overlap that do not blend, or if the tree
 *          is too far from the origin; STATUS_INFEASIBLE if a junction region has no valid surface
 *          with the finest cells; STATUS_MEMORY. */
MUST_CHECK Status vesselmesh_build(const VesselTree *tree, const MeshParams *params,
                                   VesselMesh *mesh, MeshReport *report, Err *err);

#endif
