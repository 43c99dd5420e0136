/* Weights of segments, for trees whose terminals have unequal flows, or whose viscosity or Murray
 * exponent depends on the radius.
 *
 * Flow and viscosity enter the law of radii [cco/law.h] as one number, the weight of a segment: its
 * relative flow times its relative viscosity. The Murray exponent belongs to the bifurcation at the
 * segment's distal end. If all weights are 1 and there is one exponent, none of this is needed. */
#ifndef CORCAST_GROW_SEGMENT_WEIGHTS_H
#define CORCAST_GROW_SEGMENT_WEIGHTS_H

#include "domain/domain.h"
#include "grow/grow.h"
#include "grow/network.h"

/* Returns true if weights may differ from 1, or exponents from each other. The network then
 * needs traits. */
bool weights_are_needed(const GrowParams *params);

/* Returns the viscosity, Pa s, that weights are relative to: that of the blood, or by Pries's law
 * that of the plasma. */
double weights_reference_pa_s(const GrowParams *params);

/* How finely territories are measured. */
typedef enum WeightsPrecision {
    WEIGHTS_ROUGH, /* for growth: relative error about 20 % */
    WEIGHTS_FINE   /* for the result: relative error 1 %; for up to 1,000 terminals 0.2 % */
} WeightsPrecision;

/* Sets flow[i], per node, to the flow through segment i relative to the terminals' mean, from the
 * terminals' shares [Trait.share]. Requires no sums. Cost: O(n). */
void weights_flows(const Network *net, double *flow);

/* What weights are computed from. */
typedef struct WeightsAt {
    const double *flow;   /* per node [weights_flows] */
    const double *radius; /* per node, mm */
    double part;          /* in (0, 1]; 1 sets weights and exponents to their new values. A smaller
                           * part moves exponents and the logarithms of weights by that part of the
                           * difference, which makes the iteration converge */
} WeightsAt;

/* Computes the weights and exponents of all segments. Requires exact numbers of terminals
 * [network.h]; all other sums are out of date afterwards.
 *
 * change   receives the largest difference between old and new values: relative for weights,
 *          absolute for exponents.
 * Errors   STATUS_INFEASIBLE if a vessel is too thin for blood to pass.
 * Cost     O(n). */
MUST_CHECK Status weights_update(Network *net, const GrowParams *params, WeightsAt at,
                                 double *change, Err *err);

/* Updates shares, weights, exponents, sums and radii. Call it instead of network_refresh if
 * weights_are_needed. WEIGHTS_FINE measures territories finely, and computes radii and
 * weights in turn three times. Errors: STATUS_INFEASIBLE as weights_update, STATUS_MEMORY. */
MUST_CHECK Status weights_refresh(Network *net, const GrowParams *params, const Domain *domain,
                                  WeightsPrecision precision, Err *err);

#endif
