/* Divides a tree into branches. */
#ifndef CORCAST_TREE_BRANCHES_H
#define CORCAST_TREE_BRANCHES_H

#include "base/base.h"
#include <stddef.h>
#include <stdint.h>

typedef struct Tree Tree;

/* A branch is a longest chain of segments without a bifurcation inside. It begins at a root or at a
 * bifurcation. A segment is given by the index of the node at its end. Branch k consists of the
 * segments node[end[k - 1]] to node[end[k] - 1], where end[-1] stands for 0. Each of its segments
 * is the child of the segment before. Branches are in the order of their first segments. Both
 * arrays are owned. */
typedef struct Branches {
    int32_t *node; /* node indices of all branches, one branch after the other */
    size_t *end;   /* per branch: its end in `node` */
    size_t n;      /* number of branches */
} Branches;

/* Finds the branches of a tree, which may have none. Release *branches with branches_release.
 * Errors: STATUS_MEMORY. Cost: O(nodes). */
MUST_CHECK Status branches_find(const Tree *tree, Branches *branches, Err *err);
void branches_release(Branches *branches);

#endif
