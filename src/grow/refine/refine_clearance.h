/* Clearance: tests whether a move of the refinement leaves vessels inside the domain, longer than
 * their diameter, and clear of each other.
 *
 * A move changes radii in the whole tree, so a test of the moved segments alone is not enough.
 * Every segment therefore has a reserved radius [refine_arbor.h], to which it may widen. Its
 * reserved capsule is the set of points within this radius of its axis. Reserved capsules of
 * segments without a common node do not intersect, unless the rules are suspended
 * (clearance_suspend). While no radius exceeds its reserved radius, all vessels are clear.
 *
 * clearance_init reserves radii for all segments. Per move, clearance_allows tests the move, and
 * clearance_update_grid enters an accepted move in the grid. After every few rounds of moves, the
 * caller calls clearance_reserve, which computes all reserved radii again.
 *
 * The rules apply to radii multiplied by `level`, a factor in [0, 1]: a segment must be longer than
 * its diameter, and the walls of two segments without a common node must not touch. The level is
 * below 1 if too many vessels of the given tree break the rules at their full radii
 * [clearance_init]. Segments that broke a rule before refinement may still break it, but no vessel
 * gets deeper into another than it was. */
#ifndef CORCAST_GROW_REFINE_REFINE_CLEARANCE_H
#define CORCAST_GROW_REFINE_REFINE_CLEARANCE_H

#include "domain/domain.h"
#include "grow/cco/grid.h"
#include "grow/refine/refine_arbor.h"
#include <math.h>

typedef struct Clearance {
    const Domain *domain; /* NULL: all of space */
    Box box;      /* bounds of the domain, or of the tree if there is none; bounds of the grid */
    double level; /* factor by which the rules multiply radii, in [0, 1] */
    double min_length; /* mm; no move makes a segment shorter; 1e-3 of the initial mean length */
    double gap;        /* mm; minimum distance between walls; 1e-7 of the box's diagonal, a margin
                        * for rounding */
    double tree_gap;   /* mm; added to `gap` between vessels of different trees; if it is above 0,
                        * `level` is 1 */
    Grid grid;
    double *radius; /* per segment: mm, at the last clearance_reserve or clearance_suspend; owned */
    double *share;  /* workspace of clearance_reserve; owned */
    double clear_fraction; /* of the segments: those that kept the rules at the last
                              clearance_reserve */
} Clearance;

/* Finds the greatest level (1, 1/2, ... 1/64, 0) at which at least 90 % of the segments keep the
 * rules, and reserves radii for all segments at this level. At 1/64, nearly only centrelines count.
 * With more than 10 % of broken segments, which may break their rules further, too little would be
 * protected.
 *
 * clearance  must be zeroed. Release it with clearance_release, also after an error.
 * domain     is borrowed; NULL: vessels may be anywhere.
 * tree_gap   minimum distance, mm, between the walls of different trees; 0: no further distance.
 * Errors     STATUS_INFEASIBLE if the level is below 1 and `tree_gap` above 0; STATUS_MEMORY. */
MUST_CHECK Status clearance_init(Clearance *clearance, const Domain *domain, double tree_gap,
                                 Arbor *arbor, Err *err);
void clearance_release(Clearance *clearance);

/* Computes the reserved radii of all segments: `level` times 1.1 times the present radii where
 * there is space, less elsewhere. The reserve of 10 % lets a vessel widen slightly in later moves.
 * Updates `radius`, the grid and all sums of the arbor [arbor_sum]. Errors: STATUS_MEMORY. Cost:
 * O(n). */
MUST_CHECK Status clearance_reserve(Clearance *clearance, Arbor *arbor, Err *err);

/* Returns the minimum distance, mm, between the reserved capsules of segments i and j. For segments
 * of different trees this includes `tree_gap`. Because `tree_gap` is a distance between walls, the
 * excess of a segment's radius over its reserved radius is added. */
static inline double clearance_between(const Clearance *clearance, const Arbor *arbor, int32_t i,
                                       int32_t j)
{
    if (!(clearance->tree_gap > 0) || arbor_is_same_tree(arbor, i, j))
        return clearance->gap;
    double spare = fmax(0, clearance->radius[i] - arbor->shape[i].reserved_radius) +
                   fmax(0, clearance->radius[j] - arbor->shape[j].reserved_radius);
    return clearance->gap + clearance->tree_gap + spare;
}

/* Returns the distance, mm, from the axis of segment i within which the grid must be searched: all
 * segments that are too near to segment i, if it reserves `reserved_radius` mm, have their capsules
 * in the grid within this distance. */
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
 * because radii grow slightly until the next reservation. With a larger ratio, penalties would keep
 * vessels farther apart than the rules require. */
#define SUSPENDED_RESERVE 1.05

/* Suspends the rules until the next clearance_reserve: reserves SUSPENDED_RESERVE times `level`
 * times the radius for every segment, even if reserved capsules then intersect, and removes the
 * limits of radii (Branch.inverse_limit = 0). Penalties [refine_penalty.h] are computed from these
 * reserved radii. Errors: STATUS_MEMORY. Cost: O(n). */
MUST_CHECK Status clearance_suspend(Clearance *clearance, Arbor *arbor, Err *err);

/* Returns true if segment i is inside the domain and not shorter than min_length. Without a domain,
 * only the length is tested. */
bool clearance_holds_segment(const Clearance *clearance, const Arbor *arbor, int32_t i);

/* Returns true if all segments that the present move has placed are inside the domain and not
 * shorter than min_length. Without a domain, only the lengths are tested. */
bool clearance_holds_move(const Clearance *clearance, const Arbor *arbor);

/* Returns true if the present move [arbor_begin] keeps the rules, which must not be suspended. It
 * has then updated the reserved radii of two kinds of segments in the arbor. Segments that moved
 * reserve between 1.04 and 1.1 times `level` times their radius; below 1.04, a later move could
 * hardly widen them. Other segments that the move made wider than their reservation reserve at
 * least their new radius. If the function returns false, the caller must call arbor_undo, which
 * restores the reserved radii. */
bool clearance_allows(const Clearance *clearance, Arbor *arbor);

/* Updates the grid after an accepted move: enters the segments that the move changed, at their new
 * positions. Errors: STATUS_MEMORY. */
MUST_CHECK Status clearance_update_grid(Clearance *clearance, const Arbor *arbor, Err *err);

#endif
