/* Closes tunnels and hollows of a region's surface that are narrower than the cells of the lattice.
 *
 * Such tunnels are artefacts: where two vessels part at a small angle, the groove between them is
 * narrower than any cell. The repair marks lattice points in the tunnels as inside, so that the
 * surface gets the topology of a ball, with one tunnel per loop of the region's vessels. Private to
 * the module mesh. */
#ifndef CORCAST_MESH_LATTICE_LATTICEREPAIR_H
#define CORCAST_MESH_LATTICE_LATTICEREPAIR_H

#include "mesh/lattice/lattice.h"

/* Replaces the surface that lattice_make left in the patch by a surface that bounds a ball with
 * n_loops tunnels. The stubs of the region lead out of the ball through their planes. Lattice
 * points in other tunnels and in hollows become inside.
 *
 * lattice   from lattice_make. Gets more points, and the heights of repaired points change sign.
 * farthest  in local radii, finite: a tunnel with a point farther from the surface is too wide to
 *           be an artefact of the lattice. If there is one, the patch stays as it was.
 * width     receives the maximum distance from the surface, in local radii, of the points that
 *           became inside, or would have become inside. Receives HUGE_VAL if the surface meets the
 *           faces of the octree's root; the patch then stays as it was.
 * Errors    STATUS_INFEASIBLE [localfield_refuse], STATUS_MEMORY. */
MUST_CHECK Status repair_apply(Lattice *lattice, const JunctionSurface *surface, double farthest,
                               double *width, Err *err);

#endif
