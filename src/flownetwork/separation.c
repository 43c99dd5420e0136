/* Nodes are visited in the order of falling pressure, so that the hematocrit of all inflows of a
 * node is known when its cells are divided. Equal pressures go by node number. */
#include "flownetwork/flownetwork.h"

#include <stdlib.h>
#include <string.h>

/* The law of phase separation means nothing where the feeding vessel is so narrow that its limit of
 * flow without cells reaches a half, at about 2 um: the diameter counts as at least this, um. */
static const double least_feed_um = 4;

/* The end of the iteration. Flow in mm^3/s, and as a part of the largest. */
static const double flow_tolerance = 1e-6 / 60, flow_part = 1e-6, hematocrit_tolerance = 1e-3;

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

/* Returns the share of the cells that enters the branch `a`. Diameters are in um. */
static double cell_share(double hematocrit, double feed, const double branch[2], double flow_share)
{
    double plasma = (1 - hematocrit) / fmax(feed, least_feed_um);
    double ratio = branch[0] * branch[0] / (branch[1] * branch[1]);
    double a = -13.29 * (ratio - 1) / (ratio + 1) * plasma, b = 1 + 6.98 * plasma;
    double limit = 0.964 * plasma, x = (flow_share - limit) / (1 - 2 * limit);
    if (x <= 0 || x >= 1)
        return x >= 1;
    return 1 / (1 + elementary_exp(-a - b * elementary_log(x / (1 - x))));
}

/* The blood at a node: what flows in, then what is left for the outflows. */
typedef struct Mixture {
    double flow, cells, feed_um;
} Mixture;

static double diameter_um(const Separation *made, uint32_t segment)
{
    return 2e3 * made->blood->radius_mm[segment];
}

/* Returns the flow of a segment towards a node. */
static double flow_to(const Separation *made, const NetworkFlow *flow, uint32_t i, uint32_t node)
{
    return made->network->ends[i][1] == node ? flow->flow[i] : -flow->flow[i];
}

static Mixture mix(const Separation *made, const NetworkFlow *flow, uint32_t node)
{
    const double *given = made->blood->inflow_hematocrit;
    double boundary = fmax(flow->inflow[node], 0);
    Mixture in = {boundary, boundary * (isnan(given[node]) ? made->blood->hematocrit : given[node]),
                  0};
    for (uint32_t k = made->lists.first[node]; k < made->lists.first[node + 1]; k++) {
        uint32_t i = made->lists.items[k];
        double q = flow_to(made, flow, i, node);
        if (!(q > 0))
            continue;
        in.flow += q;
        in.cells += q * made->next[i];
        if (!flow->is_lost[i])
            in.feed_um = fmax(in.feed_um, diameter_um(made, i));
    }
    return in;
}

/* Lists the outflows of a node in made->out and returns their number. Flow that is lost in rounding
 * does not separate cells: it gets the hematocrit `mixed`. */
static size_t list_outflows(const Separation *made, const NetworkFlow *flow, uint32_t node,
                            double mixed)
{
    size_t n = 0;
    for (uint32_t k = made->lists.first[node]; k < made->lists.first[node + 1]; k++) {
        uint32_t i = made->lists.items[k];
        double q = flow_to(made, flow, i, node);
        if (q < 0 && flow->is_lost[i])
            made->next[i] = mixed;
        else if (q < 0)
            made->out[n++] = i;
    }
    return n;
}

/* Divides the cells that flow into a node among its outflows: one after the other, each against the
 * rest, where the diameter of the next outflow stands for that of the rest and then feeds it. Blood
 * that leaves or enters the network at the node takes no part in the law. */
static void divide(const Separation *made, const NetworkFlow *flow, uint32_t node)
{
    Mixture in = mix(made, flow, node);
    double mixed = in.flow > 0 ? in.cells / in.flow : made->blood->hematocrit;
    size_t n = list_outflows(made, flow, node, mixed);
    in.flow = 0;
    for (size_t k = 0; k < n; k++)
        in.flow += fabs(flow->flow[made->out[k]]);
    in.cells = mixed * in.flow;
    for (size_t k = 0; k < n; k++) {
        uint32_t i = made->out[k];
        double q = fabs(flow->flow[i]), share = k + 1 == n ? 1 : q / in.flow;
        if (k + 1 < n && in.feed_um > 0) {
            double branch[2] = {diameter_um(made, i), diameter_um(made, made->out[k + 1])};
            share = cell_share(in.cells / in.flow, in.feed_um, branch, q / in.flow);
            in.feed_um = branch[1];
        }
        made->next[i] = fmin(share * in.cells / q, MAX_HEMATOCRIT);
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
static void divide_all(const Separation *made, const NetworkFlow *flow)
{
    size_t n = 0;
    for (uint32_t v = 0; v < made->network->n_nodes; v++)
        if (!isnan(flow->pressure[v]))
            made->rank[n++] = (RankedNode){flow->pressure[v], v};
    qsort(made->rank, n, sizeof *made->rank, compare_ranks);
    for (size_t k = 0; k < n; k++)
        divide(made, flow, made->rank[k].node);
}

/* Returns true if neither flow nor hematocrit changes any more. */
static bool is_settled(const Separation *made, const NetworkFlow *flow, NetworkCells *cells)
{
    cells->flow_change = cells->hematocrit_change = 0;
    for (size_t i = 0; i < made->network->n_segments; i++) {
        double q = flow->flow[i], change = fabs(made->next[i] - made->now[i]);
        cells->flow_change = fmax(cells->flow_change, fabs(q - made->last_flow[i]));
        if (fabs(q) > flow_part * flow->largest)
            cells->hematocrit_change = fmax(cells->hematocrit_change, change);
    }
    return cells->flow_change < fmax(flow_tolerance, flow_part * flow->largest) &&
           cells->hematocrit_change < hematocrit_tolerance;
}

static Status solve_round(const Separation *made, NetworkFlow *flow, Err *err)
{
    FlowNetwork network = *made->network;
    for (size_t i = 0; i < network.n_segments; i++)
        made->resistance[i] = flownetwork_resistance(made->blood, i, made->now[i]);
    network.resistance = made->resistance;
    networkflow_release(flow);
    return flownetwork_solve(&network, flow, err);
}

/* Iterates. The last hematocrit is not relaxed, so that no cells are lost. */
static Status iterate(Separation *made, NetworkFlow *flow, NetworkCells *cells, Err *err)
{
    size_t n = made->network->n_segments;
    double relaxation = 1;
    while (!cells->converged && cells->rounds < NETWORK_MAX_ROUNDS) {
        cells->rounds++;
        TRY(solve_round(made, flow, err));
        memcpy(made->next, made->now, n * sizeof *made->next);
        divide_all(made, flow);
        cells->converged = is_settled(made, flow, cells);
        memcpy(made->last_flow, flow->flow, n * sizeof *made->last_flow);
        for (size_t i = 0; i < n; i++)
            made->now[i] += relaxation * (made->next[i] - made->now[i]);
        relaxation *= cells->rounds % 5 == 0 ? 0.8 : 1;
    }
    return STATUS_OK;
}

/* Measures the sum of the cell flows at nodes without inflow, and counts capped segments. */
static void balance(const Separation *made, const NetworkFlow *flow, NetworkCells *cells)
{
    double largest = 0, worst = 0;
    for (uint32_t v = 0; v < made->network->n_nodes; v++) {
        double sum = 0;
        for (uint32_t k = made->lists.first[v]; k < made->lists.first[v + 1]; k++) {
            uint32_t i = made->lists.items[k];
            double cell_flow = made->next[i] * flow_to(made, flow, i, v);
            sum += cell_flow;
            largest = fmax(largest, cell_flow);
        }
        if (flow->inflow[v] == 0)
            worst = fmax(worst, fabs(sum));
    }
    cells->imbalance = largest > 0 ? worst / largest : 0;
    for (size_t i = 0; i < made->network->n_segments; i++)
        cells->capped += made->next[i] >= MAX_HEMATOCRIT;
}

static Status begin(Separation *made, Err *err)
{
    const FlowNetwork *network = made->network;
    size_t n = network->n_segments;
    ItemKeys keys = {&network->ends[0][0], n, 2};
    TRY(mem_alloc(&made->resistance, n, sizeof *made->resistance, "resistances", err));
    TRY(mem_alloc(&made->now, n, sizeof *made->now, "hematocrits", err));
    TRY(mem_alloc(&made->next, n, sizeof *made->next, "hematocrits", err));
    TRY(mem_calloc(&made->last_flow, n, sizeof *made->last_flow, "flows", err));
    TRY(mem_alloc(&made->out, n, sizeof *made->out, "segments", err));
    TRY(mem_alloc(&made->rank, network->n_nodes, sizeof *made->rank, "nodes", err));
    for (size_t i = 0; i < n; i++)
        made->now[i] = made->blood->hematocrit;
    return indexlists_sort(&made->lists, network->n_nodes, keys, "segments", err);
}

Status flownetwork_solve_with_cells(const FlowNetwork *network, const NetworkBlood *blood,
                                    NetworkFlow *flow, NetworkCells *cells, Err *err)
{
    Separation made = {.network = network, .blood = blood};
    Status status = STATUS_OK;
    *cells = (NetworkCells){0};
    *flow = (NetworkFlow){0};
    TRY_GOTO(begin(&made, err));
    TRY_GOTO(iterate(&made, flow, cells, err));
    balance(&made, flow, cells);
    cells->hematocrit = made.next;
    made.next = NULL;
done:
    free(made.resistance);
    free(made.now);
    free(made.next);
    free(made.last_flow);
    free(made.out);
    free(made.rank);
    indexlists_release(&made.lists);
    if (status != STATUS_OK)
        networkflow_release(flow);
    return status;
}
