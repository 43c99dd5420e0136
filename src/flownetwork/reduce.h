/* Exact reduction of a network: nodes with one segment (ends) and with two segments (chains) are
 * eliminated, except nodes of known pressure. Private to the module flownetwork. */
#ifndef CORCAST_FLOWNETWORK_REDUCE_H
#define CORCAST_FLOWNETWORK_REDUCE_H

#include "flownetwork/flownetwork.h"

/* A segment of the network, or the vessel that replaces the two segments of an eliminated node. */
typedef struct FlowEdge {
    uint32_t node[2], slot[2]; /* its ends, and the position of the edge in their lists */
    double resistance;
    double flow, noise; /* flow from node[0] to node[1], and a bound of its rounding error */
} FlowEdge;

/* The elimination of a node. The edge `made` leads from the far end of edge[0] to that of edge[1];
 * NO_EDGE for an end, which has only edge[0]. */
typedef struct FlowStep {
    uint32_t node, edge[2], made;
} FlowStep;

#define NO_EDGE UINT32_MAX

/* A network while it is reduced. Owns its arrays, except `pressure`. */
typedef struct Reduction {
    FlowEdge *edge;   /* the open segments by their number, then the edges that were made */
    uint32_t *degree; /* per node: number of edges that remain */
    IndexLists lists; /* per node: its edges; the first `degree` of them remain */
    double *inflow;   /* per node, with those of the eliminated nodes */
    double *pressure; /* per node: known pressure, or NAN; reduction_restore sets the eliminated
                       * nodes. Borrowed. */
    FlowStep *step;
    size_t n_edges, n_steps;
} Reduction;

/* Reduces a network. `pressure` has an entry per node, which replaces network->pressure. Release
 * *out with reduction_release, also after an error. Errors: STATUS_MEMORY. Cost: O(n). */
MUST_CHECK Status reduction_make(const FlowNetwork *network, double *pressure, Reduction *out,
                                 Err *err);
void reduction_release(Reduction *reduction);

/* Returns the edge at position k < degree[node] of the list of a node, and its end there in *end.
 */
static inline FlowEdge *reduction_edge(const Reduction *reduction, uint32_t node, uint32_t k,
                                       int *end)
{
    uint32_t at = reduction->lists.first[node] + k;
    FlowEdge *edge = &reduction->edge[reduction->lists.items[at]];
    *end = edge->slot[0] == at ? 0 : 1;
    return edge;
}

/* Computes flow and pressure of the eliminated nodes and their edges. Requires the pressures of the
 * remaining nodes, and flow and noise of the remaining edges. */
void reduction_restore(Reduction *reduction);

/* Solves for the unknown pressures of the remaining nodes, and sets flow and noise of the remaining
 * edges. Adds to flow->unknowns and flow->steps. Errors: STATUS_MEMORY. */
MUST_CHECK Status core_solve(Reduction *reduction, size_t n_nodes, NetworkFlow *flow, Err *err);

#endif
