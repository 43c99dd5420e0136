/* Turns a refined arbor back into a Tree: the last step of refinement. */
#ifndef CORCAST_GROW_REFINE_REFINE_RESULT_H
#define CORCAST_GROW_REFINE_REFINE_RESULT_H

#include "grow/refine/refine_arbor.h"
#include "tree/tree.h"

/* Makes a tree of the arbor, with the radii that follow from the law of radii [law.h]. Copies the
 * node types, flow shares and pairs of terminals of `was`, the tree that the arbor was made from.
 * Does not copy its metadata and its other columns.
 *
 * tree     receives the tree; release it with tree_release.
 * Errors   STATUS_INFEASIBLE if a radius is beyond the range of a double; STATUS_MEMORY. */
MUST_CHECK Status result_make(const Arbor *arbor, const Tree *was, Tree *tree, Err *err);

#endif
