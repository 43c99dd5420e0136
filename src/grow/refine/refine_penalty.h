/* Penalties: the rules of clearance [refine_clearance.h] as prices, for a way through trees that
 * break them. A segment pays its rate for every mm that it is shorter than wide, and two segments
 * without a common node pay the lower of their rates for every mm that they overlap: so one that
 * has long been at fault may push others aside. */
#ifndef CORCAST_GROW_REFINE_PENALTY_H
#define CORCAST_GROW_REFINE_PENALTY_H

#include "grow/refine/refine_arbor.h"
#include "grow/refine/refine_clearance.h"

typedef struct Penalties {
    bool active;     /* whether rules may be broken; else nobody pays */
    double *rate;    /* of each segment, S_root / mm */
    int32_t *broken; /* the segments that broke the rules at the last penalties_raise */
    size_t n_broken;
    uint64_t count; /* of calls that counted penalties */
    uint64_t *seen; /* by segment: the last of them that came across it */
} Penalties;

/* Start from (Penalties){0}; ends with penalties_release. */
MUST_CHECK Status penalties_init(Penalties *penalties, size_t segments, Err *err);
void penalties_release(Penalties *penalties);

/* From here on rules may be broken: a mm costs `rate` times the geometric mean of what a mm of the
 * segment and a mm of all vessels cost in S_root, or the latter where that is more. Needs fresh
 * marginals. The caller ends it with active = false. */
void penalties_begin(Penalties *penalties, const Arbor *arbor, double rate);
/* Brings reserved radii, by which penalties are counted, to 1.05 times the present radii, whether
 * there is room or not. O(n). STATUS_MEMORY. */
MUST_CHECK Status penalties_reserve(Clearance *clearance, Arbor *arbor, Err *err);
/* Raises the rates of all segments by 1.1, and by 2.2 those of segments that break a rule as of the
 * last clearance_reserve, which it lists in `broken`. */
void penalties_raise(Penalties *penalties, const Clearance *clearance, const Arbor *arbor);

/* What `count` segments pay for themselves and together with all others of the tree, in S_root. 0
 * while penalties are not active. */
double penalty_of(Penalties *penalties, const Clearance *clearance, const Arbor *arbor,
                  const int32_t *segment, int count);
/* What the three segments that meet at the end of segment i pay where the present move has put
 * them; reserves their radii first. */
double penalty_at_bifurcation(Penalties *penalties, const Clearance *clearance, Arbor *arbor,
                              int32_t i);

#endif
