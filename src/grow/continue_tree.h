/* Growing on from a given tree. */
#ifndef CORCAST_GROW_CONTINUE_TREE_H
#define CORCAST_GROW_CONTINUE_TREE_H

#include "grow/grow.h"
#include "grow/network.h"

/* The number of roots of a tree. */
size_t continue_inlets(const Tree *from);

/* Whether growth can go on from params->from with these parameters. STATUS_USAGE and STATUS_INPUT,
 * as grow_tree says. */
MUST_CHECK Status continue_check(const GrowParams *params, const Domain *domain, Err *err);

/* Copies the tree, which continue_check accepts, into `net`, which is empty and has traits; node i
 * becomes node i; if `net` has a trunk, all segments keep their radii. Leaves right sums, and no
 * other radii. O(n). */
void continue_from(const Tree *from, Network *net);

/* `out` has the nodes of `net`, in its order. Gives those that were in `from` their ids, types and
 * columns back, if `net` has a trunk their radii, inlets' too, and the others the smallest ids that
 * are free; and appends the remarks and command lines of `from`. STATUS_MEMORY. */
MUST_CHECK Status continue_restore(const Tree *from, const Network *net, Tree *out, Err *err);

/* Compares the radii of the segments of `from` with those of the same ids in `out`: sets in *report
 * the median, least and greatest factor by which they changed, 0 when none had a radius. */
MUST_CHECK Status continue_changes(const Tree *from, const Tree *out, GrowReport *report, Err *err);

/* How many nodes of the tree are outside the domain; if any, *farthest is that of them which is the
 * farthest from its bounds, and *mm how far from the domain it is. */
size_t continue_outside(const Tree *from, const Domain *domain, size_t *farthest, double *mm);

#endif
