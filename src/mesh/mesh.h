/* The implicit vessel surface as triangles. The door of the room mesh.
 *
 * The surface is that of the union, over the nodes of a tree, of the bodies in which the sum of
 * the terms of the segments that blend at the node exceeds FIELD_LEVEL; a segment blends at the
 * nodes that a way of at most BLEND_REACH of its radii leads to from one of its ends. Vessels that
 * only pass each other do not blend. A vessel is cut off flat at a node where nothing else meets
 * it. */
#ifndef CORCAST_MESH_MESH_H
#define CORCAST_MESH_MESH_H

#include "base/base.h"
#include "mesh/meshreport.h"      // IWYU pragma: export
#include "mesh/precision.h"       // IWYU pragma: export
#include "mesh/proof/meshcheck.h" // IWYU pragma: export
#include "mesh/zones/adjust.h"    // IWYU pragma: export
#include "mesh/zones/junctions.h" // IWYU pragma: export
#include "mesh/zones/nearpairs.h" // IWYU pragma: export
#include "scene/scene.h"

/* What the mesh of a tree takes, within a factor of 2 as a rule. */
typedef struct MeshEstimate {
    double triangles, bytes; /* of memory, at the most */
    double seconds;          /* on the threads asked for, of a processor of 2023 */
} MeshEstimate;

/* O(n). */
MeshEstimate vesselmesh_estimate(const VesselTree *tree, const MeshParams *params);

/* Triangulates the surface. The same bytes for any number of threads. *report is filled also where
 * the mesh is not sound. STATUS_INPUT naming a pair of ids when vessels that do not blend overlap,
 * STATUS_INFEASIBLE when a junction resists the finest cells. */
MUST_CHECK Status vesselmesh_build(const VesselTree *tree, const MeshParams *params,
                                   VesselMesh *mesh, MeshReport *report, Err *err);

#endif
