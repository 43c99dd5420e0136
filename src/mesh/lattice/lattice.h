/* Extracts the surface of a junction region from a lattice of tetrahedra in an octree.
 *
 * The corners of the tetrahedra (the lattice points) are the corners and centres of the octree's
 * cells. The field is evaluated at the lattice points. A tetrahedron with corners inside and
 * outside the surface contributes one or two triangles. Private to the module mesh.
 *
 * lattice_make extracts the surface in and near active cells only: those that the surface may pass
 * through [octree.h]. latticerepair.h then changes heights of lattice points. It uses lattice_list,
 * which lists all tetrahedra, and lattice_extract_again, which extracts the surface again. */
#ifndef CORCAST_MESH_LATTICE_LATTICE_H
#define CORCAST_MESH_LATTICE_LATTICE_H

#include "mesh/lattice/patch.h"

/* A corner of tetrahedra, with the field's height there: a function of the field that is 0 on the
 * surface [field_height, junctionfield.h]. */
typedef struct LatticePoint {
    Vec3 x;
    double height;    /* field_height at x; below 0: inside */
    uint32_t first;   /* of a point inside the surface: index of the first crossing in the list of
                       * crossings on edges from this point, or NO_CROSSING */
    bool is_repaired; /* true: the point counts as inside, although its field is outside
                       * [latticerepair.h] */
} LatticePoint;

/* Stands for no crossing. */
#define NO_CROSSING UINT32_MAX

/* The crossing of a lattice edge with the surface. Crossing i is point i of the patch. */
typedef struct LatticeCrossing {
    uint32_t outside; /* index of the lattice point at the end of the edge that is outside */
    uint32_t next; /* index of the next crossing in the list of the edge's inner lattice point, or
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

/* Replaces *surface->patch by the region's surface. surface->tree must be the octree that
 * octree_build made around it. The surface is open only where vessels leave the region, beyond the
 * planes of their stubs. Errors: STATUS_INFEASIBLE if more than MAX_LOCAL_TERMS segments come
 * together at one point [localfield_too_many_terms], STATUS_MEMORY. */
MUST_CHECK Status lattice_make(Lattice *lattice, const JunctionSurface *surface, Err *err);

/* Appends all tetrahedra of the octree to the list. The caller releases the list with
 * ARRAY_RELEASE, also after an error. Adds the lattice points that lattice_make did not need.
 * Errors: STATUS_INFEASIBLE, STATUS_MEMORY, as lattice_make. */
MUST_CHECK Status lattice_list(Lattice *lattice, const JunctionSurface *surface,
                               TetrahedronList *list, Err *err);

/* Extracts the patch again, from all tetrahedra of the octree, as the surface between lattice
 * points of negative and of positive height. Call lattice_list first. Errors: STATUS_INFEASIBLE,
 * STATUS_MEMORY, as lattice_make. */
MUST_CHECK Status lattice_extract_again(Lattice *lattice, const JunctionSurface *surface, Err *err);

#endif
