/* Estimates the pressures of open nodes, the nodes without a boundary condition. Minimizes half the
 * sum of w (p - target)^2 over the nodes plus k / 2 times the sum of l (tau - target)^2 over the
 * segments [flownetwork.h], where the sign of each target stress is the assumed direction of flow.
 *
 * The pressures p of all nodes are an affine function of the pressures y of the open nodes: p = p0
 * + Z y. Column b of Z is the solution of the network with the pressure 1 at open node b, and no
 * other pressures and inflows. For fixed directions the objective is quadratic, and its gradient
 * with respect to y is 0 where S y = b, a linear system with one row per open node. Z is not
 * stored. Its transpose is applied by an adjoint solution, whose inflows are the gradient with
 * respect to p. S = S0 + k S1, and S0 and S1 depend neither on k nor on the directions, so they are
 * computed once. */
#include "flownetwork/flownetwork.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* The first and the last weight k of the stress. k doubles from step to step. Its units are those
 * of Fry et al. [flownetwork.h]: pressure in mmHg and stress in dyn/cm^2 = 0.1 Pa. With a larger
 * last weight, the stress would dominate the pressures. SOLVES_PER_WEIGHT is the maximum number of
 * minimizations per weight, in case directions keep turning. */
static const double first_weight = 0.002, last_weight = 4.096;
enum { SOLVES_PER_WEIGHT = 5 };

/* The state of an estimate. Owns its arrays. */
typedef struct Estimation {
    const FlowNetwork *network;
    const NetworkEstimate *params;
    uint32_t *open;  /* the open nodes */
    size_t n;        /* their number */
    double *weight;  /* per node: half the length of its segments */
    double *s0, *s1; /* n x n: second derivatives of the two parts of the objective */
    double *matrix;  /* n x n, lower triangle: Cholesky factor of S */
} Estimation;

/* The boundary conditions that a solution uses. */
typedef struct EstimateCase {
    const double *inflow;   /* per node; NULL: 0 */
    const double *pressure; /* per open node; NULL: 0 */
    uint32_t unit_node;     /* open node with the pressure 1; UINT32_MAX: none */
    bool is_whole;          /* use the network's known pressures and inflows; false: 0 */
} EstimateCase;

/* Solves the network with these boundary conditions. */
static Status solve(const Estimation *state, const EstimateCase *given, NetworkFlow *flow, Err *err)
{
    FlowNetwork network = *state->network;
    double *pressure = NULL, *inflow = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&pressure, network.n_nodes, sizeof *pressure, "pressures", err));
    TRY_GOTO(mem_calloc(&inflow, network.n_nodes, sizeof *inflow, "inflows", err));
    for (size_t v = 0; v < network.n_nodes; v++) {
        bool is_known = !isnan(network.pressure[v]);
        pressure[v] = is_known && !given->is_whole ? 0 : network.pressure[v];
        inflow[v] = given->inflow ? given->inflow[v] : given->is_whole ? network.inflow[v] : 0;
    }
    for (size_t b = 0; b < state->n; b++)
        pressure[state->open[b]] = given->pressure ? given->pressure[b] : b == given->unit_node;
    network.pressure = pressure;
    network.inflow = inflow;
    network.absorbs_excess = !given->is_whole;
    status = flownetwork_solve(&network, flow, err);
done:
    free(pressure);
    free(inflow);
    return status;
}

/* Returns the wall shear stress of a segment divided by the difference of pressure between its
 * ends: r / (2 l). */
static double stress_factor(const Estimation *state, size_t i)
{
    double length = state->params->length_mm[i];
    return length > 0 ? state->params->radius_mm[i] / (2 * length) : 0;
}

/* Adds `weight` times the gradient with respect to p of half the sum of l (tau - target)^2. `sign`
 * is NULL for target 0. */
static void add_stress(const Estimation *state, const double *pressure, const signed char *sign,
                       double weight, double *gradient)
{
    for (size_t i = 0; i < state->network->n_segments; i++) {
        const uint32_t *ends = state->network->ends[i];
        double factor = stress_factor(state, i), drop = pressure[ends[0]] - pressure[ends[1]];
        double excess = factor * drop - (sign ? sign[i] * state->params->stress_pa : 0);
        double change = weight * state->params->length_mm[i] * factor * excess;
        if (state->network->resistance[i] < HUGE_VAL) {
            gradient[ends[0]] += change;
            gradient[ends[1]] -= change;
        }
    }
}

/* Adds the gradient with respect to p of half the sum of w (p - target)^2. */
static void add_pressure(const Estimation *state, const double *pressure, double target,
                         double *gradient)
{
    for (size_t v = 0; v < state->network->n_nodes; v++)
        gradient[v] += isnan(pressure[v]) ? 0 : state->weight[v] * (pressure[v] - target);
}

/* Turns the gradient with respect to p into the gradient with respect to y: the product with the
 * transpose of Z. */
static Status gradient_to_open(const Estimation *state, const double *gradient, double *out,
                               Err *err)
{
    NetworkFlow flow = {0};
    TRY(solve(state, &(EstimateCase){.inflow = gradient, .unit_node = UINT32_MAX}, &flow, err));
    for (size_t b = 0; b < state->n; b++)
        out[b] = gradient[state->open[b]] - flow.inflow[state->open[b]];
    networkflow_release(&flow);
    return STATUS_OK;
}

/* Computes the rows b of S0 and S1. */
static Status fill_row(size_t b, int worker, void *context, Err *err)
{
    const Estimation *state = context;
    NetworkFlow flow = {0};
    double *gradient = NULL;
    Status status = STATUS_OK;
    (void)worker;
    TRY_GOTO(mem_calloc(&gradient, state->network->n_nodes, sizeof *gradient, "derivatives", err));
    TRY_GOTO(solve(state, &(EstimateCase){.unit_node = (uint32_t)b}, &flow, err));
    add_pressure(state, flow.pressure, 0, gradient);
    TRY_GOTO(gradient_to_open(state, gradient, state->s0 + b * state->n, err));
    memset(gradient, 0, state->network->n_nodes * sizeof *gradient);
    add_stress(state, flow.pressure, NULL, 1, gradient);
    TRY_GOTO(gradient_to_open(state, gradient, state->s1 + b * state->n, err));
done:
    free(gradient);
    networkflow_release(&flow);
    return status;
}

/* Factorizes S0 + weight S1 by Cholesky's method. A pivot that rounding made 0 or negative becomes
 * DBL_MIN, the smallest normal double, so that its root is a number. */
static void factorize(const Estimation *state, double weight)
{
    size_t n = state->n;
    double *a = state->matrix;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j <= i; j++) {
            double sum = state->s0[i * n + j] + weight * state->s1[i * n + j];
            for (size_t k = 0; k < j; k++)
                sum -= a[i * n + k] * a[j * n + k];
            a[i * n + j] = i == j ? sqrt(fmax(sum, DBL_MIN)) : sum / a[j * n + j];
        }
}

/* Replaces the right-hand side x by the solution, with the Cholesky factor. */
static void substitute(const Estimation *state, double *x)
{
    size_t n = state->n;
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < i; k++)
            x[i] -= state->matrix[i * n + k] * x[k];
        x[i] /= state->matrix[i * n + i];
    }
    for (size_t i = n; i-- > 0;) {
        x[i] /= state->matrix[i * n + i];
        for (size_t k = 0; k < i; k++)
            x[k] -= state->matrix[i * n + k] * x[i];
    }
}

/* One start: the direction of the wall shear stress in each segment, and the latest solution. */
typedef struct Start {
    signed char *sign; /* 0: not known; owned */
    double *pressure;  /* per open node; owned */
    NetworkFlow flow;  /* owned */
} Start;

/* Finds the minimum with the start's directions fixed, then replaces them by the directions of the
 * solution. Sets *turned to whether any has changed. */
static Status minimize(const Estimation *state, const double *base, double weight, Start *start,
                       bool *turned, Err *err)
{
    double *gradient = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&gradient, state->network->n_nodes, sizeof *gradient, "derivatives", err));
    add_pressure(state, base, state->params->pressure_pa, gradient);
    add_stress(state, base, start->sign, weight, gradient);
    TRY_GOTO(gradient_to_open(state, gradient, start->pressure, err));
    for (size_t b = 0; b < state->n; b++)
        start->pressure[b] = -start->pressure[b];
    substitute(state, start->pressure);
    networkflow_release(&start->flow);
    TRY_GOTO(solve(state, &(EstimateCase){.pressure = start->pressure, .is_whole = true},
                   &start->flow, err));
    *turned = false;
    for (size_t i = 0; i < state->network->n_segments; i++) {
        signed char sign = start->flow.flow[i] < 0 ? -1 : 1;
        if (start->flow.direction_unknown[i] || sign == start->sign[i])
            continue;
        start->sign[i] = sign;
        *turned = true;
    }
done:
    free(gradient);
    return status;
}

/* Runs all starts while the weight of the stress doubles. Weight 0 is used for the first start
 * only, to find its first directions. */
static Status double_weight(const Estimation *state, const double *base, Start *start,
                            NetworkSpread *spread, Err *err)
{
    const double mmhg = pa_from_mmhg(10); /* mmHg / (dyn/cm^2). With stress and pressure in Pa, k is
                                           * multiplied by its square */
    for (double k = 0; k <= last_weight; k = k > 0 ? 2 * k : first_weight) {
        factorize(state, k * mmhg * mmhg);
        for (size_t s = 0; s < (k > 0 ? state->params->starts : 1); s++) {
            bool turned = true;
            for (int i = 0; turned && i < (k > 0 ? SOLVES_PER_WEIGHT : 1); i++) {
                TRY(minimize(state, base, k * mmhg * mmhg, &start[s], &turned, err));
                spread->minimizations += s == 0;
            }
        }
    }
    return STATUS_OK;
}

/* Begins a start: the first with unknown directions, the others with random ones. */
static Status begin_start(const Estimation *state, size_t s, Random *random, Start *start, Err *err)
{
    TRY(mem_calloc(&start->sign, state->network->n_segments, 1, "directions", err));
    TRY(mem_calloc(&start->pressure, state->n, sizeof *start->pressure, "pressures", err));
    for (size_t i = 0; s > 0 && i < state->network->n_segments; i++)
        start->sign[i] = random_uniform(random) < 0.5 ? -1 : 1;
    return STATUS_OK;
}

/* Adds the comparison of another start with the first to *spread. Segments whose direction is not
 * known in the first start do not count. */
static Status add_to_spread(const Estimation *state, const NetworkFlow *first,
                            const NetworkFlow *other, NetworkSpread *spread, Err *err)
{
    double *change = NULL, turned = 0;
    size_t n = 0;
    TRY(mem_alloc(&change, state->network->n_segments, sizeof *change, "flows", err));
    for (size_t i = 0; i < state->network->n_segments; i++) {
        if (first->direction_unknown[i])
            continue;
        double ratio = other->flow[i] / first->flow[i];
        turned += ratio < 0;
        change[n++] = fabs(ratio - 1);
    }
    if (n > 0) {
        double now[2] = {turned / (double)n, select_number(change, n, n / 2)};
        spread->reversed[0] = fmin(spread->reversed[0], now[0]);
        spread->reversed[1] = fmax(spread->reversed[1], now[0]);
        spread->change[0] = fmin(spread->change[0], now[1]);
        spread->change[1] = fmax(spread->change[1], now[1]);
    }
    free(change);
    return STATUS_OK;
}

/* Lists the open nodes, and computes their weights, S0 and S1: one row per call of fill_row, in
 * parallel. */
static Status prepare(Estimation *state, Err *err)
{
    const FlowNetwork *network = state->network;
    TRY(mem_alloc(&state->open, network->n_nodes, sizeof *state->open, "nodes", err));
    TRY(mem_calloc(&state->weight, network->n_nodes, sizeof *state->weight, "nodes", err));
    for (uint32_t v = 0; v < network->n_nodes; v++)
        if (state->params->is_open[v])
            state->open[state->n++] = v;
    if (state->n > NETWORK_MAX_OPEN)
        return err_set(err, STATUS_INFEASIBLE,
                       "%zu ends have no known pressure or flow; at most %d can be estimated",
                       state->n, NETWORK_MAX_OPEN);
    for (size_t i = 0; i < network->n_segments; i++)
        for (int k = 0; k < 2; k++)
            state->weight[network->ends[i][k]] += state->params->length_mm[i] / 2;
    TRY(mem_alloc(&state->s0, state->n * state->n, sizeof *state->s0, "equations", err));
    TRY(mem_alloc(&state->s1, state->n * state->n, sizeof *state->s1, "equations", err));
    TRY(mem_alloc(&state->matrix, state->n * state->n, sizeof *state->matrix, "equations", err));
    return threads_try(state->n, state->params->threads, fill_row, state, err);
}

/* Computes p0, runs all starts, and compares them. */
static Status run_starts(const Estimation *state, Start *start, double *pressure,
                         NetworkSpread *spread, Err *err)
{
    NetworkFlow base = {0};
    Random random;
    Status status = STATUS_OK;
    random_seed(&random, state->params->seed);
    for (size_t s = 0; s < state->params->starts; s++)
        TRY(begin_start(state, s, &random, &start[s], err));
    TRY(solve(state, &(EstimateCase){.unit_node = UINT32_MAX, .is_whole = true}, &base, err));
    TRY_GOTO(double_weight(state, base.pressure, start, spread, err));
    for (size_t s = 1; s < state->params->starts; s++)
        TRY_GOTO(add_to_spread(state, &start[0].flow, &start[s].flow, spread, err));
    for (size_t b = 0; b < state->n; b++)
        pressure[state->open[b]] = start[0].pressure[b];
done:
    networkflow_release(&base);
    return status;
}

Status flownetwork_estimate(const FlowNetwork *network, const NetworkEstimate *params,
                            double *pressure, NetworkSpread *spread, Err *err)
{
    Estimation state = {.network = network, .params = params};
    Start *start = NULL;
    Status status = STATUS_OK;
    *spread = (NetworkSpread){.reversed = {HUGE_VAL, 0}, .change = {HUGE_VAL, 0}};
    TRY_GOTO(mem_calloc(&start, params->starts, sizeof *start, "starts", err));
    TRY_GOTO(prepare(&state, err));
    spread->open = state.n;
    TRY_GOTO(run_starts(&state, start, pressure, spread, err));
done:
    for (size_t s = 0; start && s < params->starts; s++) {
        networkflow_release(&start[s].flow);
        free(start[s].sign);
        free(start[s].pressure);
    }
    free(start);
    free(state.open);
    free(state.weight);
    free(state.s0);
    free(state.s1);
    free(state.matrix);
    return status;
}
