/* Converts a tree, or a network with links, to a network for the flow solver: call
 * treenetwork_make, then treenetwork_set_terminals, then flownetwork_solve. Part of the public
 * header of derive.
 *
 * Node i of the network is node i of the tree. Segment i of the network is the segment that ends at
 * node i of the tree. A link of a node names another node at the same point; links close the loops
 * of a network [tree.h]. If one of the two nodes of a segment has a link, the segment begins or
 * ends at the node that the link names [tree_linked_node] instead. Segments that meet at a link
 * therefore share a node of the network. The segment of a root leads from the root to itself and
 * carries no flow. */
#ifndef CORCAST_DERIVE_TREENETWORK_H
#define CORCAST_DERIVE_TREENETWORK_H

#include "flownetwork/flownetwork.h"
#include "tree/tree.h"

/* A network and the arrays that it borrows. All arrays have an entry per node of the tree and are
 * owned. */
typedef struct TreeNetwork {
    FlowNetwork network;
    uint32_t (*ends)[2]; /* the proximal and the distal node of the segment */
    double *resistance;  /* Pa s / mm^3; HUGE_VAL: closed */
    double *pressure;    /* known pressure at the node, Pa; NAN: not known */
    double *inflow;      /* flow into the network at the node, mm^3/s; below 0: flow out */
    double *length_mm;   /* of the segment */
} TreeNetwork;

/* Makes the network of a tree. No pressure is known, and all inflows are 0. Segments of radius 0
 * are closed.
 *
 * viscosity  per segment, Pa s.
 * out        release with treenetwork_release. It borrows the tree's ids.
 * Errors     STATUS_MEMORY. */
MUST_CHECK Status treenetwork_make(const Tree *tree, const double *viscosity, TreeNetwork *out,
                                   Err *err);
void treenetwork_release(TreeNetwork *network);

/* Sets the boundary conditions of a tree. The pressure at each root is p_perf, the perfusion
 * pressure of the tree's metadata, or 0 if p_perf is not known. The flow out of a node, in general
 * a terminal, is q_perf, the total flow, times the node's flow share divided by the sum of all flow
 * shares [tree_flow_shares]; it is 0 if the sum is 0.
 *
 * overrides  values that the user specified; they take precedence over those of the tree.
 * Errors     STATUS_INPUT if q_perf is missing; *err then holds the end of a sentence, and the
 *            caller puts "the field NAME " before it. STATUS_MEMORY. */
MUST_CHECK Status treenetwork_set_terminals(TreeNetwork *network, const Tree *tree,
                                            const TreeMeta *overrides, Err *err);

#endif
