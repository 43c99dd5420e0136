/* The public header of the module flownetwork: steady flow in networks of vessels, also with loops.
 *
 * Each segment obeys Poiseuille's law: flow = (pressure at its first node - pressure at its second
 * node) / resistance. At each node the flows sum to the known inflow, as in Kirchhoff's laws.
 *
 *     TRY(flownetwork_solve(&network, &flow, err));
 *     double q = flow.flow[segment];
 *     networkflow_release(&flow);
 *
 * The unit of pressure is Pa and that of flow is mm^3/s, from mm, g and s. */
#ifndef CORCAST_FLOWNETWORK_FLOWNETWORK_H
#define CORCAST_FLOWNETWORK_FLOWNETWORK_H

#include "base/base.h"
#include "tree/tree.h"
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A network and its boundary conditions. All arrays are borrowed. */
typedef struct FlowNetwork {
    size_t n_nodes, n_segments;
    const uint32_t (*ends)[2]; /* per segment: its first and its second node */
    const double *resistance;  /* per segment: Pa s/mm^3, >= 0; INFINITY: no blood flows */
    const double *pressure;    /* per node: known pressure, Pa; NAN: not known */
    const double *inflow; /* per node: flow that enters the network there, mm^3/s; below 0 if it
                           * leaves. It is not read at a node of known pressure. */
    const int32_t *id;    /* per node: its name in errors */
    bool absorbs;         /* accepts inflows of any sum in components without a known pressure */
} FlowNetwork;

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
    size_t idle;          /* floating components without any inflow, so that all flow is 0 */
    uint32_t idle_node;   /* a node of the last of them */
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
MUST_CHECK Status flownetwork_solve(const FlowNetwork *network, NetworkFlow *out, Err *err);
void networkflow_release(NetworkFlow *flow);

/* ---- red cells ------------------------------------------------------------------------------- */

/* What the hematocrit of each segment follows from. Arrays are borrowed. */
typedef struct NetworkBlood {
    const double *radius_mm, *length_mm; /* per segment */
    const double *inflow_hematocrit;     /* per node: of the blood that enters there, in [0,
                                          * MAX_HEMATOCRIT]; NAN: `hematocrit` */
    double hematocrit;                   /* of all segments at the start, in [0, MAX_HEMATOCRIT] */
    double plasma_pa_s;                  /* viscosity of the plasma, above 0 */
    double cell_fl;                      /* mean corpuscular volume, above 0 */
} NetworkBlood;

/* Returns the resistance of segment i at this hematocrit, Pa s/mm^3, by viscosity_pries_pa_s. */
double flownetwork_resistance(const NetworkBlood *blood, size_t i, double hematocrit);

/* The red cells in the network. */
typedef struct NetworkCells {
    double *hematocrit;    /* per segment: of the blood that flows out of it; owned */
    size_t rounds, capped; /* rounds of the iteration; segments at MAX_HEMATOCRIT */
    bool converged;
    double flow_change, hematocrit_change; /* largest changes of the last round, the flow in mm^3/s
                                            * and the hematocrit where flow is above 1e-6 of the
                                            * largest */
    double imbalance; /* largest sum of the cell flows at a node without inflow, divided by the
                       * largest cell flow */
} NetworkCells;

enum { NETWORK_MAX_ROUNDS = 100 };

/* Computes flow and hematocrit together: the viscosity of each segment follows from its hematocrit,
 * and the red cells divide at diverging bifurcations by the law of Pries & Secomb [Pries, Ley,
 * Claassen & Gaehtgens, Microvasc. Res. 38 (1989) 81; constants of Pries & Secomb 2008]. From one
 * hematocrit in all segments, each round computes viscosity, flow, and the hematocrit in the order
 * of falling pressure. The iteration ends when no flow changes by 1e-3 nl/min or 1e-6 of the
 * largest flow, and no hematocrit by 1e-3. After NETWORK_MAX_ROUNDS it ends without convergence,
 * and cells->converged is false. Several steady states can exist; this start selects one.
 *
 * network  its resistances are not read.
 * flow     release with networkflow_release.
 * cells    free the array.
 * Errors   those of flownetwork_solve. */
MUST_CHECK Status flownetwork_separate(const FlowNetwork *network, const NetworkBlood *blood,
                                       NetworkFlow *flow, NetworkCells *cells, Err *err);

/* ---- unknown boundary conditions --------------------------------------------------------------
 */

/* The estimate of boundary conditions. Arrays are borrowed. */
typedef struct NetworkGuess {
    const bool *is_open;                 /* per node: neither pressure nor inflow is known there */
    const double *radius_mm, *length_mm; /* per segment */
    double pressure_pa, stress_pa;       /* targets: pressure and wall shear stress */
    size_t starts;                       /* at least 1. The first start has no chance in it. */
    uint64_t seed;                       /* of the other starts */
    int threads;
} NetworkGuess;

/* How far the other starts differ from the first. */
typedef struct NetworkSpread {
    size_t open, solves; /* open nodes; solutions of the first start */
    double turned[2];    /* smallest and largest share of segments with another direction */
    double change[2];    /* smallest and largest median of |flow / flow of the first start - 1| */
} NetworkSpread;

/* The largest number of open nodes: two square matrices of this size are stored. */
enum { NETWORK_MAX_OPEN = 5000 };

/* Estimates the pressures of open nodes [Fry, Lee, Smith & Secomb, Microcirculation 19 (2012) 530]:
 * they minimize the sum of w (p - target)^2 over nodes plus k times the sum of l (tau - s target)^2
 * over segments, with p in mmHg and tau in dyn/cm^2. w is half the length of the segments at a
 * node, l the length, tau the wall shear stress and s = 1 or -1 its direction in the solution
 * before. k is 0 at first, then 0.002, and doubles up to 4.096; at most 5 solutions for each k.
 *
 * pressure  per node: receives the pressures of the open nodes; other nodes stay as they are.
 * Errors    STATUS_INFEASIBLE if more than NETWORK_MAX_OPEN nodes are open; those of
 * flownetwork_solve. Cost      three solutions per open node, and the cube of their number. Threads
 * the result does not depend on their number. */
MUST_CHECK Status flownetwork_guess(const FlowNetwork *network, const NetworkGuess *guess,
                                    double *pressure, NetworkSpread *spread, Err *err);

#endif
