/* Turns the grown network into a Tree: the last step of growth. */
#ifndef CORCAST_GROW_FINISH_H
#define CORCAST_GROW_FINISH_H

#include "grow/grow.h"
#include "grow/network.h"

/* Makes a Tree of the network: sorts its nodes so that parents come first, computes all radii from
 * the positions and flows, and adds metadata.
 *
 * net      its terminals must have their final flow shares. The function renumbers the nodes and
 *          calls network_free_workspace, also before an error; the caller releases the network.
 * params   for the metadata, and for the rules by which terminals share the flow and radii follow
 *          Murray's law.
 * domain   for the metadata.
 * out      receives the tree; release it with tree_release.
 * Errors   STATUS_INFEASIBLE if a radius is beyond the range of a double, if radii do not converge,
 *          or if segments that keep their radii (the trunk [network.h]) use up the pressure drop,
 *          so that none is left for new segments; STATUS_MEMORY. */
MUST_CHECK Status finish_tree(Network *net, const GrowParams *params, const Domain *domain,
                              Tree *out, Err *err);

/* Sets the keys of *meta that describe a tree grown with these parameters in this domain. Does not
 * add the comment lines in which a tree file states these keys [meta_add_lines]. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status finish_describe(const GrowParams *params, const Domain *domain, TreeMeta *meta,
                                  Err *err);

#endif
