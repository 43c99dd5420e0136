/* Turns the grown network into a Tree: the last step of growth. */
#ifndef CORCAST_GROW_FINISH_H
#define CORCAST_GROW_FINISH_H

#include "grow/grow.h"
#include "grow/network.h"

/* Renumbers `net`, whose terminals have their shares, computes all radii from the positions, and
 * writes the tree and its metadata.
 *
 * out      receives the tree; release it with tree_release.
 * Errors   STATUS_INFEASIBLE if a radius is beyond the range of a double, or as grow_tree;
 *          STATUS_MEMORY. */
MUST_CHECK Status finish_tree(Network *net, const GrowParams *params, const Domain *domain,
                              Tree *out, Err *err);

#endif
