/* Computes the weights of segments: how much more than average a segment resists because of its
 * flow and viscosity. It is for trees with unequal terminals, or with a viscosity or a Murray
 * exponent that depends on the radius.
 *
 * The weight of a segment is its flow divided by the flow of the same number of mean terminals,
 * times its viscosity divided by the reference viscosity. The number of terminals times the weight
 * is therefore the burden in the law [cco/law.h].
 *
 * Viscosity and exponent depend on the radius, and the radius depends on both. While a tree grows,
 * they are computed from the radii of the last refresh. Each call of weights_refresh (set_shares,
 * weights_flows, then follow_radii) brings them nearer to agreement. At the end finish.c iterates
 * until they agree. */
#include "grow/segment_weights.h"

#include "grow/territory.h"
#include <stdlib.h>

/* Lattice points per terminal by which territories are measured. WEIGHTS_ROUGH: rough_points,
 * because the shares change until the next refresh anyway. WEIGHTS_FINE: all_points for the whole
 * tree, but at least least_points and at most most_points per terminal; a territory of p points is
 * wrong by about p^(1/4), so 256 points give 1.6 % [territory.c]. */
static const double rough_points = 8;
static const double least_points = 256, most_points = 4096, all_points = 2e6;

/* Number of times that radii and weights are computed in turn for a fine result. The last digits
 * are left to finish.c. */
enum { FINE_ROUNDS = 3 };

bool weights_are_needed(const GrowParams *params)
{
    return params->blood.viscosity_law != VISCOSITY_CONSTANT ||
           params->blood.terminal_flow != TERMINAL_FLOW_EQUAL || params->gamma.n > 1;
}

double weights_reference_pa_s(const GrowParams *params)
{
    return pa_s_from_cp(params->blood.viscosity_law == VISCOSITY_PRIES
                            ? params->blood.plasma_viscosity_cp
                            : params->blood.viscosity_cp);
}

static double relative_viscosity(const GrowParams *params, double radius)
{
    if (params->blood.viscosity_law == VISCOSITY_CONSTANT)
        return 1;
    return viscosity_pries_pa_s(radius, params->blood.hematocrit, 1);
}

/* Sets the shares of the flow of all terminals. `share` is a workspace of one number per node. */
static Status set_shares(Network *net, const GrowParams *params, const Domain *domain,
                         WeightsPrecision precision, double *share, Err *err)
{
    bool equal = params->blood.terminal_flow == TERMINAL_FLOW_EQUAL;
    TerritoryParams territory = {
        .domain = domain, .points = rough_points, .threads = params->threads};
    if (params->blood.terminal_flow == TERMINAL_FLOW_DEMAND)
        territory.demand = params->demand;
    if (precision == WEIGHTS_FINE)
        territory.points =
            fmin(fmax(all_points / (double)net->terminals, least_points), most_points);
    if (!equal)
        TRY(territory_count(net, &territory, share, err));
    for (size_t i = 0; i < net->n; i++)
        net->trait[i].share = equal ? network_is_terminal(net, (int32_t)i) : share[i];
    return STATUS_OK;
}

void weights_flows(const Network *net, double *flow)
{
    double sum = 0;
    for (size_t i = 0; i < net->n; i++)
        flow[i] = net->trait[i].share;
    for (size_t k = 0; k < net->inlets; k++) {
        int32_t inlet = net->inlet[k];
        for (int32_t i = network_first_upward(net, inlet); i != inlet;
             i = network_next_upward(net, i))
            flow[net->segment[i].parent] += flow[i];
        sum += flow[inlet];
    }
    for (size_t i = 0; i < net->n; i++)
        flow[i] *= (double)net->terminals / sum;
}

Status weights_update(Network *net, const GrowParams *params, WeightsInput at, double *change,
                      Err *err)
{
    const double *radius = at.radius, part = at.relaxation;
    double sum = 0;
    *change = 0;
    for (size_t i = 0; i < net->n; i++) {
        if (net->segment[i].parent < 0)
            continue;
        double viscosity = relative_viscosity(params, radius[i]);
        if (!isfinite(viscosity))
            return err_set(err, STATUS_INFEASIBLE,
                           "with `viscosity_law` pries, no blood flows through a vessel %.3g um "
                           "wide, and a tree with %zu terminals would have one; lower `terminals` "
                           "or raise `q_perf`",
                           2e3 * radius[i], net->terminals);
        Trait *trait = &net->trait[i];
        double ratio = at.flow[i] / net->segment[i].terminals * viscosity / trait->weight;
        double gamma = logcurve_at(&params->gamma, radius[i]);
        *change = fmax(*change, fmax(fabs(ratio - 1), fabs(gamma - trait->gamma)));
        trait->weight *= part == 1 ? ratio : elementary_pow(ratio, part);
        trait->gamma = part == 1 ? gamma : trait->gamma + part * (gamma - trait->gamma);
        if (net->segment[i].child[0] < 0)
            sum += viscosity;
    }
    net->new_terminal_weight = sum / (double)net->terminals;
    return STATUS_OK;
}

/* Computes weights from the present radii, and then radii from these weights. `radius` has room for
 * one number for each node. */
static Status follow_radii(Network *net, const GrowParams *params, const double *flow,
                           double *radius, Err *err)
{
    double change;
    for (size_t i = 0; i < net->n; i++)
        radius[i] = (double)net->segment[i].radius;
    TRY(weights_update(net, params, (WeightsInput){flow, radius, 1}, &change, err));
    network_refresh(net, params->threads);
    return STATUS_OK;
}

Status weights_refresh(Network *net, const GrowParams *params, const Domain *domain,
                       WeightsPrecision precision, Err *err)
{
    double *flow = NULL, *radius = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&flow, net->n, sizeof *flow, "flows", err));
    TRY_GOTO(mem_calloc(&radius, net->n, sizeof *radius, "radii", err));
    TRY_GOTO(set_shares(net, params, domain, precision, flow, err));
    weights_flows(net, flow);
    network_refresh(net, params->threads);
    for (int round = 0; round < (precision == WEIGHTS_FINE ? FINE_ROUNDS : 1); round++)
        TRY_GOTO(follow_radii(net, params, flow, radius, err));
done:
    free(flow);
    free(radius);
    return status;
}
