/* Clearance: checks that a move of the refinement keeps vessels inside the domain, longer than
 * their diameter, and clear of each other. clearance_init reserves space for all segments; per
 * move, clearance_allows tests the move, and clearance_update_grid enters it if it is kept;
 * clearance_reserve reserves anew from time to time.
 *
 * The rules apply to radii multiplied by `level`, a factor in [0, 1]: a segment must be longer than
 * its diameter, and the walls of two segments without a common node must not touch. Segments that
 * broke a rule before refinement may still break it, but no vessel gets deeper into another than it
 * was.
 *
 * Every segment has a reserved radius [refine_arbor.h]. Its reserved capsule is the set of points
 * within this radius of its axis. Reserved capsules of segments without a common node do not
 * intersect, unless the rules are suspended (clearance_suspend). */
#ifndef CORCAST_GROW_REFINE_REFINE_CLEARANCE_H
#define CORCAST_GROW_REFINE_REFINE_CLEARANCE_H

#include "domain/domain.h"
#include "grow/cco/grid.h"
#include "grow/refine/refine_arbor.h"
#include <math.h>

typedef struct Clearance {
    const Domain *domain; /* NULL: all of space */
    Box box;      /* bounds of the domain, or of the tree if there is none; bounds of the grid */
    double level; /* factor by which radii of vessels are multiplied, in [0, 1] */
    double min_length; /* mm; no segment is made shorter */
    double gap;        /* mm; minimum distance between walls; 1e-7 of the box's diagonal */
    double tree_gap;   /* mm; added to `gap` between vessels of different trees; if it is above 0,
                        * `level` is 1 */
    Grid grid;
    double *radius; /* per segment: mm, at the last clearance_reserve or clearance_suspend; owned */
    double *share;  /* workspace of clearance_reserve; owned */
    double kept;    /* fraction of the segments that kept the rules at the last clearance_reserve */
} Clearance;

/* Finds the greatest level (1, 1/2, ... 1/64, 0) at which at least 90 % of the segments keep the
 * rules, and reserves radii for all segments at this level.
 *
 * clearance  must be zeroed. Release it with clearance_release, also after an error.
 * domain     is borrowed; NULL: vessels may be anywhere.
 * tree_gap   minimum distance, mm, between the walls of different trees; 0: no further distance.
 * Errors     STATUS_INFEASIBLE if the level is below 1 and `tree_gap` above 0; STATUS_MEMORY. */
MUST_CHECK Status clearance_init(Clearance *clearance, const Domain *domain, double tree_gap,
                                 Arbor *arbor, Err *err);
void clearance_release(Clearance *clearance);

/* Computes the reserved radii of all segments: `level` times 1.1 times the present radii where
 * there is space, less elsewhere. Updates `radius`, the grid and all sums of the arbor
 * [arbor_sum]. Errors:
 * STATUS_MEMORY. Cost: O(n). */
MUST_CHECK Status clearance_reserve(Clearance *clearance, Arbor *arbor, Err *err);

/* Returns the minimum distance, mm, between the reserved capsules of segments i and j. For segments
 * of different trees this includes `tree_gap`. `tree_gap` is a distance between walls: if a segment
 * is wider than its reserved capsule, the excess is added. */
static inline double clearance_between(const Clearance *clearance, const Arbor *arbor, int32_t i,
                                       int32_t j)
{
    if (!(clearance->tree_gap > 0) || arbor_is_same_tree(arbor, i, j))
        return clearance->gap;
    double spare = fmax(0, clearance->radius[i] - arbor->shape[i].reserved_radius) +
                   fmax(0, clearance->radius[j] - arbor->shape[j].reserved_radius);
    return clearance->gap + clearance->tree_gap + spare;
}

/* Returns the search radius, mm: if segment i reserves `reserved_radius`, mm, it can only be too
 * near to segments whose capsule in the grid is within this distance of the axis of segment i. */
double clearance_search_radius(const Clearance *clearance, int32_t i, double reserved_radius);
/* Returns the smallest distance, mm, between the axes of segments i and j at which both keep the
 * rules, with the radii of the last clearance_reserve. */
double clearance_axis_distance(const Clearance *clearance, const Arbor *arbor, int32_t i,
                               int32_t j);

/* Returns true if segment i kept the rules at the last clearance_reserve. */
static inline bool clearance_is_kept(const Clearance *clearance, const Arbor *arbor, int32_t i)
{
    return arbor->shape[i].reserved_radius >= clearance->level * clearance->radius[i];
}

/* Ratio of reserved radii to radii times `level` while the rules are suspended. It is above 1
 * because radii grow slightly until the next reservation. A larger ratio would keep vessels
 * farther apart than the rules require. */
#define SUSPENDED_RESERVE 1.05

/* Suspends the rules until the next clearance_reserve: reserves SUSPENDED_RESERVE times `level`
 * times the radius for every segment, even if reserved capsules then intersect, and removes the
 * limits of radii (Branch.inverse_limit = 0). Penalties [refine_penalty.h] are computed from these
 * reserved radii. Errors: STATUS_MEMORY. Cost: O(n). */
MUST_CHECK Status clearance_suspend(Clearance *clearance, Arbor *arbor, Err *err);

/* Returns true if segment i is inside the domain and not shorter than min_length. Without a
 * domain, only the length counts. */
bool clearance_holds_segment(const Clearance *clearance, const Arbor *arbor, int32_t i);

/* Returns true if all segments that the present move has placed are inside the domain and not
 * shorter than min_length. Without a domain, only the lengths count. */
bool clearance_holds_move(const Clearance *clearance, const Arbor *arbor);

/* Returns true if the present move [arbor_begin] keeps the rules. In this case it has updated
 * reserved radii in the arbor: to 1.04 to 1.1 times `level` times the radius for the segments that
 * moved, and to at least the new radius for other segments that the move made wider than their
 * reservation. If it returns false, the caller must call arbor_undo, which restores the reserved
 * radii. */
bool clearance_allows(const Clearance *clearance, Arbor *arbor);

/* Updates the grid after a move: enters the segments that the move changed, at their new
 * positions. Call it for every move that is kept. Errors: STATUS_MEMORY. */
MUST_CHECK Status clearance_update_grid(Clearance *clearance, const Arbor *arbor, Err *err);

#endif
