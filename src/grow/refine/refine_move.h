/* The two kinds of moves that refinement consists of. */
#ifndef CORCAST_GROW_REFINE_MOVE_H
#define CORCAST_GROW_REFINE_MOVE_H

#include "grow/refine/refine_arbor.h"
#include "grow/refine/refine_room.h"
#include "grow/refine/refine_toll.h"

typedef struct Surgery {
    Arbor arbor;
    Room room;
    Tolls tolls; /* while they are closed, no move breaks a rule of room */
    Random random;
    uint64_t tried, kept; /* moves */
} Surgery;

/* Moves the bifurcation at the end of segment i to where S_root and tolls are less, if that is
 * allowed. Not for terminals. */
MUST_CHECK Status move_bifurcation(Surgery *surgery, int32_t i, Err *err);

/* Cuts segment i off, with all below it, and connects it where S_root and tolls are least among the
 * nearest segments, or where it was. With a `temperature` above 0, in units of S_root, connections
 * that cost more by that much are chosen with probability 1 / e relative to the best. The root
 * segment stays. */
MUST_CHECK Status move_subtree(Surgery *surgery, int32_t i, double temperature, Err *err);

#endif
