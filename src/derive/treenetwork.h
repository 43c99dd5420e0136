/* A tree, or a network with links, as a network for the flow solver. Part of the public header of
 * derive.
 *
 * Node i of the network is the place of node i of the tree [tree/tree.h]; a node with a link stands
 * alone. Segment i is the segment that ends at node i of the tree, from its parent's place to its
 * own. The segment of a root leads from the root to itself and carries no flow. */
#ifndef CORCAST_DERIVE_TREENETWORK_H
#define CORCAST_DERIVE_TREENETWORK_H

#include "flownetwork/flownetwork.h"
#include "tree/tree.h"

/* The arrays of `network`, all with an entry per node of the tree. Owned. */
typedef struct TreeNetwork {
    FlowNetwork network;
    uint32_t (*ends)[2];
    double *resistance, *pressure, *inflow, *length_mm;
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

/* Sets the boundary conditions of trees: p_perf at all roots, or 0 if it is not known; and at each
 * node with a flow share that part of q_perf flows out. `overrides` as in derive_field. Errors:
 * STATUS_INPUT if q_perf is missing, with a sentence that continues "the field NAME ";
 * STATUS_MEMORY. */
MUST_CHECK Status treenetwork_set_terminals(TreeNetwork *network, const Tree *tree,
                                            const TreeMeta *overrides, Err *err);

#endif
