/* Room: that vessels stay inside the domain, clear of each other and long enough, whatever moves.
 *
 * Vessels count at their radius times the `level`, in [0, 1]. A segment is longer than wide, and
 * two segments without a common node are apart by more than their radii. Where the tree that came
 * in broke this, it may stay so, but no vessel gets deeper into another than it was. */
#ifndef CORCAST_GROW_REFINE_CLEARANCE_H
#define CORCAST_GROW_REFINE_CLEARANCE_H

#include "domain/domain.h"
#include "grow/cco/grid.h"
#include "grow/refine/refine_arbor.h"

typedef struct Clearance {
    const Domain *domain; /* NULL: all of space */
    Box box;
    double level;
    double least_length; /* mm; no segment is made shorter */
    double gap;          /* mm; least distance beyond the radii */
    Grid grid;
    double *radius, *share; /* for clearance_reserve */
} Clearance;

/* Finds the level at which nearly all vessels of the tree are clear, and books their clearance.
 * Start from (Clearance){0}; ends with clearance_release. */
MUST_CHECK Status clearance_init(Clearance *clearance, const Domain *domain, Arbor *arbor,
                                 Err *err);
void clearance_release(Clearance *clearance);

/* Books room anew for all vessels at their present radii and a little more. */
MUST_CHECK Status clearance_reserve(Clearance *clearance, Arbor *arbor, Err *err);

/* Whether segment i has the room that it should, as of the last clearance_reserve. */
static inline bool clearance_is_kept(const Clearance *clearance, const Arbor *arbor, int32_t i)
{
    return arbor->shape[i].reserved_radius >= clearance->level * clearance->radius[i];
}

/* Books for all vessels `reserved` times their radius, whether there is room for it or not; no
 * radius is too great then. */
MUST_CHECK Status clearance_waive(Clearance *clearance, Arbor *arbor, double reserved, Err *err);

/* Whether all that the present move has moved is inside the domain and not too short to be. */
bool clearance_is_inside(const Clearance *clearance, const Arbor *arbor);

/* Whether there is room for the present move; if so, it is reserved_radius in `arbor`. The shapes
 * that moved are given room for `reserve` of their radius, and so much for those that widen. */
bool clearance_allows(const Clearance *clearance, Arbor *arbor);

/* Brings the grid up to date with the present move, which is kept. */
MUST_CHECK Status clearance_follow(Clearance *clearance, const Arbor *arbor, Err *err);

#endif
