/* The public header of the module flownetwork: steady flow in networks of vessels, with or without
 * loops. flownetwork_solve needs known boundary conditions and resistances.
 * flownetwork_solve_with_cells also computes hematocrit, and the resistances from it.
 * flownetwork_estimate estimates unknown boundary conditions: the caller copies the estimated
 * pressures into the network's `pressure`, and then solves it.
 *
 * Each segment obeys Poiseuille's law: flow = (pressure at its first node - pressure at its second
 * node) / resistance. At each node the flows that leave it through segments sum to its inflow, as
 * in Kirchhoff's laws. A segment of infinite resistance is closed: no blood flows in it.
 *
 *     TRY(flownetwork_solve(&network, &flow, err));
 *     double q = flow.flow[segment];
 *     networkflow_release(&flow);
 *
 * Units are mm, g and s, so pressure is in Pa and flow in mm^3/s. */
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
    const double *resistance;  /* per segment: Pa s/mm^3, >= 0; INFINITY: closed. A segment of
                                * resistance 0 that is left after nodes were eliminated [reduce.h]
                                * gets 1e-6 of the smallest resistance above 0 */
    const double *pressure;    /* per node: known pressure, Pa; NAN: not known */
    const double *inflow; /* per node: flow that enters the network there, mm^3/s; below 0: flow
                           * that leaves. Not read at a node of known pressure */
    const int32_t *id;    /* per node: its id in errors */
    /* In a component without a known pressure, the inflows must sum to 0. false: another sum is an
     * error, STATUS_INPUT. true: the excess leaves the network at the node with the largest
     * absolute inflow. flownetwork_estimate sets it to true for its own systems of equations: their
     * right-hand sides are derivatives of an objective, which need not sum to 0. */
    bool absorbs_excess;
} FlowNetwork;

/* Maximum excess of inflows: the sum of the inflows of a component without a known pressure,
 * divided by the sum of their absolute values. Inflows that a file states with four digits stay
 * below it. */
#define NETWORK_MAX_EXCESS 1e-3

/* The steady flow. Arrays are owned; release with networkflow_release. */
typedef struct NetworkFlow {
    double *flow;     /* per segment: flow from its first to its second node, mm^3/s */
    double *pressure; /* per node: pressure, Pa; NAN if it is not known and all segments there are
                       * closed */
    double *inflow;   /* per node: flow that enters the network there, mm^3/s; at a node of known
                       * pressure it is computed from the flows */
    bool *direction_unknown; /* per segment: the flow is 0, or its rounding error may exceed it */
    double largest;          /* largest absolute flow in a segment, mm^3/s */
    double imbalance;        /* largest absolute net flow into a node, inflow included, divided by
                              * `largest` */
    double node_imbalance;   /* largest ratio, over the nodes, of the absolute net flow to half the
                              * sum of the absolute flows at the node. Nodes whose segments are all
                              * `direction_unknown` do not count */
    size_t components;       /* number of connected components with at least one open segment */
    /* Number of these components without a known pressure. In each, the node with the largest
     * absolute inflow gets the pressure 0; on a tie, the node with the lowest index. The inflow of
     * this node is the negative sum of the other inflows of the component. */
    size_t floating;
    size_t no_flow;        /* number of floating components in which all inflows, and so all flows,
                            * are 0 */
    uint32_t no_flow_node; /* a node of the last of these components; unused if `no_flow` is 0 */
    size_t unknowns;       /* number of unknown pressures after the reduction */
    size_t steps;          /* number of steps of conjugate gradients */
} NetworkFlow;

/* Computes the steady flow.
 *
 * First, nodes with one or two segments are eliminated exactly [reduce.h]. The pressures of the
 * remaining nodes are found by conjugate gradients, preconditioned by an incomplete Cholesky factor
 * without fill. Then the eliminated nodes are restored in reverse order. In a tree whose terminals
 * have known inflows, no node remains.
 *
 * out      receives the flow; release it with networkflow_release.
 * Errors   STATUS_INPUT, naming a node, if the inflows of a component without a known pressure do
 *          not sum to 0 within NETWORK_MAX_EXCESS; STATUS_MEMORY.
 * Cost     O(n) for the reduction; the number of steps grows like the cube root of the unknowns. */
MUST_CHECK Status flownetwork_solve(const FlowNetwork *network, NetworkFlow *out, Err *err);
void networkflow_release(NetworkFlow *flow);

/* ---- red cells ------------------------------------------------------------------------------- */

/* The inputs of the computation of hematocrit. Arrays are borrowed. */
typedef struct NetworkBlood {
    const double *radius_mm, *length_mm; /* per segment */
    /* Per node: discharge hematocrit of the blood that enters there, in [0, MAX_HEMATOCRIT]; NAN:
     * use `hematocrit`. */
    const double *inflow_hematocrit;
    double hematocrit;  /* initial discharge hematocrit of all segments, in [0, MAX_HEMATOCRIT] */
    double plasma_pa_s; /* viscosity of the plasma, above 0 */
    double cell_fl;     /* mean corpuscular volume, above 0 */
} NetworkBlood;

/* Returns the resistance of segment i at this hematocrit, Pa s/mm^3, by viscosity_pries_pa_s.
 * Returns INFINITY for radius 0, and where viscosity_pries_pa_s is infinite. */
double flownetwork_resistance(const NetworkBlood *blood, size_t i, double hematocrit);

/* The red cells in the network. */
typedef struct NetworkCells {
    double *hematocrit;       /* per segment: discharge hematocrit; owned */
    size_t rounds;            /* number of rounds of the iteration */
    size_t capped;            /* number of segments at MAX_HEMATOCRIT */
    bool converged;           /* false: stopped after NETWORK_MAX_ROUNDS, which is no error */
    double flow_change;       /* largest change of a flow in the last round, mm^3/s */
    double hematocrit_change; /* largest change of a hematocrit in the last round, in segments with
                               * more than 1e-6 of the largest flow */
    double imbalance; /* largest absolute net flow of cells into a node, divided by the largest flow
                       * of cells in a segment. Only nodes where no blood enters or leaves the
                       * network count */
} NetworkCells;

/* Maximum number of rounds of flownetwork_solve_with_cells. Reason for 100 not recorded. */
enum { NETWORK_MAX_ROUNDS = 100 };

/* Computes flow and hematocrit together. The viscosity of a segment follows from its hematocrit.
 * Red cells divide at diverging bifurcations by the phase separation law of Pries & Secomb [Pries,
 * Ley, Claassen & Gaehtgens, Microvasc. Res. 38 (1989) 81; constants of Pries & Secomb 2008].
 *
 * The iteration starts with blood->hematocrit in all segments. Each round computes the viscosities,
 * the flow, and then the hematocrit from node to node in the order of falling pressure. Several
 * steady states can exist; the start selects one. The iteration has converged when two conditions
 * hold:
 *
 *  - cells->flow_change is below 1e-3 nl/min, or below 1e-6 of the largest flow;
 *  - cells->hematocrit_change is below 1e-3.
 *
 * network  its resistances are not read; flownetwork_resistance computes them.
 * flow     receives the flow of the last round; release it with networkflow_release. Zeroed on
 *          error.
 * cells    the caller frees cells->hematocrit, which is NULL on error.
 * Errors   those of flownetwork_solve. */
MUST_CHECK Status flownetwork_solve_with_cells(const FlowNetwork *network,
                                               const NetworkBlood *blood, NetworkFlow *flow,
                                               NetworkCells *cells, Err *err);

/* ---- unknown boundary conditions ------------------------------------------------------------- */

/* The inputs of an estimate of boundary conditions. A node is open if neither its pressure nor its
 * inflow is known. Arrays are borrowed. */
typedef struct NetworkEstimate {
    const bool *is_open;                 /* per node: true if the node is open */
    const double *radius_mm, *length_mm; /* per segment */
    double pressure_pa, stress_pa;       /* target pressure and target wall shear stress, Pa */
    size_t starts; /* number of starts of the iteration, at least 1; only the first is not random */
    uint64_t seed; /* seed of the random directions of the other starts */
    int threads;   /* maximum number of threads; 0: all processors */
} NetworkEstimate;

/* The differences between the first start and the other starts. Segments whose direction is not
 * known in the first start [NetworkFlow.direction_unknown] do not count. With one start there is
 * nothing to compare: `reversed` and `change` are {INFINITY, 0}. */
typedef struct NetworkSpread {
    size_t open;          /* number of open nodes */
    size_t minimizations; /* number of minimizations in the first start */
    double reversed[2];   /* minimum and maximum, over the other starts, of the fraction of segments
                           * with the opposite direction */
    double change[2]; /* minimum and maximum, over the other starts, of the median relative change
                       * of the flow, |flow / flow of the first start - 1| */
} NetworkSpread;

/* Maximum number of open nodes of flownetwork_estimate. The function stores three square matrices
 * of doubles with one row per open node; 5000 open nodes need 600 MB. */
enum { NETWORK_MAX_OPEN = 5000 };

/* Estimates the pressures of open nodes [Fry, Lee, Smith & Secomb, Microcirculation 19 (2012) 530].
 *
 * The pressures minimize the objective
 *
 *     sum over nodes of w (p - p0)^2  +  k * sum over segments of l (tau - s tau0)^2
 *
 * p is the pressure of a node and p0 the target pressure, mmHg. w is half the total length of the
 * segments that meet at the node. tau is the wall shear stress of a segment and tau0 the target
 * wall shear stress, dyn/cm^2. l is the length of the segment. k depends on the units of pressure
 * and stress, which are those of the source. s is 1 or -1, the direction of tau in the previous
 * minimization. Closed segments do not count.
 *
 * The first start begins with the minimum for k = 0, which needs no directions. The other starts
 * begin with random directions. All starts then use k = 0.002, 0.004, ..., 4.096; with a larger
 * last k, the stress would dominate the pressures. For each k the minimization is repeated until no
 * direction changes, at most 5 times. The function returns the pressures of the first start. The
 * other starts only show how much the result depends on the initial directions.
 *
 * pressure  per node, Pa: receives the pressures of the open nodes. Does not change other nodes.
 *           Unchanged on error.
 * spread    receives the comparison of the starts.
 * Errors    STATUS_INFEASIBLE if more than NETWORK_MAX_OPEN nodes are open; those of
 *           flownetwork_solve.
 * Threads   the result does not depend on estimate->threads.
 * Cost      three calls of flownetwork_solve per open node, two per minimization, and time O(n^3)
 *           for n open nodes. */
MUST_CHECK Status flownetwork_estimate(const FlowNetwork *network, const NetworkEstimate *estimate,
                                       double *pressure, NetworkSpread *spread, Err *err);

#endif
