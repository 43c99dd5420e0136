/* How flow and viscosity weigh the length of segments, where terminals are unequal or the viscosity
 * depends on the radius [law.h]. */
#ifndef CORCAST_GROW_WEIGH_H
#define CORCAST_GROW_WEIGH_H

#include "domain/domain.h"
#include "grow/grow.h"
#include "grow/network.h"

/* Whether weights may differ from 1. */
bool weigh_is_needed(const GrowParams *params);

/* The viscosity that weights are relative to, Pa s: the blood's, by Pries's law the plasma's. */
double weigh_reference_pa_s(const GrowParams *params);

/* How fine territories are measured. */
typedef enum WeighPrecision {
    WEIGH_ROUGH, /* growth: to about a fifth */
    WEIGH_FINE,  /* the result: to one in a hundred, for up to 1,000 terminals two in a thousand */
} WeighPrecision;

/* Fills `flow` with the flow through every segment, over the terminals' mean, from their shares. */
void weigh_gather(const Network *net, double *flow);

/* Sets the weights of all segments to what their flows and radii (mm) ask for, or moves them `part`
 * of the way, in (0, 1]; *change is the largest share by which one was off. What follows from
 * weights is not yet summed up. STATUS_INFEASIBLE when a vessel is too thin for blood to pass. */
MUST_CHECK Status weigh_segments(Network *net, const GrowParams *params, const double *flow,
                                 const double *radius, double part, double *change, Err *err);

/* Brings shares and weights, and all that follows from them, up to date. */
MUST_CHECK Status weigh_refresh(Network *net, const GrowParams *params, const Domain *domain,
                                WeighPrecision precision, Err *err);

#endif
