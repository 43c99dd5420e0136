/* What is true of finished triangles. */
#ifndef CORCAST_MESH_PROOF_MESHCHECK_H
#define CORCAST_MESH_PROOF_MESHCHECK_H

#include "mesh/meshreport.h"
#include <stdatomic.h>

/* What the triangles enclose, mm^3. */
double vesselmesh_volume(const VesselMesh *mesh);

/* The trees that segments are of, each by its lowest node, in *trees (owned). */
MUST_CHECK Status meshcheck_trees(const VesselTree *tree, uint32_t **trees, size_t *n_trees,
                                  Err *err);

/* Fills components, genus, euler, open_edges and volume_mm3 of the report, and bridges: trees[i] is
 * the tree that segment i is of. O(triangles). */
MUST_CHECK Status meshcheck_topology(const VesselMesh *mesh, const uint32_t *trees,
                                     MeshReport *report, Err *err);

/* Fills crossings: the pairs of triangles that have a point in common beyond a corner or an edge
 * that they share; sets crossed[], one a triangle, of each of them, unless that is NULL. Exact:
 * coordinates are whole multiples of `grid_mm`, below 2^25 of it. */
MUST_CHECK Status meshcheck_crossings(const VesselMesh *mesh, double grid_mm, int threads,
                                      atomic_bool *crossed, size_t *crossings, Err *err);

#endif
