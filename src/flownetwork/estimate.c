/* Estimates the pressures of nodes without boundary conditions [flownetwork.h: the objective].
 *
 * The pressures p of all nodes are a linear function of the pressures y of the open nodes: p = p0 +
 * Z y. Each column of Z is a solution of the network. The objective is quadratic in p, so that its
 * derivative by y is a system of equations as large as the number of open nodes, S y = b. Z is not
 * stored: its transpose acts through a second solution, whose inflows are the derivative of the
 * objective by p, and S = S0 + k S1 is computed once for all k and all directions. */
#include "flownetwork/flownetwork.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* The first and the last weight k of the stress, which doubles from step to step, in the units of
 * the source: pressure in mmHg and stress in dyn/cm^2 = 0.1 Pa. With a larger last weight, the
 * stress would dominate the pressures. SOLVES_PER_WEIGHT is the maximum number of minimizations per
 * weight, in case directions keep turning. */
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

/* Which inflows and pressures a solution has. */
typedef struct Load {
    const double *inflow;   /* per node; NULL: 0 */
    const double *pressure; /* per open node; NULL: 0 */
    uint32_t unit;          /* open node with the pressure 1; UINT32_MAX: none */
    bool is_whole;          /* known pressures and inflows are those of the network, else 0 */
} Load;

/* Solves the network for a load. */
static Status solve(const Estimation *state, const Load *load, NetworkFlow *flow, Err *err)
{
    FlowNetwork network = *state->network;
    double *pressure = NULL, *inflow = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&pressure, network.n_nodes, sizeof *pressure, "pressures", err));
    TRY_GOTO(mem_calloc(&inflow, network.n_nodes, sizeof *inflow, "inflows", err));
    for (size_t v = 0; v < network.n_nodes; v++) {
        bool is_known = !isnan(network.pressure[v]);
        pressure[v] = is_known && !load->is_whole ? 0 : network.pressure[v];
        inflow[v] = load->inflow ? load->inflow[v] : load->is_whole ? network.inflow[v] : 0;
    }
    for (size_t b = 0; b < state->n; b++)
        pressure[state->open[b]] = load->pressure ? load->pressure[b] : b == load->unit;
    network.pressure = pressure;
    network.inflow = inflow;
    network.absorbs = !load->is_whole;
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

/* Adds the derivative by p of half the sum of l (tau - target)^2. `sign` is NULL for target 0. */
static void add_stress(const Estimation *state, const double *pressure, const signed char *sign,
                       double weight, double *slope)
{
    for (size_t i = 0; i < state->network->n_segments; i++) {
        const uint32_t *ends = state->network->ends[i];
        double factor = stress_factor(state, i), drop = pressure[ends[0]] - pressure[ends[1]];
        double excess = factor * drop - (sign ? sign[i] * state->params->stress_pa : 0);
        double change = weight * state->params->length_mm[i] * factor * excess;
        if (state->network->resistance[i] < HUGE_VAL) {
            slope[ends[0]] += change;
            slope[ends[1]] -= change;
        }
    }
}

/* Adds the derivative by p of half the sum of w (p - target)^2. */
static void add_pressure(const Estimation *state, const double *pressure, double target,
                         double *slope)
{
    for (size_t v = 0; v < state->network->n_nodes; v++)
        slope[v] += isnan(pressure[v]) ? 0 : state->weight[v] * (pressure[v] - target);
}

/* Turns the derivative by p into that by y: the product with the transpose of Z. */
static Status project(const Estimation *state, const double *slope, double *out, Err *err)
{
    NetworkFlow flow = {0};
    TRY(solve(state, &(Load){.inflow = slope, .unit = UINT32_MAX}, &flow, err));
    for (size_t b = 0; b < state->n; b++)
        out[b] = slope[state->open[b]] - flow.inflow[state->open[b]];
    networkflow_release(&flow);
    return STATUS_OK;
}

/* Computes the rows b of S0 and S1. */
static Status fill_row(size_t b, int worker, void *context, Err *err)
{
    const Estimation *state = context;
    NetworkFlow flow = {0};
    double *slope = NULL;
    Status status = STATUS_OK;
    (void)worker;
    TRY_GOTO(mem_calloc(&slope, state->network->n_nodes, sizeof *slope, "derivatives", err));
    TRY_GOTO(solve(state, &(Load){.unit = (uint32_t)b}, &flow, err));
    add_pressure(state, flow.pressure, 0, slope);
    TRY_GOTO(project(state, slope, state->s0 + b * state->n, err));
    memset(slope, 0, state->network->n_nodes * sizeof *slope);
    add_stress(state, flow.pressure, NULL, 1, slope);
    TRY_GOTO(project(state, slope, state->s1 + b * state->n, err));
done:
    free(slope);
    networkflow_release(&flow);
    return status;
}

/* Factorizes S0 + weight S1 by Cholesky's method. */
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

/* Finds the minimum for the directions of a start, and takes the directions of the solution.
 * *turned receives whether one has changed. */
static Status minimize(const Estimation *state, const double *base, double weight, Start *start,
                       bool *turned, Err *err)
{
    double *slope = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&slope, state->network->n_nodes, sizeof *slope, "derivatives", err));
    add_pressure(state, base, state->params->pressure_pa, slope);
    add_stress(state, base, start->sign, weight, slope);
    TRY_GOTO(project(state, slope, start->pressure, err));
    for (size_t b = 0; b < state->n; b++)
        start->pressure[b] = -start->pressure[b];
    substitute(state, start->pressure);
    networkflow_release(&start->flow);
    TRY_GOTO(
        solve(state, &(Load){.pressure = start->pressure, .is_whole = true}, &start->flow, err));
    *turned = false;
    for (size_t i = 0; i < state->network->n_segments; i++) {
        signed char sign = start->flow.flow[i] < 0 ? -1 : 1;
        if (start->flow.is_lost[i] || sign == start->sign[i])
            continue;
        start->sign[i] = sign;
        *turned = true;
    }
done:
    free(slope);
    return status;
}

/* Raises the weight of the stress. The first start alone begins with the weight 0. */
static Status raise_weight(const Estimation *state, const double *base, Start *start,
                           NetworkSpread *spread, Err *err)
{
    const double unit = pa_from_mmhg(10); /* 1 mmHg / (1 dyn/cm^2), as a ratio of Pa: the weight in
                                             SI units is k times its square */
    for (double k = 0; k <= last_weight; k = k > 0 ? 2 * k : first_weight) {
        factorize(state, k * unit * unit);
        for (size_t s = 0; s < (k > 0 ? state->params->starts : 1); s++) {
            bool turned = true;
            for (int i = 0; turned && i < (k > 0 ? SOLVES_PER_WEIGHT : 1); i++) {
                TRY(minimize(state, base, k * unit * unit, &start[s], &turned, err));
                spread->solves += s == 0;
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

/* Compares the flow of another start with that of the first, where its direction is known. */
static Status compare(const Estimation *state, const NetworkFlow *first, const NetworkFlow *other,
                      NetworkSpread *spread, Err *err)
{
    double *change = NULL, turned = 0;
    size_t n = 0;
    TRY(mem_alloc(&change, state->network->n_segments, sizeof *change, "flows", err));
    for (size_t i = 0; i < state->network->n_segments; i++) {
        if (first->is_lost[i])
            continue;
        double ratio = other->flow[i] / first->flow[i];
        turned += ratio < 0;
        change[n++] = fabs(ratio - 1);
    }
    if (n > 0) {
        double now[2] = {turned / (double)n, select_number(change, n, n / 2)};
        spread->turned[0] = fmin(spread->turned[0], now[0]);
        spread->turned[1] = fmax(spread->turned[1], now[0]);
        spread->change[0] = fmin(spread->change[0], now[1]);
        spread->change[1] = fmax(spread->change[1], now[1]);
    }
    free(change);
    return STATUS_OK;
}

/* Lists the open nodes, computes the weights, and computes S0 and S1, one row per call of a thread.
 */
static Status begin(Estimation *state, Err *err)
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
static Status run(const Estimation *state, Start *start, double *pressure, NetworkSpread *spread,
                  Err *err)
{
    NetworkFlow base = {0};
    Random random;
    Status status = STATUS_OK;
    random_seed(&random, state->params->seed);
    for (size_t s = 0; s < state->params->starts; s++)
        TRY(begin_start(state, s, &random, &start[s], err));
    TRY(solve(state, &(Load){.unit = UINT32_MAX, .is_whole = true}, &base, err));
    TRY_GOTO(raise_weight(state, base.pressure, start, spread, err));
    for (size_t s = 1; s < state->params->starts; s++)
        TRY_GOTO(compare(state, &start[0].flow, &start[s].flow, spread, err));
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
    *spread = (NetworkSpread){.turned = {HUGE_VAL, 0}, .change = {HUGE_VAL, 0}};
    TRY_GOTO(mem_calloc(&start, params->starts, sizeof *start, "starts", err));
    TRY_GOTO(begin(&state, err));
    spread->open = state.n;
    TRY_GOTO(run(&state, start, pressure, spread, err));
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
