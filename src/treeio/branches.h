/* A tree as branches, for formats that hold polylines. */
#ifndef CORCAST_TREEIO_BRANCHES_H
#define CORCAST_TREEIO_BRANCHES_H

#include "tree/tree.h"

/* A branch is the longest row of segments without a bifurcation between them. It begins at a root
 * or at a bifurcation. Branch k holds the segments node[end[k - 1]] to node[end[k] - 1], each the
 * child of the one before. Branches are in the order of their first segments. Both arrays are
 * owned. */
typedef struct Branches {
    int32_t *node;
    size_t *end; /* per branch */
    size_t n;    /* number of branches */
} Branches;

/* Finds the branches of a tree. Release them with branches_release. Errors: STATUS_MEMORY. Cost:
 * O(nodes). */
MUST_CHECK Status branches_find(const Tree *tree, Branches *branches, Err *err);
void branches_release(Branches *branches);

#endif
