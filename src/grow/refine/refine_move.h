/* The two moves of the local search that refines a tree: a bifurcation moves to a better position,
 * or a subtree is cut off and connected elsewhere. */
#ifndef CORCAST_GROW_REFINE_REFINE_MOVE_H
#define CORCAST_GROW_REFINE_REFINE_MOVE_H

#include "grow/refine/refine_arbor.h"
#include "grow/refine/refine_clearance.h"
#include "grow/refine/refine_penalty.h"

/* The state of the local search. */
typedef struct LocalSearch {
    Arbor arbor;
    Clearance clearance;
    Penalties penalties; /* while they are not active, no move breaks a rule of clearance */
    Random random;
    double reach;         /* mm; distance within which the last nearest segments were found */
    uint64_t tried, kept; /* numbers of moves */
} LocalSearch;

/* Moves the bifurcation at the end of segment i, which is not a terminal, to a position with a
 * lower sum of S_root [law.h] and penalties. Leaves the arbor as it was if no such position was
 * found that the rules of clearance allow. Counts in `tried` and `kept`. Errors: STATUS_MEMORY. */
MUST_CHECK Status move_bifurcation(LocalSearch *search, int32_t i, Err *err);

/* Cuts segment i off, with all segments below it, and connects it to one of the nearest segments,
 * or again where it was. Root segments are not moved, and every subtree stays in its tree. Counts
 * in `tried` and `kept`.
 *
 * temperature   0 chooses the connection with the lowest S_root and penalties. Above 0, in units of
 *               S_root: a connection that costs that much more than the best has 1 / e of the best
 *               connection's probability.
 * Errors        STATUS_MEMORY. */
MUST_CHECK Status move_subtree(LocalSearch *search, int32_t i, double temperature, Err *err);

#endif
