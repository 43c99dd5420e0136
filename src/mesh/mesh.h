/* The public header of the module mesh: builds the surface of vessels as a closed triangle mesh.
 *
 * The surface is an implicit surface of a potential. Each segment has one term of the potential.
 * Each node of the tree has a body: the set where the sum of the terms that blend at the node
 * exceeds FIELD_LEVEL. A segment blends at its two nodes, and at every node that can be reached
 * from them by a path of other segments no longer than BLEND_REACH times the segment's radius. The
 * vessels are the union of the bodies. A vessel is cut off flat at a node where no other vessel
 * meets it.
 *
 * The tree is cut into junction regions around the nodes, and straight tubes between the regions
 * [regions/junctions.h]. The mesh of each region is extracted from a lattice of tetrahedra
 * [junctionmesh.h]. A tube is a strip of triangles between two regions, a flat end is a disc
 * [assemble.h]. The finished triangles are then checked: they must be closed and free of crossings,
 * with one component per tree, whose genus is the number of the tree's independent loops
 * [meshreport.h].
 *
 *     MeshParams params = {.tolerance = 0.02};
 *     TRY(vesselmesh_build(&tree, &params, &mesh, &report, err));
 *     TRY(meshreport_check(&report, &tree, err));
 *
 * The caller then uses `mesh`, and releases both with vesselmesh_release and meshreport_release. */
#ifndef CORCAST_MESH_MESH_H
#define CORCAST_MESH_MESH_H

#include "base/base.h"
#include "mesh/meshreport.h"        // IWYU pragma: export
#include "mesh/precision.h"         // IWYU pragma: export
#include "mesh/proof/meshcheck.h"   // IWYU pragma: export
#include "mesh/regions/adjust.h"    // IWYU pragma: export
#include "mesh/regions/junctions.h" // IWYU pragma: export
#include "mesh/regions/nearpairs.h" // IWYU pragma: export
#include "mesh/sweep.h"             // IWYU pragma: export
#include "scene/scene.h"

/* The expected cost of a mesh, in most cases right within a factor of 2. */
typedef struct MeshEstimate {
    double triangles; /* number of triangles */
    double bytes;     /* maximum memory in use */
    double seconds;   /* on MeshParams.threads threads of a processor of 2023 */
} MeshEstimate;

/* Returns the expected cost of the mesh that vesselmesh_build would make. Does not build anything,
 * and cannot fail. O(n) for n segments. */
MeshEstimate vesselmesh_estimate(const VesselTree *tree, const MeshParams *params);

/* Triangulates the surface of a tree, and measures the mesh. The result does not
 * depend on the number of threads. On error, `mesh` and `report` stay unchanged.
 *
 * mesh     receives the triangles, valid or not; release it with vesselmesh_release.
 * report   receives the measurements; meshreport_check decides from them whether the mesh is valid.
 *          Release it with meshreport_release.
 * Errors   STATUS_INPUT, with a pair of ids, if two vessels overlap that do not blend. STATUS_INPUT
 *          if the tree is too far from the origin [precision.h]. STATUS_INFEASIBLE if a junction
 *          region has no valid surface with the finest cells. STATUS_CANCELLED if
 *          MeshParams.progress returned false. STATUS_MEMORY. */
MUST_CHECK Status vesselmesh_build(const VesselTree *tree, const MeshParams *params,
                                   VesselMesh *mesh, MeshReport *report, Err *err);

#endif
