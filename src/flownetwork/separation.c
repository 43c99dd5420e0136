/* Computes flow and hematocrit together, by turns, with the law of phase separation at diverging
 * bifurcations.
 *
 * Nodes are visited in the order of falling pressure, so that the hematocrit of all inflows of a
 * node is known when its cells are divided. Equal pressures go by node number. */
#include "flownetwork/flownetwork.h"

#include <stdlib.h>
#include <string.h>

/* Minimum diameter, um, that a feeding vessel counts as in the law of phase separation. In the law,
 * a branch with less than a limiting share of the flow gets no cells. The limit is 0.964 (1 - H) /
 * diameter, which reaches a half at about 2 um, where the law loses its meaning. Twice this
 * diameter keeps well away from there. */
static const double min_feed_um = 4;

/* The iteration ends when no flow changes by more than flow_tolerance, mm^3/s (1e-3 nl/min), or
 * flow_fraction of the largest flow, and no hematocrit by more than hematocrit_tolerance. Smaller
 * tolerances need more rounds, or are never reached where two steady states are near. */
static const double flow_tolerance = 1e-6 / 60, flow_fraction = 1e-6, hematocrit_tolerance = 1e-3;

typedef struct RankedNode {
    double pressure;
    uint32_t node;
} RankedNode;

/* The state of the iteration. Owns its arrays. */
typedef struct Separation {
    const FlowNetwork *network;
    const NetworkBlood *blood;
    IndexLists lists;                /* per node: its segments */
    double *resistance, *now, *next; /* per segment; hematocrit of this round and of the next */
    double *last_flow;               /* per segment */
    uint32_t *out;                   /* workspace: the outflows of a node */
    RankedNode *rank;                /* workspace, per node */
} Separation;

double flownetwork_resistance(const NetworkBlood *blood, size_t i, double hematocrit)
{
    double radius = blood->radius_mm[i], scale = viscosity_cell_scale(blood->cell_fl);
    double viscosity = viscosity_pries_pa_s(radius * scale, hematocrit, blood->plasma_pa_s);
    return poiseuille_resistance(viscosity, blood->length_mm[i], radius);
}

/* Returns the share of the cells that enters the first of two branches, by the law of Pries and
 * Secomb: logit(cells) = A + B logit(x), where x is the share of the flow less the limit.
 * `flow_share` is the share of the flow of the first branch, `feed` the diameter of the feeding
 * vessel and `branch` the diameters of the branches, um. The numbers are the law's. */
static double cell_share(double hematocrit, double feed, const double branch[2], double flow_share)
{
    double plasma = (1 - hematocrit) / fmax(feed, min_feed_um);
    double ratio = branch[0] * branch[0] / (branch[1] * branch[1]);
    double a = -13.29 * (ratio - 1) / (ratio + 1) * plasma, b = 1 + 6.98 * plasma;
    double limit = 0.964 * plasma, x = (flow_share - limit) / (1 - 2 * limit);
    if (x <= 0 || x >= 1)
        return x >= 1;
    return 1 / (1 + elementary_exp(-a - b * elementary_log(x / (1 - x))));
}

/* The blood that flows into a node, and later the part of it that is left for the remaining
 * outflows. */
typedef struct Mixture {
    double flow, cells; /* mm^3/s of blood and of cells */
    double feed_um;     /* diameter of the thickest inflow; 0: none */
} Mixture;

static double diameter_um(const Separation *state, uint32_t segment)
{
    return 2e3 * state->blood->radius_mm[segment];
}

/* Returns the flow of a segment towards a node. */
static double flow_to(const Separation *state, const NetworkFlow *flow, uint32_t i, uint32_t node)
{
    return state->network->ends[i][1] == node ? flow->flow[i] : -flow->flow[i];
}

/* Sums what flows into a node: blood from segments, and blood that enters the network there. */
static Mixture mix_inflows(const Separation *state, const NetworkFlow *flow, uint32_t node)
{
    const double *given = state->blood->inflow_hematocrit;
    double boundary = fmax(flow->inflow[node], 0);
    Mixture in = {boundary,
                  boundary * (isnan(given[node]) ? state->blood->hematocrit : given[node]), 0};
    for (uint32_t k = state->lists.first[node]; k < state->lists.first[node + 1]; k++) {
        uint32_t i = state->lists.items[k];
        double q = flow_to(state, flow, i, node);
        if (!(q > 0))
            continue;
        in.flow += q;
        in.cells += q * state->next[i];
        if (!flow->direction_unknown[i])
            in.feed_um = fmax(in.feed_um, diameter_um(state, i));
    }
    return in;
}

/* Lists the outflows of a node in state->out and returns their number. Flow that is lost in
 * rounding does not separate cells: it gets the hematocrit `mixed`. */
static size_t list_outflows(const Separation *state, const NetworkFlow *flow, uint32_t node,
                            double mixed)
{
    size_t n = 0;
    for (uint32_t k = state->lists.first[node]; k < state->lists.first[node + 1]; k++) {
        uint32_t i = state->lists.items[k];
        double q = flow_to(state, flow, i, node);
        if (q < 0 && flow->direction_unknown[i])
            state->next[i] = mixed;
        else if (q < 0)
            state->out[n++] = i;
    }
    return n;
}

/* Divides the cells that flow into a node among its outflows. The law knows only two branches. So
 * the outflows are handled one after the other: each is the first branch, and the next outflow
 * represents the rest as the second branch. The next outflow's diameter is then the feeding
 * diameter of the rest. Blood that leaves or enters the network at the node takes no part in the
 * law. */
static void divide_cells(const Separation *state, const NetworkFlow *flow, uint32_t node)
{
    Mixture in = mix_inflows(state, flow, node);
    double mixed = in.flow > 0 ? in.cells / in.flow : state->blood->hematocrit;
    size_t n = list_outflows(state, flow, node, mixed);
    in.flow = 0;
    for (size_t k = 0; k < n; k++)
        in.flow += fabs(flow->flow[state->out[k]]);
    in.cells = mixed * in.flow;
    for (size_t k = 0; k < n; k++) {
        uint32_t i = state->out[k];
        double q = fabs(flow->flow[i]), share = k + 1 == n ? 1 : q / in.flow;
        if (k + 1 < n && in.feed_um > 0) {
            double branch[2] = {diameter_um(state, i), diameter_um(state, state->out[k + 1])};
            share = cell_share(in.cells / in.flow, in.feed_um, branch, q / in.flow);
            in.feed_um = branch[1];
        }
        state->next[i] = fmin(share * in.cells / q, MAX_HEMATOCRIT);
        in.cells *= 1 - share;
        in.flow -= q;
    }
}

static int compare_ranks(const void *left, const void *right)
{
    const RankedNode *a = left, *b = right;
    int order = compare_numbers(b->pressure, a->pressure);
    return order ? order : compare_numbers(a->node, b->node);
}

/* Computes the hematocrit of the next round from the flow of this one. */
static void divide_all_cells(const Separation *state, const NetworkFlow *flow)
{
    size_t n = 0;
    for (uint32_t v = 0; v < state->network->n_nodes; v++)
        if (!isnan(flow->pressure[v]))
            state->rank[n++] = (RankedNode){flow->pressure[v], v};
    qsort(state->rank, n, sizeof *state->rank, compare_ranks);
    for (size_t k = 0; k < n; k++)
        divide_cells(state, flow, state->rank[k].node);
}

/* Returns true if neither flow nor hematocrit changes any more. */
static bool is_settled(const Separation *state, const NetworkFlow *flow, NetworkCells *cells)
{
    cells->flow_change = cells->hematocrit_change = 0;
    for (size_t i = 0; i < state->network->n_segments; i++) {
        double q = flow->flow[i], change = fabs(state->next[i] - state->now[i]);
        cells->flow_change = fmax(cells->flow_change, fabs(q - state->last_flow[i]));
        if (fabs(q) > flow_fraction * flow->largest)
            cells->hematocrit_change = fmax(cells->hematocrit_change, change);
    }
    return cells->flow_change < fmax(flow_tolerance, flow_fraction * flow->largest) &&
           cells->hematocrit_change < hematocrit_tolerance;
}

/* Computes the resistances from the hematocrit, and then the flow. */
static Status solve_round(const Separation *state, NetworkFlow *flow, Err *err)
{
    FlowNetwork network = *state->network;
    for (size_t i = 0; i < network.n_segments; i++)
        state->resistance[i] = flownetwork_resistance(state->blood, i, state->now[i]);
    network.resistance = state->resistance;
    networkflow_release(flow);
    return flownetwork_solve(&network, flow, err);
}

/* Iterates until the result no longer changes. The hematocrit is relaxed to damp oscillations:
 * every 5 rounds, the next changes are taken by a fifth less. A faster decay would end before the
 * solution is reached. The hematocrit of the last round is not relaxed, so that no cells are lost.
 */
static Status iterate(Separation *state, NetworkFlow *flow, NetworkCells *cells, Err *err)
{
    size_t n = state->network->n_segments;
    double relaxation = 1;
    while (!cells->converged && cells->rounds < NETWORK_MAX_ROUNDS) {
        cells->rounds++;
        TRY(solve_round(state, flow, err));
        memcpy(state->next, state->now, n * sizeof *state->next);
        divide_all_cells(state, flow);
        cells->converged = is_settled(state, flow, cells);
        memcpy(state->last_flow, flow->flow, n * sizeof *state->last_flow);
        for (size_t i = 0; i < n; i++)
            state->now[i] += relaxation * (state->next[i] - state->now[i]);
        relaxation *= cells->rounds % 5 == 0 ? 0.8 : 1;
    }
    return STATUS_OK;
}

/* Measures the sum of the cell flows at nodes without inflow, and counts capped segments. */
static void balance(const Separation *state, const NetworkFlow *flow, NetworkCells *cells)
{
    double largest = 0, worst = 0;
    for (uint32_t v = 0; v < state->network->n_nodes; v++) {
        double sum = 0;
        for (uint32_t k = state->lists.first[v]; k < state->lists.first[v + 1]; k++) {
            uint32_t i = state->lists.items[k];
            double cell_flow = state->next[i] * flow_to(state, flow, i, v);
            sum += cell_flow;
            largest = fmax(largest, cell_flow);
        }
        if (flow->inflow[v] == 0)
            worst = fmax(worst, fabs(sum));
    }
    cells->imbalance = largest > 0 ? worst / largest : 0;
    for (size_t i = 0; i < state->network->n_segments; i++)
        cells->capped += state->next[i] >= MAX_HEMATOCRIT;
}

/* Allocates the arrays, and sets the initial hematocrit. */
static Status begin(Separation *state, Err *err)
{
    const FlowNetwork *network = state->network;
    size_t n = network->n_segments;
    ItemKeys keys = {&network->ends[0][0], n, 2};
    TRY(mem_alloc(&state->resistance, n, sizeof *state->resistance, "resistances", err));
    TRY(mem_alloc(&state->now, n, sizeof *state->now, "hematocrits", err));
    TRY(mem_alloc(&state->next, n, sizeof *state->next, "hematocrits", err));
    TRY(mem_calloc(&state->last_flow, n, sizeof *state->last_flow, "flows", err));
    TRY(mem_alloc(&state->out, n, sizeof *state->out, "segments", err));
    TRY(mem_alloc(&state->rank, network->n_nodes, sizeof *state->rank, "nodes", err));
    for (size_t i = 0; i < n; i++)
        state->now[i] = state->blood->hematocrit;
    return indexlists_sort(&state->lists, network->n_nodes, keys, "segments", err);
}

Status flownetwork_solve_with_cells(const FlowNetwork *network, const NetworkBlood *blood,
                                    NetworkFlow *flow, NetworkCells *cells, Err *err)
{
    Separation state = {.network = network, .blood = blood};
    Status status = STATUS_OK;
    *cells = (NetworkCells){0};
    *flow = (NetworkFlow){0};
    TRY_GOTO(begin(&state, err));
    TRY_GOTO(iterate(&state, flow, cells, err));
    balance(&state, flow, cells);
    cells->hematocrit = state.next;
    state.next = NULL;
done:
    free(state.resistance);
    free(state.now);
    free(state.next);
    free(state.last_flow);
    free(state.out);
    free(state.rank);
    indexlists_release(&state.lists);
    if (status != STATUS_OK)
        networkflow_release(flow);
    return status;
}
