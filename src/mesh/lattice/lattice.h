/* Extracts the surface of a junction region from the tetrahedra of an octree. */
#ifndef CORCAST_MESH_LATTICE_LATTICE_H
#define CORCAST_MESH_LATTICE_LATTICE_H

#include "mesh/lattice/patch.h"

/* A point where the field is known. */
typedef struct LatticePoint {
    Vec3 x;
    double height;  /* field_height at x; below 0: inside */
    uint32_t first; /* of a point inside: a crossing on an edge that begins here, or NO_CROSSING */
    bool is_repaired; /* counts as inside although the field says outside [latticerepair.h] */
} LatticePoint;

#define NO_CROSSING UINT32_MAX

/* The place where an edge crosses the surface: the point of the patch with the same index. */
typedef struct LatticeCrossing {
    uint32_t outside; /* the lattice point where the edge ends */
    uint32_t next;    /* a crossing on another edge that begins at the same point, or NO_CROSSING */
} LatticeCrossing;

/* Indices of four lattice points. */
typedef struct Tetrahedron {
    uint32_t at[4];
} Tetrahedron;

typedef ARRAY(Tetrahedron) TetrahedronList;

/* Workspace of one thread, used again for the next region. Zero it before first use; release it
 * with lattice_release. All arrays are owned. */
typedef struct Lattice {
    LatticePoint *points; /* the first is not used */
    size_t n_points, capacity;
    ARRAY(uint32_t) centers; /* per cell: the lattice point at its centre; 0: not made yet */
    ARRAY(LatticeCrossing) crossings;
    KeyMap corners; /* position of a cell's corner -> lattice point */
} Lattice;

void lattice_release(Lattice *lattice);

/* Replaces the patch by the region's surface. It is open only behind the planes of stubs. Errors:
 * STATUS_INFEASIBLE [localfield_refuse], STATUS_MEMORY. */
MUST_CHECK Status lattice_make(Lattice *lattice, const JunctionSurface *surface, Err *err);

/* Appends all tetrahedra of the octree to the list. Adds the lattice points that lattice_make did
 * not need. Errors: as lattice_make. */
MUST_CHECK Status lattice_list(Lattice *lattice, const JunctionSurface *surface,
                               TetrahedronList *list, Err *err);

/* Replaces the patch by the surface that the current heights of the points after lattice_list give,
 * also away from where the field has a surface. Errors: as lattice_make. */
MUST_CHECK Status lattice_cut(Lattice *lattice, const JunctionSurface *surface, Err *err);

#endif
