/* Pairs of nodes, such as a terminal of an artery and a terminal of the vein beside it. A column of
 * the tree stores the pairs: its value at both nodes of a pair is the number of the pair, from 1;
 * at all other nodes it is NAN. */
#ifndef CORCAST_TREE_PAIRS_H
#define CORCAST_TREE_PAIRS_H

#include "base/base.h"
#include <stddef.h>
#include <stdint.h>

typedef struct Tree Tree;

/* The name of the column. */
extern const char tree_pairs_name[];

/* Indices of two nodes; the first is the lower one. */
typedef struct TreePair {
    int32_t node[2];
} TreePair;

/* Replaces the pairs of the tree by the `n` pairs at `pair`, numbered from 1 in their order.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status tree_set_pairs(Tree *tree, const TreePair *pair, size_t n, Err *err);

/* Lists the pairs of the tree by rising number. Ignores a number that does not occur at exactly two
 * nodes, or is not an integer from 1 to the number of nodes.
 *
 * pair     receives a new array of *n pairs, which the caller frees; NULL if the tree has no column
 *          of pairs.
 * Errors   STATUS_MEMORY.
 * Cost     O(n). */
MUST_CHECK Status tree_pairs(const Tree *tree, TreePair **pair, size_t *n, Err *err);

#endif
