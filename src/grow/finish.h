/* Turns the grown network into a Tree: the last step of growth. */
#ifndef CORCAST_GROW_FINISH_H
#define CORCAST_GROW_FINISH_H

#include "grow/grow.h"
#include "grow/network.h"

/* Makes a Tree of the network: sorts its segments so that parents come first, computes all radii
 * from the positions and flows, and adds metadata.
 *
 * net      its terminals have their final flow shares. It is renumbered; the caller releases it.
 * params   for the metadata and the laws of flow and radius.
 * domain   for the metadata.
 * out      receives the tree; release it with tree_release.
 * Errors   STATUS_INFEASIBLE if a radius is beyond the range of a double, radii do not converge or
 *          a trunk that is kept uses up the pressure; STATUS_MEMORY. */
MUST_CHECK Status finish_tree(Network *net, const GrowParams *params, const Domain *domain,
                              Tree *out, Err *err);

/* Sets the keys that describe a tree grown with these parameters in this domain, without lines for
 * them. Errors: STATUS_MEMORY. */
MUST_CHECK Status finish_describe(const GrowParams *params, const Domain *domain, TreeMeta *meta,
                                  Err *err);

#endif
