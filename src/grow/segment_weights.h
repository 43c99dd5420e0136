/* Unequal terminals, and viscosity and Murray exponent that depend on the radius: the first two
 * enter the law of radii [law.h] as a weight of each segment, its relative flow times its relative
 * viscosity, the last as the exponent of the fork at its end. */
#ifndef CORCAST_GROW_SEGMENT_WEIGHTS_H
#define CORCAST_GROW_SEGMENT_WEIGHTS_H

#include "domain/domain.h"
#include "grow/grow.h"
#include "grow/network.h"

/* Whether weights may differ from 1, or exponents from each other: the network then needs traits.
 */
bool weights_are_needed(const GrowParams *params);

/* The viscosity that weights are relative to, Pa s: the blood's, or by Pries's law the plasma's. */
double weights_reference_pa_s(const GrowParams *params);

/* How finely territories are measured. */
typedef enum WeightsPrecision {
    WEIGHTS_ROUGH, /* growth: to about a fifth */
    WEIGHTS_FINE, /* the result: to one in a hundred, for up to 1,000 terminals two in a thousand */
} WeightsPrecision;

/* Fills flow[i], one for each node, with the flow through segment i relative to the terminals'
 * mean, from the terminals' shares. Needs no sums. O(n). */
void weights_flows(const Network *net, double *flow);

/* Sets the weights and exponents of all segments to those of their flows (weights_flows) and radii,
 * mm, one for each node; or moves them `part` of the way, in (0, 1], weights that of their
 * logarithms. *change is the largest change that was called for, of weights over the weight. Needs
 * right terminals; leaves all other sums out of date. STATUS_INFEASIBLE when a vessel is too thin
 * for blood to pass. O(n). */
MUST_CHECK Status weights_update(Network *net, const GrowParams *params, const double *flow,
                                 const double *radius, double part, double *change, Err *err);

/* Brings shares, weights, exponents, sums and radii up to date: network_refresh where weights are
 * needed. The fine precision measures territories finely, and computes radii and weights in turn
 * three times. STATUS_INFEASIBLE as weights_update, STATUS_MEMORY. */
MUST_CHECK Status weights_refresh(Network *net, const GrowParams *params, const Domain *domain,
                                  WeightsPrecision precision, Err *err);

#endif
