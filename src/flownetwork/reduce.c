/* Eliminates the nodes of a network that have one or two edges, and restores them after the
 * solution.
 *
 * A chain a - v - b becomes one edge a - b. The inflow of v goes to a and b in the ratio of the
 * resistances behind it, as current divides between two resistors. A chain that begins and ends at
 * one node carries only the inflow of v, and no edge is made. Each node enters the stack once, when
 * no more than two edges are left at it. */
#include "flownetwork/reduce.h"

#include <stdlib.h>

/* Makes an edge of each open segment, and the lists of the edges at each node. A segment from a
 * node to itself carries no flow, so it gets no edge. */
static Status fill_lists(const FlowNetwork *network, Reduction *reduction, Err *err)
{
    IndexLists *lists = &reduction->lists;
    TRY(indexlists_begin(lists, network->n_nodes, "segments", err));
    for (size_t i = 0; i < network->n_segments; i++) {
        const uint32_t *ends = network->ends[i];
        bool is_open = network->resistance[i] < HUGE_VAL && ends[0] != ends[1];
        for (int k = 0; is_open && k < 2; k++)
            indexlists_count(lists, ends[k]);
        reduction->edge[i].node[0] = is_open ? ends[0] : NO_EDGE;
        reduction->edge[i].node[1] = ends[1];
        reduction->edge[i].resistance = network->resistance[i];
    }
    TRY(indexlists_allot(lists, "segments", err));
    for (size_t i = 0; i < network->n_segments; i++)
        for (int k = 0; reduction->edge[i].node[0] != NO_EDGE && k < 2; k++) {
            uint32_t node = reduction->edge[i].node[k];
            reduction->edge[i].slot[k] = lists->first[node + 1];
            indexlists_put(lists, node, (uint32_t)i);
        }
    reduction->n_edges = network->n_segments;
    return STATUS_OK;
}

/* Returns true if a node may be eliminated, because its pressure is not known. */
static bool is_free(const Reduction *reduction, uint32_t node)
{
    return isnan(reduction->pressure[node]);
}

/* Nodes that wait for their elimination. */
typedef struct NodeStack {
    uint32_t *node;
    size_t n;
} NodeStack;

/* Removes the edge at position `at` from the list of a node. */
static void drop(Reduction *reduction, uint32_t node, uint32_t at, NodeStack *stack)
{
    IndexLists *lists = &reduction->lists;
    uint32_t last = lists->first[node] + --reduction->degree[node];
    uint32_t moved = lists->items[last];
    FlowEdge *edge = &reduction->edge[moved];
    lists->items[at] = moved;
    edge->slot[edge->slot[0] == last ? 0 : 1] = at;
    if (reduction->degree[node] == 2 && is_free(reduction, node))
        stack->node[stack->n++] = node;
}

/* Eliminates a node with one edge: its inflow enters at the other end of the edge. */
static void remove_end(Reduction *reduction, FlowStep *step, NodeStack *stack)
{
    int end;
    FlowEdge *edge = reduction_edge(reduction, step->node, 0, &end);
    uint32_t far = edge->node[1 - end];
    step->edge[0] = (uint32_t)(edge - reduction->edge);
    reduction->inflow[far] += reduction->inflow[step->node];
    drop(reduction, far, edge->slot[1 - end], stack);
}

/* Returns the fraction of the inflow of a chain's node that leaves through edge[0]. */
static double part_back(const FlowEdge *back, const FlowEdge *ahead)
{
    double sum = back->resistance + ahead->resistance;
    return sum > 0 ? ahead->resistance / sum : 0.5;
}

/* Eliminates a node with two edges: replaces them by one edge between their other ends, and divides
 * the inflow between these. */
static void remove_chain(Reduction *reduction, FlowStep *step, NodeStack *stack)
{
    FlowEdge *made = &reduction->edge[reduction->n_edges], *edge[2];
    double inflow = reduction->inflow[step->node];
    for (uint32_t k = 0; k < 2; k++) {
        int end;
        edge[k] = reduction_edge(reduction, step->node, k, &end);
        step->edge[k] = (uint32_t)(edge[k] - reduction->edge);
        made->node[k] = edge[k]->node[1 - end];
        made->slot[k] = edge[k]->slot[1 - end];
    }
    double back = inflow * part_back(edge[0], edge[1]);
    made->resistance = edge[0]->resistance + edge[1]->resistance;
    reduction->inflow[made->node[0]] += back;
    reduction->inflow[made->node[1]] += inflow - back;
    step->made = (uint32_t)reduction->n_edges++;
    if (made->node[0] == made->node[1]) {
        drop(reduction, made->node[0], made->slot[0], stack);
        /* The first call may have moved the second edge. */
        uint32_t at = edge[1]->slot[edge[1]->node[0] == made->node[0] ? 0 : 1];
        drop(reduction, made->node[1], at, stack);
    } else {
        reduction->lists.items[made->slot[0]] = step->made;
        reduction->lists.items[made->slot[1]] = step->made;
    }
}

/* Eliminates the nodes on the stack, and the nodes that this leaves with at most two edges. */
static void eliminate(Reduction *reduction, NodeStack *stack)
{
    while (stack->n > 0) {
        FlowStep step = {
            .node = stack->node[--stack->n], .edge = {NO_EDGE, NO_EDGE}, .made = NO_EDGE};
        uint32_t degree = reduction->degree[step.node];
        if (degree == 0)
            continue;
        reduction->step[reduction->n_steps] = step;
        (degree == 1 ? remove_end : remove_chain)(reduction, &reduction->step[reduction->n_steps++],
                                                  stack);
        reduction->degree[step.node] = 0;
    }
}

Status reduction_make(const FlowNetwork *network, double *pressure, Reduction *out, Err *err)
{
    NodeStack stack = {0};
    size_t n = network->n_nodes;
    Status status = STATUS_OK;
    *out = (Reduction){.pressure = pressure};
    if (network->n_segments + n >= NO_EDGE)
        return err_set(err, STATUS_MEMORY, "the network has too many segments to compute its flow");
    TRY(mem_calloc(&out->edge, network->n_segments + n, sizeof *out->edge, "segments", err));
    TRY(mem_calloc(&out->degree, n, sizeof *out->degree, "nodes", err));
    TRY(mem_calloc(&out->inflow, n, sizeof *out->inflow, "nodes", err));
    TRY(mem_alloc(&out->step, n, sizeof *out->step, "nodes", err));
    TRY_GOTO(mem_alloc(&stack.node, n, sizeof *stack.node, "nodes", err));
    TRY_GOTO(fill_lists(network, out, err));
    for (uint32_t v = 0; v < n; v++) {
        out->inflow[v] = network->inflow[v];
        out->degree[v] = indexlists_length(&out->lists, v);
        if (out->degree[v] <= 2 && is_free(out, v))
            stack.node[stack.n++] = v;
    }
    eliminate(out, &stack);
done:
    free(stack.node);
    return status;
}

void reduction_release(Reduction *reduction)
{
    free(reduction->edge);
    free(reduction->degree);
    free(reduction->inflow);
    free(reduction->step);
    indexlists_release(&reduction->lists);
    *reduction = (Reduction){0};
}

/* Sets the flow of an edge away from `node`, and returns the pressure at `node` that follows from
 * that at the other end. */
static double set_flow(const Reduction *reduction, FlowEdge *edge, uint32_t node, double flow)
{
    int end = edge->node[0] == node ? 0 : 1;
    edge->flow = end == 0 ? flow : -flow;
    return reduction->pressure[edge->node[1 - end]] + edge->resistance * flow;
}

void reduction_restore(Reduction *reduction)
{
    for (size_t i = reduction->n_steps; i-- > 0;) {
        const FlowStep *step = &reduction->step[i];
        uint32_t node = step->node;
        FlowEdge *back = &reduction->edge[step->edge[0]];
        double inflow = reduction->inflow[node];
        if (step->made == NO_EDGE) {
            reduction->pressure[node] = set_flow(reduction, back, node, inflow);
            continue;
        }
        const FlowEdge *made = &reduction->edge[step->made];
        FlowEdge *ahead = &reduction->edge[step->edge[1]];
        double out = made->flow + inflow * (1 - part_back(back, ahead));
        double pressure[2] = {set_flow(reduction, back, node, inflow - out),
                              set_flow(reduction, ahead, node, out)};
        reduction->pressure[node] = pressure[back->resistance > ahead->resistance];
        back->flow_error = ahead->flow_error = made->flow_error;
    }
}
