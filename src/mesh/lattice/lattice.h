/* Extracts the surface of a junction region from a lattice of tetrahedra in an octree.
 *
 * The corners of the tetrahedra (the lattice points) are the corners and centres of the octree's
 * cells. The field is evaluated at the lattice points. A tetrahedron with corners inside and
 * outside the surface contributes one or two triangles. Private to the module mesh.
 *
 * lattice_make extracts the surface in and near active cells only. lattice_list and lattice_cut
 * serve latticerepair.h: lattice_list lists all tetrahedra, and lattice_cut extracts the surface
 * again after heights of lattice points were changed. */
#ifndef CORCAST_MESH_LATTICE_LATTICE_H
#define CORCAST_MESH_LATTICE_LATTICE_H

#include "mesh/lattice/patch.h"

/* A corner of tetrahedra, with the field's height there. */
typedef struct LatticePoint {
    Vec3 x;
    double height;    /* field_height at x; below 0: inside */
    uint32_t first;   /* of a point inside the surface: index of the first crossing on an edge from
                       * this point, or NO_CROSSING */
    bool is_repaired; /* true: the point counts as inside, although its field is outside
                       * [latticerepair.h] */
} LatticePoint;

/* Stands for no crossing. */
#define NO_CROSSING UINT32_MAX

/* The crossing of a lattice edge with the surface. Crossing i is point i of the patch. */
typedef struct LatticeCrossing {
    uint32_t outside; /* index of the lattice point at the end of the edge that is outside */
    uint32_t next;    /* index of the next crossing on an edge from the same inner lattice point, or
                       * NO_CROSSING */
} LatticeCrossing;

/* Indices of four lattice points. */
typedef struct Tetrahedron {
    uint32_t at[4];
} Tetrahedron;

typedef ARRAY(Tetrahedron) TetrahedronList;

/* Workspace of one thread, used again for the next region. Zero it before first use; release it
 * with lattice_release. All arrays are owned. */
typedef struct Lattice {
    LatticePoint *points; /* points[0] is not used, so that index 0 stands for none */
    size_t n_points, capacity;
    ARRAY(uint32_t) centers; /* per cell: index of the lattice point at its centre; 0: none yet */
    ARRAY(LatticeCrossing) crossings;
    KeyMap corners; /* maps the position of a corner of a cell to its lattice point */
} Lattice;

void lattice_release(Lattice *lattice);

/* Replaces the patch of `surface` by the region's surface, which octree_build has enclosed in
 * surface->tree. The surface is open only beyond the planes of stubs. Errors: STATUS_INFEASIBLE
 * [localfield_too_many_terms], STATUS_MEMORY. */
MUST_CHECK Status lattice_make(Lattice *lattice, const JunctionSurface *surface, Err *err);

/* Appends all tetrahedra of the octree to the list. The caller releases the list with
 * ARRAY_RELEASE, also after an error. Adds the lattice points that lattice_make did not need.
 * Errors: STATUS_INFEASIBLE, STATUS_MEMORY, as lattice_make. */
MUST_CHECK Status lattice_list(Lattice *lattice, const JunctionSurface *surface,
                               TetrahedronList *list, Err *err);

/* Replaces the patch by the surface that separates the lattice points by the current sign of their
 * heights, in all tetrahedra of the octree. Call lattice_list first. Errors: STATUS_INFEASIBLE,
 * STATUS_MEMORY, as lattice_make. */
MUST_CHECK Status lattice_cut(Lattice *lattice, const JunctionSurface *surface, Err *err);

#endif
