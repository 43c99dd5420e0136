/* Divides a tree into branches: chains of segments without a bifurcation inside. */
#ifndef CORCAST_TREE_BRANCHES_H
#define CORCAST_TREE_BRANCHES_H

#include "base/base.h"
#include <stddef.h>
#include <stdint.h>

typedef struct Tree Tree;

/* The branches of a tree. A branch is a chain of segments from a root or a bifurcation, a node with
 * several children, to the next bifurcation or terminal; each of its segments is the daughter of
 * the segment before. A segment is represented by the index of its distal node. Branch k consists
 * of the segments node[end[k - 1]] to node[end[k] - 1]; branch 0 begins with node[0]. Branches are
 * in the order of their first segments. Both arrays are owned. */
typedef struct Branches {
    int32_t *node; /* node indices of all branches, one branch after the other */
    size_t *end;   /* per branch: 1 + position of its last segment in `node` */
    size_t n;      /* number of branches */
} Branches;

/* Finds the branches of a tree. A tree without segments has none. Release *branches with
 * branches_release. Errors: STATUS_MEMORY. Cost: O(nodes). */
MUST_CHECK Status branches_find(const Tree *tree, Branches *branches, Err *err);
void branches_release(Branches *branches);

#endif
