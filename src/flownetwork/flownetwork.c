/* Solves a network: finds its connected components, sets the pressure 0 at one node of each
 * component without a known pressure, reduces the network, solves the rest, and measures the
 * errors.
 *
 * The node with the pressure 0 is the one with the largest absolute inflow. Its own inflow then
 * follows from the other inflows, and takes their rounding errors. */
#include "flownetwork/flownetwork.h"

#include "flownetwork/reduce.h"
#include <float.h>
#include <stdlib.h>
#include <string.h>

/* ---- components ------------------------------------------------------------------------------ */

/* A connected component, at the number of its first node. */
typedef struct Component {
    double sum, sizes;  /* of the inflows, and of their sizes */
    uint32_t reference; /* the node with the largest inflow; the first of equals */
    bool has_pressure, has_segment;
} Component;

static bool is_open(const FlowNetwork *network, size_t segment)
{
    return network->resistance[segment] < HUGE_VAL;
}

/* Joins the nodes of open segments. */
static void join_components(const FlowNetwork *network, uint32_t *parent)
{
    sets_begin(parent, network->n_nodes);
    for (size_t i = 0; i < network->n_segments; i++)
        if (is_open(network, i))
            sets_join(parent, network->ends[i][0], network->ends[i][1]);
}

/* Sums the inflows of each component, and finds its node with the largest absolute inflow. */
static void measure_components(const FlowNetwork *network, uint32_t *parent, Component *component)
{
    for (uint32_t v = 0; v < network->n_nodes; v++) {
        uint32_t top = sets_find(parent, v);
        Component *at = &component[top];
        if (top == v)
            at->reference = v;
        at->has_segment |= top != v;
        if (!isnan(network->pressure[v])) {
            at->has_pressure = true;
            continue;
        }
        at->sum += network->inflow[v];
        at->sizes += fabs(network->inflow[v]);
        if (fabs(network->inflow[v]) > fabs(network->inflow[at->reference]))
            at->reference = v;
    }
}

/* Sets the pressure 0 at a node of each component without a known pressure. */
static Status fix_pressures(const FlowNetwork *network, const Component *component,
                            double *pressure, NetworkFlow *out, Err *err)
{
    for (uint32_t v = 0; v < network->n_nodes; v++) {
        const Component *at = &component[v];
        out->components += at->has_segment;
        if (at->has_pressure)
            continue;
        if (!network->absorbs_excess && fabs(at->sum) > NETWORK_MAX_EXCESS * at->sizes)
            return err_set(err, STATUS_INPUT,
                           "the inflows of the vessels that are connected with node %d sum to %.6g "
                           "ml/min; they must sum to 0, because no pressure is known there",
                           network->id[at->reference], ml_min_from_mm3_s(at->sum));
        if (!at->has_segment)
            continue;
        pressure[at->reference] = 0;
        out->floating++;
        out->no_flow += at->sizes == 0;
        out->no_flow_node = at->sizes == 0 ? v : out->no_flow_node;
    }
    return STATUS_OK;
}

/* Finds the components, and sets the pressures that are needed. */
static Status check_components(const FlowNetwork *network, double *pressure, NetworkFlow *out,
                               Err *err)
{
    uint32_t *parent = NULL;
    Component *component = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_alloc(&parent, network->n_nodes, sizeof *parent, "nodes", err));
    TRY_GOTO(mem_calloc(&component, network->n_nodes, sizeof *component, "components", err));
    join_components(network, parent);
    measure_components(network, parent, component);
    TRY_GOTO(fix_pressures(network, component, pressure, out, err));
done:
    free(parent);
    free(component);
    return status;
}

/* ---- the solution ---------------------------------------------------------------------------- */

/* Copies the flows of the segments from the restored reduction. */
static void take_flows(const FlowNetwork *network, const Reduction *reduction, NetworkFlow *out)
{
    for (size_t i = 0; i < network->n_segments; i++) {
        out->flow[i] = reduction->edge[i].flow;
        out->largest = fmax(out->largest, fabs(out->flow[i]));
    }
    for (size_t i = 0; i < network->n_segments; i++) {
        double noise = fmax(reduction->edge[i].flow_error, 4 * DBL_EPSILON * out->largest);
        out->direction_unknown[i] = fabs(out->flow[i]) <= noise;
    }
}

/* Adds a number to the pressures. */
static void shift(double *pressure, size_t n, double by)
{
    for (size_t v = 0; v < n; v++)
        pressure[v] += by;
}

/* Returns a known pressure. Differences from it have smaller rounding errors than pressures. */
static double reference(const double *fixed, size_t n)
{
    for (size_t v = 0; v < n; v++)
        if (!isnan(fixed[v]))
            return fixed[v];
    return 0;
}

/* Measures the sum of the flows at each node, and sets the inflow at nodes of known pressure. */
static Status balance(const FlowNetwork *network, const double *fixed, NetworkFlow *out, Err *err)
{
    typedef struct Sum {
        double net, sizes;
        bool counts;
    } Sum;
    Sum *sum = NULL;
    TRY(mem_calloc(&sum, network->n_nodes, sizeof *sum, "nodes", err));
    for (size_t i = 0; i < network->n_segments; i++)
        for (int k = 0; k < 2; k++) {
            Sum *at = &sum[network->ends[i][k]];
            at->net += k == 0 ? -out->flow[i] : out->flow[i];
            at->sizes += fabs(out->flow[i]);
            at->counts |= !out->direction_unknown[i];
        }
    for (size_t v = 0; v < network->n_nodes; v++) {
        bool is_known = !isnan(fixed[v]);
        out->inflow[v] = is_known ? -sum[v].net : network->inflow[v];
        double excess = fabs(sum[v].net + out->inflow[v]);
        double size = (sum[v].sizes + fabs(out->inflow[v])) / 2;
        if (out->largest > 0)
            out->imbalance = fmax(out->imbalance, excess / out->largest);
        if (size > 0 && sum[v].counts)
            out->node_imbalance = fmax(out->node_imbalance, excess / size);
    }
    free(sum);
    return STATUS_OK;
}

static Status allocate(const FlowNetwork *network, NetworkFlow *out, Err *err)
{
    TRY(mem_calloc(&out->flow, network->n_segments, sizeof *out->flow, "flows", err));
    TRY(mem_calloc(&out->direction_unknown, network->n_segments, sizeof *out->direction_unknown,
                   "flows", err));
    TRY(mem_calloc(&out->pressure, network->n_nodes, sizeof *out->pressure, "pressures", err));
    return mem_calloc(&out->inflow, network->n_nodes, sizeof *out->inflow, "inflows", err);
}

Status flownetwork_solve(const FlowNetwork *network, NetworkFlow *out, Err *err)
{
    NetworkFlow made = {0};
    Reduction reduction = {0};
    double *fixed = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(allocate(network, &made, err));
    memcpy(made.pressure, network->pressure, network->n_nodes * sizeof *made.pressure);
    TRY_GOTO(check_components(network, made.pressure, &made, err));
    TRY_GOTO(mem_alloc(&fixed, network->n_nodes, sizeof *fixed, "pressures", err));
    memcpy(fixed, made.pressure, network->n_nodes * sizeof *fixed);
    double middle = reference(fixed, network->n_nodes);
    shift(made.pressure, network->n_nodes, -middle);
    TRY_GOTO(reduction_make(network, made.pressure, &reduction, err));
    TRY_GOTO(reduction_solve(&reduction, network->n_nodes, &made, err));
    reduction_restore(&reduction);
    shift(made.pressure, network->n_nodes, middle);
    take_flows(network, &reduction, &made);
    TRY_GOTO(balance(network, fixed, &made, err));
    *out = made;
    made = (NetworkFlow){0};
done:
    free(fixed);
    reduction_release(&reduction);
    networkflow_release(&made);
    return status;
}

void networkflow_release(NetworkFlow *flow)
{
    free(flow->flow);
    free(flow->direction_unknown);
    free(flow->pressure);
    free(flow->inflow);
    *flow = (NetworkFlow){0};
}
