/* Closes tunnels and cavities of the surface of a junction region [regions/junctions.h] that are
 * narrower than a cell of the lattice. lattice_repair is called after lattice_make.
 *
 * These tunnels are artefacts. Where two vessels diverge at a small angle, the groove between them
 * is narrower than any cell. The repair marks lattice points in the tunnels as inside. The inside
 * is then a handlebody: a ball, with one handle per loop of the region's vessels. Private to the
 * module mesh. */
#ifndef CORCAST_MESH_LATTICE_LATTICEREPAIR_H
#define CORCAST_MESH_LATTICE_LATTICEREPAIR_H

#include "mesh/lattice/lattice.h"

/* Replaces the surface in surface->patch, which lattice_make made, by the surface of a handlebody
 * with surface->plan->n_loops handles. Lattice points in all other tunnels and in cavities become
 * inside. The vessels that continue in other regions still cross the surface at the planes of their
 * stubs.
 *
 * lattice       from lattice_make. It receives more points, and the height [LatticePoint] of a
 *               repaired point changes its sign.
 * max_distance  maximum distance of a repaired point from the surface, in local radii, finite. A
 *               tunnel with a point farther from the surface is too wide to be an artefact of the
 *               lattice. The patch then stays unchanged, and STATUS_OK is returned.
 * distance      receives the largest distance from the surface, in local radii, of the points that
 *               became inside, or, if it exceeds max_distance, that would have become inside.
 *               HUGE_VAL: the surface meets the faces of the octree's root cube, and the patch
 *               stays unchanged.
 * Errors        STATUS_INFEASIBLE [localfield_too_many_terms], STATUS_MEMORY. */
MUST_CHECK Status lattice_repair(Lattice *lattice, const JunctionSurface *surface,
                                 double max_distance, double *distance, Err *err);

#endif
