/* Penalties: costs for breaking the rules of clearance [refine_clearance.h]. A search that adds
 * them to the cost of the tree, S_root [law.h], may pass through trees that break the rules.
 * penalties_begin activates them. The penalty functions price each move, and penalties_raise makes
 * lasting violations more expensive.
 *
 * Every segment has a rate, in S_root per mm. The penalty of a segment that is shorter than its
 * diameter is its rate times the difference in mm. The penalty of two segments that overlap, and
 * have no common node, is the lower one of their rates times the overlap in mm. A segment whose
 * rate has risen can therefore move into a segment whose rate is still low, which then has to
 * move. */
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
    uint64_t count; /* stamp: number of segments whose penalties were added up so far */
    uint64_t *seen; /* per segment: the stamp when its overlaps were last counted */
} Penalties;

/* Allocates the arrays of *penalties, which is zeroed. Release with penalties_release, also after
 * an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status penalties_init(Penalties *penalties, size_t segments, Err *err);
/* Frees the arrays and zeroes *penalties, which may be zeroed before. */
void penalties_release(Penalties *penalties);

/* Activates penalties and sets the rates; the caller deactivates penalties by active = false. Call
 * it after arbor_refresh. Let a be the cost per mm of the segment, (radius /
 * arbor->radius_unit)^lambda, and b the mean cost per mm of all segments, S_root / length. The rate
 * of the segment is relative_rate * sqrt(a b), but at least relative_rate * b. A segment that costs
 * more per mm has a higher rate, because its S_root would gain more by breaking a rule. */
void penalties_begin(Penalties *penalties, const Arbor *arbor, double relative_rate);

/* Lists in `broken` the segments that broke a rule at the last clearance_reserve. Multiplies their
 * rates by 2.2 and all other rates by 1.1. The ratio of 2 lets a broken rule outweigh its
 * neighbours in a few rounds; faster rises end the search sooner, in worse trees. */
void penalties_raise(Penalties *penalties, const Clearance *clearance, const Arbor *arbor);

/* Returns the penalties of `count` segments, in S_root: for their lengths, and for overlaps with
 * any segment of the tree. Returns 0 while penalties are not active. */
double penalty_of_segments(Penalties *penalties, const Clearance *clearance, const Arbor *arbor,
                           const int32_t *segment, int count);

/* For the three segments that meet at the distal end of segment i, which the present move has
 * changed: sets their reserved radii [clearance_suspend] from their present radii, and returns
 * their penalties in S_root. */
double penalty_at_bifurcation(Penalties *penalties, const Clearance *clearance, Arbor *arbor,
                              int32_t i);

#endif
