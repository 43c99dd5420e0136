/* Closes tunnels and hollows of a region's surface that are narrower than the cells of the lattice.
 * repair_apply is called after lattice_make.
 *
 * These tunnels are artefacts. Where two vessels diverge at a small angle, the groove between them
 * is narrower than any cell. The repair marks lattice points in the tunnels as inside. The surface
 * then has the topology of a ball, with one tunnel per loop of the region's vessels. Private to the
 * module mesh. */
#ifndef CORCAST_MESH_LATTICE_LATTICEREPAIR_H
#define CORCAST_MESH_LATTICE_LATTICEREPAIR_H

#include "mesh/lattice/lattice.h"

/* Replaces the surface that lattice_make left in the patch by a surface that bounds a ball with
 * n_loops tunnels. Lattice points in all other tunnels and in hollows become inside. Stubs of the
 * region leave the ball through their planes.
 *
 * lattice   from lattice_make. It receives more points, and the heights of repaired points change
 *           sign.
 * farthest  maximum distance of a repaired point from the surface, in local radii, finite. A tunnel
 *           with a point farther from the surface is too wide to be an artefact of the lattice; the
 *           patch then stays unchanged.
 * width     receives the largest distance from the surface, in local radii, of the points that
 *           became inside, or, if the patch stays unchanged, that would have become inside.
 *           HUGE_VAL: the surface meets the faces of the octree's root; the patch then stays
 *           unchanged.
 * Errors    STATUS_INFEASIBLE [localfield_refuse], STATUS_MEMORY. */
MUST_CHECK Status repair_apply(Lattice *lattice, const JunctionSurface *surface, double farthest,
                               double *width, Err *err);

#endif
