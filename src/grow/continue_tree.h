/* Continues the growth of a tree that was grown or read before.
 *
 * The order of calls is: continue_check accepts the tree and the parameters; continue_copy copies
 * the tree into a network; growth adds terminals; continue_restore gives the nodes of the result
 * the ids, types and columns of the first tree; continue_radius_changes reports how radii
 * changed. */
#ifndef CORCAST_GROW_CONTINUE_TREE_H
#define CORCAST_GROW_CONTINUE_TREE_H

#include "grow/grow.h"
#include "grow/network.h"

/* Returns the number of roots of a tree. */
size_t continue_count_roots(const Tree *from);

/* Checks whether growth can continue params->from with these parameters. Errors: STATUS_USAGE and
 * STATUS_INPUT, as grow_tree; STATUS_MEMORY. */
MUST_CHECK Status continue_check(const GrowParams *params, const Domain *domain, Err *err);

/* Copies the tree `from`, which continue_check has accepted, into `net`. The network must be empty,
 * and made with has_traits [NetworkSize]. Node i of the tree becomes node i of the network. If the
 * copied segments are to keep their radii, the caller first calls network_add_trunk, and the
 * function stores the radii in net->trunk. Other radii are valid after network_refresh. The sums
 * over subtrees are exact. Cost: O(n). */
void continue_copy(const Tree *from, Network *net);

/* Restores in `out` the properties of the nodes of the tree `from`. `out` must have the nodes of
 * `net`, in the same order. Nodes of `from` get their ids, types and column values. If `net` has a
 * trunk, they also get their old radii. New nodes get the smallest free ids. The remarks and
 * command lines of `from` are appended to those of `out`. Errors: STATUS_MEMORY; *out is then
 * partly changed. */
MUST_CHECK Status continue_restore(const Tree *from, const Network *net, Tree *out, Err *err);

/* Compares the radii of the segments of `from` with the radii of the same ids in `out`. Sets
 * median_change, min_change and max_change of *report. Leaves *report unchanged if no segment of
 * `from` has a radius above 0. Errors: STATUS_MEMORY. */
MUST_CHECK Status continue_radius_changes(const Tree *from, const Tree *out, GrowReport *report,
                                          Err *err);

/* Returns the number of nodes of the tree that are outside the domain.
 *
 * farthest   receives the outside node that is farthest from the domain's bounding box; unchanged
 *            if no node is outside.
 * mm         receives the distance of this node from the domain, mm; 0 if no node is outside. */
size_t continue_count_outside(const Tree *from, const Domain *domain, size_t *farthest, double *mm);

#endif
