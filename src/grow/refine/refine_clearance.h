/* Clearance: the rules that vessels keep while they move. Vessels stay inside the domain, longer
 * than wide, and clear of each other.
 *
 * Vessels count at their radius times the `level`, in [0, 1]. A segment must be longer than wide,
 * and two segments without a common node must be further apart than the sum of their radii. Where
 * the tree broke these rules before refinement it may still break them, but no vessel gets deeper
 * into another than it was.
 *
 * Every segment has a reserved radius [refine_arbor.h], which no other segment's reserved radius
 * meets. */
#ifndef CORCAST_GROW_REFINE_REFINE_CLEARANCE_H
#define CORCAST_GROW_REFINE_REFINE_CLEARANCE_H

#include "domain/domain.h"
#include "grow/cco/grid.h"
#include "grow/refine/refine_arbor.h"
#include <math.h>

typedef struct Clearance {
    const Domain *domain; /* NULL: all of space */
    Box box;
    double level;        /* factor by which radii of vessels are multiplied, in [0, 1] */
    double least_length; /* mm; no segment is made shorter */
    double gap;          /* mm; minimum distance beyond the radii */
    double apart; /* mm; further distance between vessels of different trees; if it is above 0,
                   * `level` is 1 */
    Grid grid;
    double *radius; /* per segment, mm, of the last clearance_reserve or clearance_waive; owned */
    double *share;  /* workspace of clearance_reserve; owned */
    double kept;    /* share of the segments that kept the rules at the last clearance_reserve */
} Clearance;

/* Finds the greatest level (1, 1/2, ... 1/64, 0) at which nine in ten segments of the tree keep the
 * rules, and reserves radii for all segments at this level.
 *
 * clearance  must be zeroed. Release it with clearance_release, also after an error.
 * domain     is borrowed; NULL: vessels may be anywhere.
 * apart      is the member `apart`, in mm.
 * Errors     STATUS_INFEASIBLE if the level is below 1 and `apart` above 0; STATUS_MEMORY. */
MUST_CHECK Status clearance_init(Clearance *clearance, const Domain *domain, double apart,
                                 Arbor *arbor, Err *err);
void clearance_release(Clearance *clearance);

/* Computes the reserved radii of all segments: `level` times 1.1 times the present radii where
 * there is room, less elsewhere. Updates `radius`, the grid and all sums of the arbor. Errors:
 * STATUS_MEMORY. Cost: O(n). */
MUST_CHECK Status clearance_reserve(Clearance *clearance, Arbor *arbor, Err *err);

/* Returns the minimum distance, mm, between the reserved capsules of segments i and j. Between
 * different trees it includes the clearance of the trees, which is measured between walls, and
 * therefore also how much wider each segment is than its reservation. */
static inline double clearance_between(const Clearance *clearance, const Arbor *arbor, int32_t i,
                                       int32_t j)
{
    if (!(clearance->apart > 0) || arbor_is_same_tree(arbor, i, j))
        return clearance->gap;
    double spare = fmax(0, clearance->radius[i] - arbor->shape[i].reserved_radius) +
                   fmax(0, clearance->radius[j] - arbor->shape[j].reserved_radius);
    return clearance->gap + clearance->apart + spare;
}

/* Returns the distance, mm, from the axis of segment i within which segments may be too near, if
 * segment i reserves `reserved_radius`, mm. */
double clearance_reach(const Clearance *clearance, int32_t i, double reserved_radius);
/* Returns the minimum distance, mm, of the centrelines of segments i and j at which both keep the
 * rules, by the radii of the last clearance_reserve. */
double clearance_due(const Clearance *clearance, const Arbor *arbor, int32_t i, int32_t j);

/* Returns true if segment i kept the rules at the last clearance_reserve. */
static inline bool clearance_is_kept(const Clearance *clearance, const Arbor *arbor, int32_t i)
{
    return arbor->shape[i].reserved_radius >= clearance->level * clearance->radius[i];
}

/* Ratio of reserved radii to radii while the rules are suspended: radii grow slightly until they
 * are reserved again. Reason for 1.05 not recorded. */
#define WAIVED_RESERVE 1.05

/* Suspends the rules: reserves WAIVED_RESERVE times `level` times its radius for every segment,
 * whether there is room or not, and removes the limits of radii. Penalties [refine_penalty.h] are
 * computed from these reserved radii. Errors: STATUS_MEMORY. Cost: O(n). */
MUST_CHECK Status clearance_waive(Clearance *clearance, Arbor *arbor, Err *err);

/* Returns true if segment i is inside the domain and not shorter than least_length. */
bool clearance_is_held(const Clearance *clearance, const Arbor *arbor, int32_t i);

/* Returns true if the segments that the present move has placed are inside the domain and not
 * shorter than least_length. */
bool clearance_is_inside(const Clearance *clearance, const Arbor *arbor);

/* Returns true if the present move [arbor_begin] keeps the rules. Then it has reserved radii in the
 * arbor: 1.04 to 1.1 times the radius for segments that moved, and enough for segments whose radii
 * exceed their reservations because of the move. If it returns false, the caller must call
 * arbor_undo. */
bool clearance_allows(const Clearance *clearance, Arbor *arbor);

/* Updates the grid after a move: enters the segments that the move changed with their new
 * positions. Call it for every move that is kept. Errors: STATUS_MEMORY. */
MUST_CHECK Status clearance_follow(Clearance *clearance, const Arbor *arbor, Err *err);

#endif
