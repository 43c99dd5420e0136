/* How flow and viscosity weigh the length of segments, where terminals are unequal or the viscosity
 * depends on the radius [law.h]. */
#ifndef CORCAST_GROW_SEGMENT_WEIGHTS_H
#define CORCAST_GROW_SEGMENT_WEIGHTS_H

#include "domain/domain.h"
#include "grow/grow.h"
#include "grow/network.h"

/* Whether weights may differ from 1. */
bool weights_are_needed(const GrowParams *params);

/* The viscosity that weights are relative to, Pa s: the blood's, by Pries's law the plasma's. */
double weights_reference_pa_s(const GrowParams *params);

/* How fine territories are measured. */
typedef enum WeightsPrecision {
    WEIGHTS_ROUGH, /* growth: to about a fifth */
    WEIGHTS_FINE, /* the result: to one in a hundred, for up to 1,000 terminals two in a thousand */
} WeightsPrecision;

/* Fills `flow` with the flow through every segment, over the terminals' mean, from their shares. */
void weights_flows(const Network *net, double *flow);

/* Sets the weights of all segments to what their flows and radii (mm) ask for, or moves them `part`
 * of the way, in (0, 1]; *change is the largest share by which one was off. What follows from
 * weights is not yet summed up. STATUS_INFEASIBLE when a vessel is too thin for blood to pass. */
MUST_CHECK Status weights_update(Network *net, const GrowParams *params, const double *flow,
                                 const double *radius, double part, double *change, Err *err);

/* Brings shares and weights, and all that follows from them, up to date. */
MUST_CHECK Status weights_refresh(Network *net, const GrowParams *params, const Domain *domain,
                                  WeightsPrecision precision, Err *err);

#endif
