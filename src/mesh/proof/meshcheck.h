/* Computes the topology of finished triangles: connected components, genus, open edges, volume,
 * crossings. The functions fill parts of a MeshReport; meshreport_check then decides whether the
 * mesh is valid. Exported by the public header of the module mesh. */
#ifndef CORCAST_MESH_PROOF_MESHCHECK_H
#define CORCAST_MESH_PROOF_MESHCHECK_H

#include "mesh/meshreport.h"
#include <stdatomic.h>

/* Returns the volume that the triangles enclose, mm^3. It is negative if the mesh is inside out,
 * and has no meaning if the mesh is not closed. */
double vesselmesh_volume(const VesselMesh *mesh);

/* Finds the connected trees of a VesselTree, which may contain several, and the tree of each
 * segment.
 *
 * trees    receives, per segment, the index of its tree, below *n_trees; free it with free(). The
 *          trees are numbered in the order of their first segments.
 * n_trees  receives the number of trees.
 * Errors   STATUS_MEMORY. *trees must be NULL before the call; the caller frees it even after an
 *          error. */
MUST_CHECK Status meshcheck_trees(const VesselTree *tree, uint32_t **trees, size_t *n_trees,
                                  Err *err);

/* Counts the independent loops of each tree: segments - nodes + 1.
 *
 * trees   per segment: the index of its tree, from meshcheck_trees.
 * loops   receives, per tree, the number of its loops; free it with free(), also after an error. It
 *         must be NULL before the call.
 * Errors  STATUS_MEMORY. */
MUST_CHECK Status meshcheck_loops(const VesselTree *tree, const uint32_t *trees, size_t n_trees,
                                  uint32_t **loops, Err *err);

/* Fills components, genus, euler, open_edges, volume_mm3 and bridges of the report. Bridges are
 * triangles whose segment is in another tree than the rest of their component.
 *
 * trees    per segment: the index of its tree, from meshcheck_trees. NULL: bridges are not counted,
 *          and the report gets 0.
 * Errors   STATUS_MEMORY.
 * Cost     O(triangles). */
MUST_CHECK Status meshcheck_topology(const VesselMesh *mesh, const uint32_t *trees,
                                     MeshReport *report, Err *err);

/* Counts the pairs of triangles that cross. Two triangles cross if they have a common point that is
 * neither a common corner nor on a common edge. The result is exact, and does not depend on the
 * number of threads.
 *
 * grid_mm    grid step, a power of 2: all coordinates are integer multiples of it, below 2^25 times
 *            it in magnitude, for which the arithmetic is exact.
 * threads    number of threads; 0: one per processor.
 * crossed    per triangle: set to true if the triangle crosses another. The caller sets all
 *            elements to false before. NULL: not wanted.
 * crossings  receives the number of pairs.
 * Errors     STATUS_MEMORY. */
MUST_CHECK Status meshcheck_crossings(const VesselMesh *mesh, double grid_mm, int threads,
                                      atomic_bool *crossed, size_t *crossings, Err *err);

#endif
