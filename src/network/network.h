/* The public header of the module network: steady flow in networks of vessels, also with loops.
 *
 * Each segment obeys Poiseuille's law: flow = (pressure at its first node - pressure at its second
 * node) / resistance. At each node the flows sum to the known inflow, as in Kirchhoff's laws.
 *
 *     TRY(network_solve(&network, &flow, err));
 *     double q = flow.flow[segment];
 *     networkflow_release(&flow);
 *
 * The unit of pressure is Pa and that of flow is mm^3/s, from mm, g and s. */
#ifndef CORCAST_NETWORK_NETWORK_H
#define CORCAST_NETWORK_NETWORK_H

#include "base/base.h"
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A network and its boundary conditions. All arrays are borrowed. */
typedef struct Network {
    size_t n_nodes, n_segments;
    const uint32_t (*ends)[2]; /* per segment: its first and its second node */
    const double *resistance;  /* per segment: Pa s/mm^3, >= 0; INFINITY: no blood flows */
    const double *pressure;    /* per node: known pressure, Pa; NAN: not known */
    const double *inflow; /* per node: flow that enters the network there, mm^3/s; below 0 if it
                           * leaves. It is not read at a node of known pressure. */
    const int32_t *id;    /* per node: its name in errors */
} Network;

/* The largest sum of the inflows of a component without a known pressure, divided by the sum of
 * their sizes. Inflows that a file states with four digits stay below it. */
#define NETWORK_MAX_EXCESS 1e-3

/* The steady flow. Arrays are owned; release with networkflow_release. */
typedef struct NetworkFlow {
    double *flow;     /* per segment: flow from its first to its second node */
    double *pressure; /* per node; NAN if it is not known and no open segment ends there */
    double *inflow;   /* per node: flow that enters the network there; at nodes of known pressure it
                       * follows from the flow */
    bool *is_lost;    /* per segment: rounding errors may exceed the flow, or the flow is 0; its
                       * direction is not known */
    double largest;   /* largest size of the flow in a segment */
    double imbalance; /* largest sum of the flows at a node, divided by `largest` */
    double own_imbalance; /* largest sum of the flows at a node, divided by half the sum of their
                           * sizes there; nodes with lost segments alone do not count */
    size_t components;    /* connected components that have a segment */
    size_t floating;      /* components without a known pressure. One node of each has the pressure
                           * 0, and its inflow is the negative sum of the component's inflows. */
    size_t unknowns;      /* pressures that were solved for after the reduction */
    size_t steps;         /* steps of conjugate gradients */
} NetworkFlow;

/* Computes the steady flow.
 *
 * Ends and chains are removed exactly. The pressures of the remaining nodes are found by conjugate
 * gradients, preconditioned by an incomplete Cholesky factor without fill, and the removed nodes
 * are restored in reverse order. In a tree whose terminals have known inflows nothing remains.
 *
 * Errors   STATUS_INPUT, naming a node, if the inflows of a component without a known pressure do
 *          not sum to 0 within NETWORK_MAX_EXCESS; STATUS_MEMORY.
 * Cost     O(n) for the reduction; the number of steps grows like the cube root of the unknowns. */
MUST_CHECK Status network_solve(const Network *network, NetworkFlow *out, Err *err);
void networkflow_release(NetworkFlow *flow);

#endif
