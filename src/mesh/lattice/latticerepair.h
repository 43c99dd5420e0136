/* Closes tunnels and hollows that are narrower than the cells of a lattice. */
#ifndef CORCAST_MESH_LATTICE_LATTICEREPAIR_H
#define CORCAST_MESH_LATTICE_LATTICEREPAIR_H

#include "mesh/lattice/lattice.h"

/* Workspace of one thread. Zero it before first use; release it with repairer_release. */
typedef struct Repairer {
    TetrahedronList all;
    IndexLists around;     /* per lattice point: its tetrahedra */
    ARRAY(uint8_t) states; /* per lattice point */
    ARRAY(uint32_t) slots; /* per lattice point: its position in the current link */
    Heap heap;             /* points outside that may be joined to the outside */
} Repairer;

void repairer_release(Repairer *repairer);

/* Replaces the surface that lattice_make left in the patch by one that bounds a ball, from which
 * the stubs of the region lead out through their planes. Lattice points in tunnels and hollows
 * become inside for that.
 *
 * farthest  in local radii: a wider tunnel is not an artefact of the lattice. If there is one, the
 *           patch stays as it was.
 * width     receives the maximum distance from the surface of the points that became inside, in
 * local radii; HUGE_VAL if the surface meets the faces of the octree's root. Errors STATUS_MEMORY.
 */
MUST_CHECK Status repair_apply(Repairer *repairer, Lattice *lattice, const JunctionSurface *surface,
                               double farthest, double *width, Err *err);

#endif
