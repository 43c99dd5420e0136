/* The two kinds of moves that refinement consists of. */
#ifndef CORCAST_GROW_REFINE_MOVE_H
#define CORCAST_GROW_REFINE_MOVE_H

#include "grow/refine/refine_arbor.h"
#include "grow/refine/refine_clearance.h"
#include "grow/refine/refine_penalty.h"

/* The state of the local search. */
typedef struct LocalSearch {
    Arbor arbor;
    Clearance clearance;
    Penalties penalties; /* while they are not active, no move breaks a rule of clearance */
    Random random;
    double reach;         /* mm; within which the nearest segments were found */
    uint64_t tried, kept; /* moves */
} LocalSearch;

/* Moves the bifurcation at the end of segment i to where S_root and penalties are less, if that is
 * allowed. Not for terminals. */
MUST_CHECK Status move_bifurcation(LocalSearch *search, int32_t i, Err *err);

/* Cuts segment i off, with all below it, and connects it where S_root and penalties are least among
 * the nearest segments, or where it was. With a `temperature` above 0, in units of S_root,
 * connections that cost more by that much are chosen with probability 1 / e relative to the best.
 * Root segments stay, and every subtree in its tree. */
MUST_CHECK Status move_subtree(LocalSearch *search, int32_t i, double temperature, Err *err);

#endif
