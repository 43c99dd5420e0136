/* The wall of a junction junction, from the tetrahedra of an octree. */
#ifndef CORCAST_MESH_LATTICE_LATTICE_H
#define CORCAST_MESH_LATTICE_LATTICE_H

#include "base/base.h"
#include "mesh/lattice/octree.h"
#include "mesh/lattice/patch.h"

/* A point where the field is known. */
typedef struct LatticePoint {
    Vec3 x;
    double height;    /* field_height there: below 0 inside */
    uint32_t first;   /* of a point inside: crossing on an edge that begins there, or NO_CROSSING */
    bool is_repaired; /* made inside, though it is not [mend.h] */
} LatticePoint;

#define NO_CROSSING UINT32_MAX

/* Where an edge crosses the wall: a point of the patch of the same number. */
typedef struct LatticeCrossing {
    uint32_t outside; /* where the edge ends */
    uint32_t next;    /* crossing on an edge that begins at the same point, or NO_CROSSING */
} LatticeCrossing;

typedef struct Tetrahedron {
    uint32_t at[4]; /* points */
} Tetrahedron;

typedef ARRAY(Tetrahedron) TetrahedronList;

/* What one thread needs; zeroed before the first use, and kept for the next junction. */
typedef struct Lattice {
    LatticePoint *points; /* owned, as all of it */
    size_t n_points, capacity;
    uint32_t *centers; /* points, one a cell; 0: not yet */
    size_t center_capacity;
    LatticeCrossing *crossings;
    size_t crossing_capacity;
    KeyMap corners; /* place in the lattice -> point */
} Lattice;

void lattice_release(Lattice *lattice);

/* Puts the wall into *patch, which is emptied first. It is open only behind planes. */
MUST_CHECK Status lattice_make(Lattice *lattice, const Octree *tree, const JunctionPlan *plan,
                               Patch *patch, Err *err);

/* Adds all tetrahedra of the octree to the list, and the points that lattice_make had no need of to
 * the lattice. */
MUST_CHECK Status lattice_list(Lattice *lattice, Octree *tree, const JunctionPlan *plan,
                               TetrahedronList *list, Err *err);

/* The wall again, of the points that lattice_list has left, whatever their heights are now; also
 * away from where the field has it. */
MUST_CHECK Status lattice_cut(Lattice *lattice, Octree *tree, const JunctionPlan *plan,
                              Patch *patch, Err *err);

#endif
