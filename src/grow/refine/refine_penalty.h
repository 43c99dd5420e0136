/* Penalties: the rules of room [refine_clearance.h] as prices, for a detour through trees that
 * break them.
 *
 * While penalties are open, a vessel pays for every mm that it is shorter than wide, and two
 * vessels without a common node for every mm that they are in each other, at the higher of their
 * prices. */
#ifndef CORCAST_GROW_REFINE_PENALTY_H
#define CORCAST_GROW_REFINE_PENALTY_H

#include "grow/refine/refine_arbor.h"
#include "grow/refine/refine_clearance.h"

typedef struct Penalties {
    bool active;
    double *rate;    /* of each segment, S_root / mm */
    int32_t *broken; /* the segments that broke the rules at the last penalties_raise */
    size_t n_broken;
    uint64_t *seen, count; /* so that each count of penalties comes across a segment once */
} Penalties;

/* Start from (Penalties){0}; ends with penalties_release. */
MUST_CHECK Status penalties_init(Penalties *penalties, size_t segments, Err *err);
void penalties_release(Penalties *penalties);

/* Opens penalties; a mm costs `price` times what S_root is a mm of all vessels. */
void penalties_begin(Penalties *penalties, const Arbor *arbor, double price);
/* Brings reservations, by which penalties are counted, to the present radii. */
MUST_CHECK Status penalties_reserve(Clearance *clearance, Arbor *arbor, Err *err);
/* Raises all prices, and most those of the segments that are not clear as of the last
 * clearance_reserve. */
void penalties_raise(Penalties *penalties, const Clearance *clearance, const Arbor *arbor);

/* What `count` segments pay for themselves and with all others of the tree. 0 while penalties are
 * closed. */
double penalty_of(Penalties *penalties, const Clearance *clearance, const Arbor *arbor,
                  const int32_t *segment, int count);
/* What the three segments at the end of segment i pay, where the present move has put it; books for
 * them. */
double penalty_at_bifurcation(Penalties *penalties, const Clearance *clearance, Arbor *arbor,
                              int32_t i);

#endif
