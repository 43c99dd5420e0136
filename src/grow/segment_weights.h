/* Computes the weights of segments, which describe unequal flows of terminals and a viscosity that
 * depends on the radius. It also computes Murray exponents that depend on the radius. Growth calls
 * weights_refresh instead of network_refresh if weights_are_needed.
 *
 * The weight of a segment with n terminals below it is (flow / (n * mean flow of a terminal)) *
 * (viscosity / weights_reference_pa_s). n times the weight is the burden from which radii follow
 * [cco/law.h]. A segment also has the Murray exponent of the bifurcation at its distal end. Both
 * are stored in the traits of the network [Trait]. */
#ifndef CORCAST_GROW_SEGMENT_WEIGHTS_H
#define CORCAST_GROW_SEGMENT_WEIGHTS_H

#include "domain/domain.h"
#include "grow/grow.h"
#include "grow/network.h"

/* Returns true if weights may differ from 1 or exponents from each other. The network must then
 * have traits [NetworkSize.has_traits]. */
bool weights_are_needed(const GrowParams *params);

/* Returns the reference viscosity of weights, Pa s: the viscosity of the blood or, with Pries's
 * law, of the plasma. */
double weights_reference_pa_s(const GrowParams *params);

/* The accuracy with which the territory of a terminal is measured [territory.h]. The flow of the
 * terminal is proportional to its territory. */
typedef enum WeightsPrecision {
    WEIGHTS_ROUGH, /* for growth: relative error of a territory about 20 %; flows change with every
                    * new terminal anyway */
    WEIGHTS_FINE   /* for the result: relative error 1 %; for up to 1,000 terminals 0.2 % */
} WeightsPrecision;

/* Sets flow[i], per node, to the flow through segment i divided by the mean flow of a terminal. The
 * flows of terminals are proportional to Trait.share. Reads only the structure and the traits of
 * the network [network.h]. Cost: O(n). */
void weights_flows(const Network *net, double *flow);

/* The inputs of weights_update. */
typedef struct WeightsInput {
    const double *flow;   /* per node; set by weights_flows */
    const double *radius; /* per node, mm */
    double relaxation;    /* in (0, 1]: fraction of the computed change that is applied to exponents
                           * and to log(weight). Values below 1 damp an iteration between viscosity
                           * and radius */
} WeightsInput;

/* Computes the weights and exponents of all segments. Needs exact numbers of terminals
 * [Segment.terminals]. Afterwards all other sums are out of date [network.h].
 *
 * change   receives the largest difference between old and new values: relative for weights,
 *          absolute for exponents.
 * Errors   STATUS_INFEASIBLE if a vessel is too thin for blood to pass by Pries's law; some weights
 *          have then been changed already.
 * Cost     O(n). */
MUST_CHECK Status weights_update(Network *net, const GrowParams *params, WeightsInput at,
                                 double *change, Err *err);

/* Updates flow shares, weights, exponents, sums and radii. Weights and radii depend on each other:
 * WEIGHTS_ROUGH computes both once, WEIGHTS_FINE three times in turn. The final radii are iterated
 * to convergence by finish_tree. Errors: STATUS_INFEASIBLE, as weights_update; STATUS_MEMORY. */
MUST_CHECK Status weights_refresh(Network *net, const GrowParams *params, const Domain *domain,
                                  WeightsPrecision precision, Err *err);

#endif
