/* The two moves of the local search that refines a tree: a bifurcation moves to a better position,
 * or a subtree is cut off and connected elsewhere. Both lower the cost of the tree, S_root [law.h],
 * plus penalties for broken rules of clearance. refine.c, the caller, sets up and releases the
 * members of LocalSearch. */
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
    double reach;         /* mm; search distance for nearest segments, which adapts from search to
                           * search [grid_nearest_adaptive]; 0 at first */
    uint64_t tried, kept; /* number of moves that were tried, and number that were kept */
} LocalSearch;

/* Moves the bifurcation at the distal end of segment i to a position with a lower sum of S_root and
 * penalties. Segment i must not be a terminal segment. Leaves the arbor unchanged if it finds no
 * such position that the rules of clearance allow. Updates `tried` and `kept`. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status move_bifurcation(LocalSearch *search, int32_t i, Err *err);

/* Cuts off segment i with its subtree, and connects it to one of the nearest segments of the same
 * tree, or again at its old position. Does nothing for a root segment. Updates `tried` and `kept`.
 *
 * temperature   0 chooses the connection with the lowest sum of S_root and penalties. Above 0, the
 *               connection is random: one whose sum exceeds the lowest by `temperature` has 1 / e
 *               of the probability of the best.
 * Errors        STATUS_MEMORY. */
MUST_CHECK Status move_subtree(LocalSearch *search, int32_t i, double temperature, Err *err);

#endif
