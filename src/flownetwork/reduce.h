/* Exact reduction of a network: eliminates nodes with one segment (ends) and with two segments
 * (chains), except nodes of known pressure. Call reduction_make, reduction_solve, then
 * reduction_restore. Private to the module flownetwork.
 *
 * The inflow of an eliminated end moves to its neighbour, that of a node of a chain to both
 * neighbours, divided as current divides. The pressures of the remaining nodes do not change. */
#ifndef CORCAST_FLOWNETWORK_REDUCE_H
#define CORCAST_FLOWNETWORK_REDUCE_H

#include "flownetwork/flownetwork.h"

/* A segment of the network, or the vessel that replaces the two segments of an eliminated node. */
typedef struct FlowEdge {
    uint32_t node[2];  /* its two ends */
    uint32_t slot[2];  /* per end: position of the edge in Reduction.lists.items */
    double resistance; /* Pa s/mm^3 */
    double flow;       /* flow from node[0] to node[1], mm^3/s */
    double flow_error; /* bound of the rounding error of `flow`, mm^3/s */
} FlowEdge;

/* The elimination of a node. edge[0] and edge[1] are the edges at the node. `made` is the edge that
 * replaces them: it leads from the other end of edge[0] to the other end of edge[1]. At a node with
 * one edge, edge[1] and `made` are NO_EDGE. */
typedef struct FlowStep {
    uint32_t node, edge[2], made;
} FlowStep;

#define NO_EDGE UINT32_MAX

/* A network while it is reduced. Owns its arrays, except `pressure`. */
typedef struct Reduction {
    FlowEdge *edge;   /* per segment of the network, in which a closed one is unused and has the
                       * node[0] NO_EDGE; then the edges that replaced others */
    uint32_t *degree; /* per node: number of its remaining edges */
    IndexLists lists; /* per node: its edges; the first `degree` of them are the remaining ones */
    double *inflow;   /* per node: inflow, plus the inflows of eliminated neighbours, mm^3/s */
    double *pressure; /* per node: known pressure, Pa, or NAN. reduction_solve sets the remaining
                       * nodes, reduction_restore the eliminated nodes. Borrowed */
    FlowStep *step;   /* the eliminations, in order */
    size_t n_edges, n_steps;
} Reduction;

/* Eliminates the ends and chains of `network`, and lists the eliminations in out->step.
 *
 * pressure  per node: known pressure, Pa, or NAN; used instead of network->pressure. Borrowed until
 *           reduction_release.
 * out       release it with reduction_release, also after an error.
 * Errors    STATUS_MEMORY.
 * Cost      O(n). */
MUST_CHECK Status reduction_make(const FlowNetwork *network, double *pressure, Reduction *out,
                                 Err *err);
void reduction_release(Reduction *reduction);

/* Returns remaining edge k < degree[node] of a node. *end receives the end of the edge, 0 or 1,
 * that is at the node. */
static inline FlowEdge *reduction_edge(const Reduction *reduction, uint32_t node, uint32_t k,
                                       int *end)
{
    uint32_t at = reduction->lists.first[node] + k;
    FlowEdge *edge = &reduction->edge[reduction->lists.items[at]];
    *end = edge->slot[0] == at ? 0 : 1;
    return edge;
}

/* Sets the pressures of the eliminated nodes, and flow and flow_error of their edges. Call it after
 * reduction_solve. */
void reduction_restore(Reduction *reduction);

/* Solves for the unknown pressures of the remaining nodes, and sets flow and flow_error of the
 * remaining edges. Adds the number of unknowns to flow->unknowns, and the number of steps of
 * conjugate gradients to flow->steps. Errors: STATUS_MEMORY. */
MUST_CHECK Status reduction_solve(Reduction *reduction, size_t n_nodes, NetworkFlow *flow,
                                  Err *err);

#endif
