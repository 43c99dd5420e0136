/* Penalties: the rules of clearance [refine_clearance.h] as prices, for a search that passes
 * through trees that break the rules.
 *
 * Every segment has a rate. A segment pays its rate for every mm that it is shorter than wide. Two
 * segments without a common node pay the lower of their rates for every mm that they overlap, so
 * that a segment that has long broken a rule may push others aside. */
#ifndef CORCAST_GROW_REFINE_REFINE_PENALTY_H
#define CORCAST_GROW_REFINE_REFINE_PENALTY_H

#include "grow/refine/refine_arbor.h"
#include "grow/refine/refine_clearance.h"

/* The penalties of a search. The arrays are owned. Zeroed: penalties are not active. */
typedef struct Penalties {
    bool active;     /* rules may be broken; otherwise no segment pays */
    double *rate;    /* per segment, S_root / mm */
    int32_t *broken; /* the segments that broke a rule at the last penalties_raise */
    size_t n_broken;
    uint64_t count; /* of calls that counted penalties */
    uint64_t *seen; /* per segment: the last of these calls that counted it */
} Penalties;

/* Allocates the arrays of *penalties, which is zeroed. Release with penalties_release, also after
 * an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status penalties_init(Penalties *penalties, size_t segments, Err *err);
/* Frees the arrays and zeroes *penalties, which may be zeroed before. */
void penalties_release(Penalties *penalties);

/* Activates penalties; the caller deactivates them by active = false. Call it after arbor_refresh.
 * The rate of a segment is `rate` times the geometric mean of two costs in S_root: of a mm of the
 * segment and of a mm of all vessels; but not less than `rate` times the latter. */
void penalties_begin(Penalties *penalties, const Arbor *arbor, double rate);

/* Multiplies the rates of segments that break a rule, as of the last clearance_reserve, by 2.2, and
 * all other rates by 1.1. Lists the segments that break a rule in `broken`. */
void penalties_raise(Penalties *penalties, const Clearance *clearance, const Arbor *arbor);

/* Returns what `count` segments pay for themselves and together with all others of the tree, in
 * S_root; 0 while penalties are not active. */
double penalty_of_segments(Penalties *penalties, const Clearance *clearance, const Arbor *arbor,
                  const int32_t *segment, int count);

/* Reserves the radii of the three segments that meet at the end of segment i, where the present
 * move has put them. Returns what these segments pay. */
double penalty_at_bifurcation(Penalties *penalties, const Clearance *clearance, Arbor *arbor,
                              int32_t i);

#endif
