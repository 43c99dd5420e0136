/* Smooths and resamples the centrelines of measured trees. Both work along each branch
 * [tree/branches.h]. Roots, bifurcations and terminals keep their positions. */
#ifndef CORCAST_TREE_CENTRELINE_H
#define CORCAST_TREE_CENTRELINE_H

#include "base/base.h"
#include <stddef.h>

typedef struct Tree Tree;

/* How far tree_smooth may move a node, in radii of the thinner of its two segments. */
#define SMOOTH_MOST_RADII 0.25

/* Quantities by which two versions of a tree are compared. */
typedef struct CentrelineSums {
    double length_mm, volume_mm3; /* sum of pi r^2 l */
    double resistance;            /* sum of l / r^4 over the segments with a radius, 1/mm^3 */
} CentrelineSums;

CentrelineSums centreline_sums(const Tree *tree);

typedef struct SmoothMoves {
    double most_mm, most_radii; /* largest move of a node */
    size_t held;                /* number of nodes that SMOOTH_MOST_RADII held back */
} SmoothMoves;

/* Moves the nodes inside branches by 10 rounds of Taubin's filter with the factors 0.5 and -0.53
 * [Taubin, SIGGRAPH 1995], which removes the steps of voxels and does not shorten curves. A node
 * moves by at most SMOOTH_MOST_RADII; one at a segment without radius stays. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status tree_smooth(Tree *tree, SmoothMoves *moves, Err *err);

/* Makes a copy of the tree whose branches have segments of equal length, as near to `step_mm` > 0
 * as their number allows, at least one per branch. The new nodes lie on the old segments.
 *
 * A new segment has the radius of the tube with the same resistance as the old ones that it
 * replaces: the mean of r^-4 over the length. Columns and types are those of the old segment at its
 * end. Flow shares move to the next node. Ids are 1 to n.
 *
 * out      receives the tree; release it with tree_release.
 * Errors   STATUS_INFEASIBLE if there would be more than TREE_MAX_ID nodes; STATUS_MEMORY. */
MUST_CHECK Status tree_resampled(const Tree *tree, double step_mm, Tree *out, Err *err);

#endif
