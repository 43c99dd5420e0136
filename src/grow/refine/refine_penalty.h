/* Penalties: costs for breaking the rules of clearance [refine_clearance.h]. A search that adds
 * them to S_root [law.h] may pass through trees that break the rules. penalties_begin activates
 * them, and penalties_raise makes lasting violations more expensive.
 *
 * Every segment has a rate, in S_root per mm. The penalty of a segment that is shorter than its
 * diameter is its rate times the difference in mm. The penalty of two segments that overlap, and
 * have no common node, is the lower one of their rates times the overlap in mm. A segment that has
 * broken a rule for a long time can therefore displace other segments. */
#ifndef CORCAST_GROW_REFINE_REFINE_PENALTY_H
#define CORCAST_GROW_REFINE_REFINE_PENALTY_H

#include "grow/refine/refine_arbor.h"
#include "grow/refine/refine_clearance.h"

/* The penalties of a search. The arrays are owned. Zeroed: penalties are not active. */
typedef struct Penalties {
    bool active;     /* rules may be broken, at a cost; false: all penalties are 0 */
    double *rate;    /* per segment: S_root per mm */
    int32_t *broken; /* the segments that broke a rule at the last penalties_raise */
    size_t n_broken;
    uint64_t count; /* number of segments whose penalties were added up so far */
    uint64_t *seen; /* per segment: value of `count` when its overlaps were last counted */
} Penalties;

/* Allocates the arrays of *penalties, which is zeroed. Release with penalties_release, also after
 * an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status penalties_init(Penalties *penalties, size_t segments, Err *err);
/* Frees the arrays and zeroes *penalties, which may be zeroed before. */
void penalties_release(Penalties *penalties);

/* Activates penalties and sets the rates; the caller deactivates penalties by active = false. Call
 * it after arbor_refresh. Let a be the cost per mm of the segment, (radius / q)^lambda [law.h], and
 * b the mean cost per mm of all segments, S_root / length. The rate of the segment is `rate` times
 * sqrt(a b), but at least `rate` times b. */
void penalties_begin(Penalties *penalties, const Arbor *arbor, double rate);

/* Multiplies the rates of segments that broke a rule at the last clearance_reserve by 2.2, and all
 * other rates by 1.1. Lists the segments that break a rule in `broken`. */
void penalties_raise(Penalties *penalties, const Clearance *clearance, const Arbor *arbor);

/* Returns the penalties of `count` segments, in S_root: for their lengths, and for overlaps with
 * any segment of the tree. Returns 0 while penalties are not active. */
double penalty_of_segments(Penalties *penalties, const Clearance *clearance, const Arbor *arbor,
                           const int32_t *segment, int count);

/* Updates the reserved radii of the three segments that meet at the distal end of segment i, after
 * the present move has changed them. Returns the penalties of these segments. */
double penalty_at_bifurcation(Penalties *penalties, const Clearance *clearance, Arbor *arbor,
                              int32_t i);

#endif
