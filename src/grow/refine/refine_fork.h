/* Where three segments meet best: the bifurcation as an optimisation problem of its own. */
#ifndef CORCAST_GROW_REFINE_FORK_H
#define CORCAST_GROW_REFINE_FORK_H

#include "geom/geom.h"
#include "grow/cco/law.h"
#include <stdbool.h>

/* The segment that comes, and the two that leave. */
enum { FORK_PROXIMAL, FORK_LEFT, FORK_RIGHT, FORK_ENDS };

/* What hangs on the far end of a segment that leaves. */
typedef struct Burden {
    double flow;      /* relative to the others */
    double viscosity; /* of the segment itself, over the reference */
    double flare_below, cost_below;
} Burden;

/* How S_root, to first order, depends on the segment at one place in the tree. */
typedef struct Outlook {
    Adjoint adjoint;
    double gauge; /* [law.h] */
    double extra; /* dS_root for one more unit of flow through all segments above */
} Outlook;

typedef struct Fork {
    const Law *law;
    Vec3 end[FORK_ENDS]; /* mm; they differ */
    Burden burden[2];
    double viscosity;    /* of the proximal segment */
    Outlook outlook;     /* of the proximal segment */
    double radius_unit;  /* q [law.h] */
    double least_length; /* mm; of each segment */
    double least_widths; /* and diameters */
} Fork;

/* The fork with its bifurcation at one point. */
typedef struct ForkState {
    Vec3 place;
    double cost;              /* S_root, but for a constant */
    double length[FORK_ENDS]; /* mm */
    double radius[FORK_ENDS]; /* mm */
    double weight[FORK_ENDS]; /* d cost / d length, over the greatest */
} ForkState;

/* False when a figure is beyond what a double can hold. */
bool fork_at(const Fork *fork, Vec3 place, ForkState *out);

/* Moves *state, the outcome of fork_at, `rounds` times to the point that is best for its weights,
 * kept off the ends. False as with fork_at. */
bool fork_settle(const Fork *fork, int rounds, ForkState *state);

#endif
