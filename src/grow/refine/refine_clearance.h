/* Clearance: vessels stay inside the domain, longer than wide, and clear of each other, whatever
 * moves.
 *
 * Vessels count at their radius times the `level`, in [0, 1]. A segment has to be longer than wide,
 * and two segments without a common node further apart than their radii. Where the tree that came
 * in broke these rules it may stay so, but no vessel gets deeper into another than it was.
 *
 * Every segment has a reserved radius [refine_arbor.h] that no other's reserved radius meets. */
#ifndef CORCAST_GROW_REFINE_CLEARANCE_H
#define CORCAST_GROW_REFINE_CLEARANCE_H

#include "domain/domain.h"
#include "grow/cco/grid.h"
#include "grow/refine/refine_arbor.h"
#include <math.h>

typedef struct Clearance {
    const Domain *domain; /* NULL: all of space */
    Box box;
    double level;        /* vessels count at their radii times this */
    double least_length; /* mm; no segment is made shorter */
    double gap;          /* mm; least distance beyond the radii */
    double apart;        /* mm; as much more between vessels of different trees; level is 1 then */
    Grid grid;
    double *radius; /* of each segment, mm, as of the last clearance_reserve or clearance_waive */
    double *share;  /* workspace of clearance_reserve */
} Clearance;

/* Finds the greatest level (1, 1/2, ... 1/64, 0) at which nine in ten segments of the tree keep the
 * rules, and reserves radii at it; `apart` mm is as above. `domain` is borrowed; NULL: anywhere.
 * Start from (Clearance){0}; ends with clearance_release, also on failure: STATUS_INFEASIBLE when
 * the level is below 1 and `apart` above 0, and STATUS_MEMORY. */
MUST_CHECK Status clearance_init(Clearance *clearance, const Domain *domain, double apart,
                                 Arbor *arbor, Err *err);
void clearance_release(Clearance *clearance);

/* Reserves radii for all segments anew, a tenth above the present ones where there is room, and
 * sums up the arbor. O(n). STATUS_MEMORY. */
MUST_CHECK Status clearance_reserve(Clearance *clearance, Arbor *arbor, Err *err);

/* The least distance between what segments i and j reserve. Between different trees it holds the
 * clearance of the trees, and besides by how much each segment is wider than what it reserves: the
 * clearance is one of walls. */
static inline double clearance_between(const Clearance *clearance, const Arbor *arbor, int32_t i,
                                       int32_t j)
{
    if (!(clearance->apart > 0) || arbor_is_same_tree(arbor, i, j))
        return clearance->gap;
    double spare = fmax(0, clearance->radius[i] - arbor->shape[i].reserved_radius) +
                   fmax(0, clearance->radius[j] - arbor->shape[j].reserved_radius);
    return clearance->gap + clearance->apart + spare;
}

/* How far from its axis segment i, when it reserves that radius, mm, looks for segments too near.
 */
double clearance_reach(const Clearance *clearance, int32_t i, double reserved_radius);
/* The least distance of the centrelines of segments i and j at which both keep the rules, by the
 * radii of the last clearance_reserve. */
double clearance_due(const Clearance *clearance, const Arbor *arbor, int32_t i, int32_t j);

/* Whether segment i keeps the rules, as of the last clearance_reserve. */
static inline bool clearance_is_kept(const Clearance *clearance, const Arbor *arbor, int32_t i)
{
    return arbor->shape[i].reserved_radius >= clearance->level * clearance->radius[i];
}

/* Suspends the rules: reserves `reserved` times its radius for every segment, whether there is room
 * or not, and sets no limit to radii. O(n). STATUS_MEMORY. */
MUST_CHECK Status clearance_waive(Clearance *clearance, Arbor *arbor, double reserved, Err *err);

/* Whether segment i is inside the domain and no shorter than least_length. */
bool clearance_is_held(const Clearance *clearance, const Arbor *arbor, int32_t i);

/* Whether the segments that the present move has placed are inside the domain and no shorter than
 * least_length. */
bool clearance_is_inside(const Clearance *clearance, const Arbor *arbor);

/* Whether the present move keeps the rules. If so, radii are reserved in the arbor: for the
 * segments that moved, 1.04 to 1.1 times their radius, and as much for those that have outgrown
 * their reservation because of the move. If not, the move has to be undone. */
bool clearance_allows(const Clearance *clearance, Arbor *arbor);

/* To be called for a move that is kept: enters what it changed in the grid. STATUS_MEMORY. */
MUST_CHECK Status clearance_follow(Clearance *clearance, const Arbor *arbor, Err *err);

#endif
