/* A tree as the branches that formats of polylines hold. */
#ifndef CORCAST_TREEIO_BRANCHES_H
#define CORCAST_TREEIO_BRANCHES_H

#include "tree/tree.h"

/* Each branch is the longest row of segments without a branching between them; it begins at a root
 * or at a bifurcation. Branch k holds segments node[end[k - 1]] to node[end[k] - 1], each the child
 * of the one before. Branches are in the order of their first segments. */
typedef struct Branches {
    int32_t *node; /* owned */
    size_t *end;   /* owned */
    size_t n;
} Branches;

/* In *branches (owned; branches_release). O(nodes). */
MUST_CHECK Status branches_find(const Tree *tree, Branches *branches, Err *err);
void branches_release(Branches *branches);

#endif
