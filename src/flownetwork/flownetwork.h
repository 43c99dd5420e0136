/* The public header of the module flownetwork: steady flow in networks of vessels, also with loops.
 *
 * Each segment obeys Poiseuille's law: flow = (pressure at its first node - pressure at its second
 * node) / resistance. At each node the flows sum to the known inflow, as in Kirchhoff's laws. A
 * segment of infinite resistance is closed: no blood flows in it.
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
    const double *resistance;  /* per segment: Pa s/mm^3, >= 0; INFINITY: closed. Where the reduced
                                * network needs a value above 0, 0 counts as 1e-6 of its smallest
                                * resistance above 0. */
    const double *pressure;    /* per node: known pressure, Pa; NAN: not known */
    const double *inflow; /* per node: flow that enters the network there, mm^3/s; below 0 if it
                           * leaves. It is not read at a node of known pressure. */
    const int32_t *id;    /* per node: its name in errors */
    /* What happens if the inflows of a component without a known pressure do not sum to 0. false:
     * STATUS_INPUT. true: the excess leaves at the node with the largest absolute inflow. The
     * derivatives in flownetwork_estimate need this: their inflows are no flows of blood. */
    bool absorbs;
} FlowNetwork;

/* The largest accepted sum of the inflows of a component without a known pressure, divided by the
 * sum of their absolute values. Inflows that a file states with four digits stay below it. */
#define NETWORK_MAX_EXCESS 1e-3

/* The steady flow. Arrays are owned; release with networkflow_release. */
typedef struct NetworkFlow {
    double *flow;     /* per segment: flow from its first to its second node */
    double *pressure; /* per node; NAN if it is not known and all segments there are closed */
    double *inflow;   /* per node: flow that enters the network there; at nodes of known pressure it
                       * follows from the flow */
    bool *is_lost;    /* per segment: rounding errors may exceed the flow, or the flow is 0; its
                       * direction is not known */
    double largest;   /* largest absolute flow in a segment */
    double imbalance; /* largest absolute net flow into a node, inflow included, divided by
                       * `largest` */
    double own_imbalance; /* largest ratio, at one node, of the absolute net flow to half the sum of
                           * the absolute flows. Nodes whose segments are all `is_lost` do not
                           * count. */
    size_t components;    /* connected components that have a segment that is not closed */
    /* Number of these components without a known pressure. In each, the node with the largest
     * absolute inflow, the first of equals, has the pressure 0. The inflow of this node is the
     * negative sum of the other inflows of the component. */
    size_t floating;
    size_t no_flow;        /* floating components in which all inflows, and so all flows, are 0 */
    uint32_t no_flow_node; /* a node of the last of them; unused if `no_flow` is 0 */
    size_t unknowns;       /* pressures that were solved for after the reduction */
    size_t steps;          /* steps of conjugate gradients */
} NetworkFlow;

/* Computes the steady flow.
 *
 * Ends and chains are removed exactly. The pressures of the remaining nodes are found by conjugate
 * gradients, preconditioned by an incomplete Cholesky factor without fill, and the removed nodes
 * are restored in reverse order. In a tree whose terminals have known inflows nothing remains.
 *
 * out      receives the flow; release it with networkflow_release. Unchanged on error.
 * Errors   STATUS_INPUT, naming a node, if the inflows of a component without a known pressure do
 *          not sum to 0 within NETWORK_MAX_EXCESS; STATUS_MEMORY.
 * Cost     O(n) for the reduction; the number of steps grows like the cube root of the unknowns. */
MUST_CHECK Status flownetwork_solve(const FlowNetwork *network, NetworkFlow *out, Err *err);
void networkflow_release(NetworkFlow *flow);

/* ---- red cells ------------------------------------------------------------------------------- */

/* What the hematocrit of each segment follows from. Arrays are borrowed. */
typedef struct NetworkBlood {
    const double *radius_mm, *length_mm; /* per segment */
    /* Per node: discharge hematocrit of the blood that enters there, in [0, MAX_HEMATOCRIT]; NAN:
     * it is `hematocrit`. */
    const double *inflow_hematocrit;
    double hematocrit;  /* discharge hematocrit of all segments before the first round, in [0,
                         * MAX_HEMATOCRIT] */
    double plasma_pa_s; /* viscosity of the plasma, above 0 */
    double cell_fl;     /* mean corpuscular volume, above 0 */
} NetworkBlood;

/* Returns the resistance of segment i at this hematocrit, Pa s/mm^3, by viscosity_pries_pa_s.
 * Returns INFINITY for radius 0, and where viscosity_pries_pa_s is infinite. */
double flownetwork_resistance(const NetworkBlood *blood, size_t i, double hematocrit);

/* The red cells in the network. */
typedef struct NetworkCells {
    double *hematocrit;    /* per segment: discharge hematocrit; owned */
    size_t rounds, capped; /* rounds of the iteration; segments at MAX_HEMATOCRIT */
    bool converged;
    double flow_change;       /* largest change of a flow in the last round, mm^3/s */
    double hematocrit_change; /* largest change of a hematocrit in the last round, in segments with
                               * more than 1e-6 of the largest flow */
    double imbalance; /* largest absolute sum of the cell flows into a node where no blood enters or
                       * leaves the network, divided by the largest cell flow */
} NetworkCells;

enum { NETWORK_MAX_ROUNDS = 100 };

/* Computes flow and hematocrit together: the viscosity of each segment follows from its hematocrit,
 * and the red cells divide at diverging bifurcations by the law of Pries & Secomb [Pries, Ley,
 * Claassen & Gaehtgens, Microvasc. Res. 38 (1989) 81; constants of Pries & Secomb 2008]. From one
 * hematocrit in all segments, each round computes viscosity, flow, and the hematocrit in the order
 * of falling pressure. The iteration has converged when cells->flow_change is below 1e-3 nl/min or
 * 1e-6 of the largest flow, whichever is larger, and cells->hematocrit_change is below 1e-3. After
 * NETWORK_MAX_ROUNDS the iteration ends without convergence, and cells->converged is false. Several
 * steady states can exist; this start selects one.
 *
 * network  its resistances are not read: flownetwork_resistance decides which segments are closed.
 * flow     receives the flow of the last round; release it with networkflow_release. Zeroed on
 *          error.
 * cells    the caller frees cells->hematocrit, which is NULL on error.
 * Errors   those of flownetwork_solve. */
MUST_CHECK Status flownetwork_separate(const FlowNetwork *network, const NetworkBlood *blood,
                                       NetworkFlow *flow, NetworkCells *cells, Err *err);

/* ---- unknown boundary conditions ------------------------------------------------------------- */

/* What an estimate of boundary conditions depends on. A node is open if neither pressure nor inflow
 * is known there. Arrays are borrowed. */
typedef struct NetworkEstimate {
    const bool *is_open;                 /* per node */
    const double *radius_mm, *length_mm; /* per segment */
    double pressure_pa, stress_pa;       /* targets: pressure and wall shear stress */
    size_t starts; /* number of starts, at least 1. The first start is not random. */
    uint64_t seed; /* of the random directions with which the other starts begin */
    int threads;   /* maximum number of threads; 0: all processors */
} NetworkEstimate;

/* How far the other starts differ from the first start. Segments whose direction is not known in
 * the first start do not count. */
typedef struct NetworkSpread {
    size_t open;      /* number of open nodes */
    size_t solves;    /* number of solutions of the first start */
    double turned[2]; /* smallest and largest share of segments with another direction than in the
                       * first start; {INFINITY, 0} if there is only one start */
    double change[2]; /* smallest and largest median of |flow / flow of the first start - 1|;
                       * {INFINITY, 0} if there is only one start */
} NetworkSpread;

/* The largest number of open nodes. Three square matrices of doubles with this many rows are
 * stored: 600 MB. */
enum { NETWORK_MAX_OPEN = 5000 };

/* Estimates the pressures of open nodes [Fry, Lee, Smith & Secomb, Microcirculation 19 (2012) 530]:
 * they minimize the sum of w (p - target)^2 over nodes plus k times the sum of l (tau - s target)^2
 * over segments that are not closed, with p in mmHg and tau in dyn/cm^2. w is half the length of
 * the segments at a node, and l is the length of a segment. tau is the wall shear stress, and s = 1
 * or -1 is its direction in the previous solution of the same start.
 *
 * The first start begins with one solution for k = 0, which needs no directions. The other starts
 * begin with random directions. All starts continue with k = 0.002, 0.004, ..., 4.096. For each k,
 * a start is solved until no direction changes, at most 5 times. The result is that of the first
 * start; the others only show how much it depends on the directions.
 *
 * pressure  per node, Pa: receives the pressures of the open nodes. Other nodes stay as they are.
 *           Unchanged on error.
 * spread    receives the comparison of the starts.
 * Errors    STATUS_INFEASIBLE if more than NETWORK_MAX_OPEN nodes are open; those of
 *           flownetwork_solve.
 * Threads   the result does not depend on their number.
 * Cost      three solutions of the network per open node, two per solution of a start, and time
 *           that grows with the cube of the number of open nodes. */
MUST_CHECK Status flownetwork_estimate(const FlowNetwork *network, const NetworkEstimate *estimate,
                                       double *pressure, NetworkSpread *spread, Err *err);

#endif
