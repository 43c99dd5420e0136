/* Facts about finished triangles: connected parts, genus, open edges, volume, crossings. */
#ifndef CORCAST_MESH_PROOF_MESHCHECK_H
#define CORCAST_MESH_PROOF_MESHCHECK_H

#include "mesh/meshreport.h"
#include <stdatomic.h>

/* Returns the volume that the triangles enclose, mm^3. */
double vesselmesh_volume(const VesselMesh *mesh);

/* Finds the tree of each segment.
 *
 * trees    receives, per segment, the lowest node of its tree (owned by the caller).
 * n_trees  receives the number of trees.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status meshcheck_trees(const VesselTree *tree, uint32_t **trees, size_t *n_trees,
                                  Err *err);

/* Fills components, genus, euler, open_edges, volume_mm3 and bridges of the report. trees[i] is the
 * tree of segment i. Errors: STATUS_MEMORY. O(triangles). */
MUST_CHECK Status meshcheck_topology(const VesselMesh *mesh, const uint32_t *trees,
                                     MeshReport *report, Err *err);

/* Counts the pairs of triangles that have a point in common beyond a corner or an edge that they
 * share. The result is exact.
 *
 * grid_mm  all coordinates are integer multiples of it, below 2^25 times it.
 * crossed  per triangle: set to true if it is in such a pair; NULL: not wanted.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status meshcheck_crossings(const VesselMesh *mesh, double grid_mm, int threads,
                                      atomic_bool *crossed, size_t *crossings, Err *err);

#endif
