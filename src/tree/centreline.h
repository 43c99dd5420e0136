/* Smooths and resamples the centrelines of measured trees. Both operations treat each branch on its
 * own: a path of segments without bifurcations inside [tree/branches.h]. Roots, bifurcations and
 * terminals keep their positions. */
#ifndef CORCAST_TREE_CENTRELINE_H
#define CORCAST_TREE_CENTRELINE_H

#include "base/base.h"
#include <stddef.h>

typedef struct Tree Tree;

/* Maximum distance by which tree_smooth moves a node, as a multiple of the radius of the thinner
 * one of its two segments. Reason for 0.25 not recorded. */
#define SMOOTH_MOST_RADII 0.25

/* Quantities by which two versions of a tree are compared. */
typedef struct CentrelineSums {
    double length_mm, volume_mm3; /* sums of l and of pi r^2 l over all segments */
    double resistance;            /* sum of l / r^4 over the segments with r > 0, 1/mm^3 */
} CentrelineSums;

/* Returns the sums of a tree. */
CentrelineSums centreline_sums(const Tree *tree);

/* The distances by which tree_smooth moved nodes. */
typedef struct SmoothMoves {
    double most_mm;    /* largest distance, mm */
    double most_radii; /* largest distance, in radii of the node's thinner segment */
    size_t limited;    /* number of nodes whose distance was limited to SMOOTH_MOST_RADII */
} SmoothMoves;

/* Smooths the positions of the nodes inside branches by 10 rounds of Taubin's filter with the
 * factors 0.5 and -0.53 [Taubin, SIGGRAPH 1995]. The filter removes the staircase of voxels and
 * does not shorten curves. After the last round, the distance of a node from its old position is
 * limited to SMOOTH_MOST_RADII radii of its thinner segment. A node at a segment of radius 0 does
 * not move.
 *
 * moves    receives the distances.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status tree_smooth(Tree *tree, SmoothMoves *moves, Err *err);

/* Makes a copy of the tree in which each branch has segments of equal length, measured along the
 * old centreline. The number of new segments of a branch is its length / `step_mm`, rounded, but at
 * least 1. A branch whose end has a link, which closes a loop [Tree.link], gets at least 3
 * segments, or its old number if that is lower. `step_mm` is above 0. The new nodes are on the old
 * segments.
 *
 * A new segment has the same Poiseuille resistance per length as the old segments that it replaces:
 * its r^-4 is the length-weighted mean of their r^-4. It has the column values and the type of the
 * old segment at its distal end. The flow share of an old node is added to the next new node
 * downstream. Ids are 1 to n.
 *
 * out      receives the tree; release it with tree_release.
 * Errors   STATUS_INFEASIBLE if there would be more than TREE_MAX_ID nodes; STATUS_MEMORY. */
MUST_CHECK Status tree_resample_copy(const Tree *tree, double step_mm, Tree *out, Err *err);

#endif
