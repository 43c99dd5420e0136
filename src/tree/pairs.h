/* Pairs of nodes, as of the terminals of an artery and of the vein beside it: a column of the tree
 * that holds the number of each pair, from 1 on, at both of its nodes. */
#ifndef CORCAST_TREE_PAIRS_H
#define CORCAST_TREE_PAIRS_H

#include "base/base.h"
#include <stddef.h>
#include <stdint.h>

typedef struct Tree Tree;

/* The column's name. */
extern const char tree_pairs_name[];

/* Indices of two nodes; the first is the lower one. */
typedef struct TreePair {
    int32_t node[2];
} TreePair;

/* Numbers the pairs in their order, in place of those that the tree has. STATUS_MEMORY. */
MUST_CHECK Status tree_set_pairs(Tree *tree, const TreePair *pair, size_t n, Err *err);

/* The tree's pairs by their numbers, in *pair (owned; NULL where there are none). What stands at
 * other than two nodes, or is no number from 1 to that of the nodes, is no pair. O(n). */
MUST_CHECK Status tree_pairs(const Tree *tree, TreePair **pair, size_t *n, Err *err);

#endif
