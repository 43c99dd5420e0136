/* Closes tunnels and hollows of a region's surface that are narrower than the cells of the lattice.
 *
 * Such tunnels are artefacts: where two vessels part at a small angle, the groove between them is
 * narrower than any cell. The repair marks lattice points in the tunnels as inside, so that the
 * surface gets the topology of a ball, with one tunnel per loop of the region's vessels. Private to
 * the module mesh. */
#ifndef CORCAST_MESH_LATTICE_LATTICEREPAIR_H
#define CORCAST_MESH_LATTICE_LATTICEREPAIR_H

#include "mesh/lattice/lattice.h"

/* Workspace of one thread. Zero it before first use; release it with repairer_release. */
typedef struct Repairer {
    TetrahedronList all;   /* all tetrahedra of the octree */
    IndexLists around;     /* per lattice point: its tetrahedra */
    ARRAY(uint8_t) states; /* per lattice point: PointState of latticerepair.c */
    ARRAY(uint32_t) slots; /* per lattice point: its position in the current link */
    Heap heap;             /* points that may be added to the outside, lowest field first */
} Repairer;

void repairer_release(Repairer *repairer);

/* Replaces the surface that lattice_make left in the patch by a surface that bounds a ball with
 * n_loops tunnels. The stubs of the region lead out of the ball through their planes. Lattice
 * points in other tunnels and in hollows become inside.
 *
 * farthest  in local radii: a tunnel with a point farther from the surface is too wide to be an
 *           artefact of the lattice. If there is one, the patch stays as it was.
 * width     receives the maximum distance from the surface of the points that became inside, in
 *           local radii; HUGE_VAL if the surface meets the faces of the octree's root.
 * Errors    STATUS_INFEASIBLE [localfield_refuse], STATUS_MEMORY. */
MUST_CHECK Status repair_apply(Repairer *repairer, Lattice *lattice, const JunctionSurface *surface,
                               double farthest, double *width, Err *err);

#endif
