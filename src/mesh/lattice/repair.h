/* Closing what is narrower than the cells of a lattice. */
#ifndef CORCAST_MESH_LATTICE_REPAIR_H
#define CORCAST_MESH_LATTICE_REPAIR_H

#include "mesh/lattice/lattice.h"

/* A point that may be given to the outside. */
typedef struct MendItem {
    double height;
    uint32_t point;
} MendItem;

/* Workspace of a thread; zeroed before the first use. */
typedef struct Mender {
    TetrahedronList all;
    uint32_t *first, *around; /* of each point: its tetrahedra, around[first[i] .. first[i + 1]) */
    uint8_t *states;          /* one a point */
    uint32_t *slots;          /* one a point: its place in the link that is looked at */
    MendItem *heap;
    size_t n_heap, heap_capacity, first_capacity, around_capacity, state_capacity, slot_capacity;
} Mender;

void mender_release(Mender *mender);

/* Takes the wall that lattice_make has left in *patch for another one that bounds a ball, which the
 * arms of the zone leave through the planes; points of the lattice that lie in tunnels and hollows
 * become inside for that. *width is how far they are from the wall at most, over the local radius;
 * where it is above `farthest`, the patch stays as it was: a tunnel so wide is no flaw of the
 * lattice. */
MUST_CHECK Status mend_make(Mender *mender, Lattice *lattice, ZoneTree *tree, const ZonePlan *plan,
                            double farthest, Patch *patch, double *width, Err *err);

#endif
