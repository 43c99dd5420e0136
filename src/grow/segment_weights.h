/* Weights of segments: unequal terminals, and viscosity and Murray exponent that depend on the
 * radius. Flow and viscosity enter the law of radii [law.h] as one weight of a segment, its
 * relative flow times its relative viscosity. The exponent belongs to the fork at the segment's
 * end. */
#ifndef CORCAST_GROW_SEGMENT_WEIGHTS_H
#define CORCAST_GROW_SEGMENT_WEIGHTS_H

#include "domain/domain.h"
#include "grow/grow.h"
#include "grow/network.h"

/* Returns true if weights may differ from 1, or exponents from each other. The network then needs
 * traits. */
bool weights_are_needed(const GrowParams *params);

/* Returns the viscosity, Pa s, that weights are relative to: that of the blood, or by Pries's law
 * that of the plasma. */
double weights_reference_pa_s(const GrowParams *params);

/* How finely territories are measured. */
typedef enum WeightsPrecision {
    WEIGHTS_ROUGH, /* for growth: to about a fifth */
    WEIGHTS_FINE   /* for the result: to 1 %, for up to 1,000 terminals to 0.2 % */
} WeightsPrecision;

/* Sets flow[i], per node, to the flow through segment i relative to the terminals' mean, from the
 * terminals' shares. Needs no sums. O(n). */
void weights_flows(const Network *net, double *flow);

/* What weights are computed from. */
typedef struct WeightsAt {
    const double *flow;   /* per node [weights_flows] */
    const double *radius; /* per node, mm */
    double part;          /* in (0, 1]; 1 sets weights and exponents to their new values, less moves
                           * them that part of the way (weights: of their logarithms) */
} WeightsAt;

/* Computes the weights and exponents of all segments. Needs right numbers of terminals; leaves all
 * other sums out of date.
 *
 * change   receives the largest change that was called for: relative for weights, absolute for
 *          exponents.
 * Errors   STATUS_INFEASIBLE if a vessel is too thin for blood to pass.
 * Cost     O(n). */
MUST_CHECK Status weights_update(Network *net, const GrowParams *params, WeightsAt at,
                                 double *change, Err *err);

/* Brings shares, weights, exponents, sums and radii up to date, where weights are needed; it takes
 * the place of network_refresh. WEIGHTS_FINE measures territories finely, and computes radii and
 * weights in turn three times. Errors: STATUS_INFEASIBLE as weights_update, STATUS_MEMORY. */
MUST_CHECK Status weights_refresh(Network *net, const GrowParams *params, const Domain *domain,
                                  WeightsPrecision precision, Err *err);

#endif
