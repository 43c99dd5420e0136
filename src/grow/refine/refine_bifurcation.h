/* Where three segments meet best: the bifurcation as an optimisation problem of its own. */
#ifndef CORCAST_GROW_REFINE_BIFURCATION_H
#define CORCAST_GROW_REFINE_BIFURCATION_H

#include "geom/geom.h"
#include "grow/cco/law.h"
#include <stdbool.h>

/* The segment that comes, and the two that leave. */
enum { BIFURCATION_PROXIMAL, BIFURCATION_LEFT, BIFURCATION_RIGHT, BIFURCATION_ENDS };

/* What hangs on the far end of a segment that leaves. */
typedef struct Daughter {
    double flow;      /* relative to the others */
    double viscosity; /* of the segment itself, over the reference */
    double rho_gamma_below, cost_below;
} Daughter;

/* How S_root, to first order, depends on the segment at one place in the tree. */
typedef struct Marginal {
    Adjoint adjoint;
    double gauge; /* [law.h] */
    double extra; /* dS_root for one more unit of flow through all segments above */
} Marginal;

typedef struct Bifurcation {
    const Law *law;
    Vec3 end[BIFURCATION_ENDS]; /* mm; they differ */
    Daughter burden[2];
    double viscosity;    /* of the proximal segment */
    Marginal marginal;   /* of the proximal segment */
    double radius_unit;  /* q [law.h] */
    double least_length; /* mm; of each segment */
    double least_widths; /* and diameters */
} Bifurcation;

/* The fork with its bifurcation at one point. */
typedef struct BifurcationState {
    Vec3 place;
    double cost;                     /* S_root, but for a constant */
    double length[BIFURCATION_ENDS]; /* mm */
    double radius[BIFURCATION_ENDS]; /* mm */
    double weight[BIFURCATION_ENDS]; /* d cost / d length, over the greatest */
} BifurcationState;

/* False when a figure is beyond what a double can hold. */
bool bifurcation_at(const Bifurcation *fork, Vec3 place, BifurcationState *out);

/* Moves *state, the outcome of bifurcation_at, `rounds` times to the point that is best for its
 * weights, kept off the ends. False as with bifurcation_at. */
bool bifurcation_optimise(const Bifurcation *fork, int rounds, BifurcationState *state);

#endif
