/* The joint (simultaneous) move: moves all bifurcations of a tree [Arbor, refine_arbor.h] at the
 * same time. joint_move first computes a goal for every bifurcation: the positions that together
 * minimise the cost of the tree, S_root [law.h], for its topology. It then calls approach_goals,
 * which moves the nodes towards their goals. Joint moves are needed where bifurcations come close
 * to each other: moved one at a time, each would block the other. */
#ifndef CORCAST_GROW_REFINE_REFINE_JOINT_H
#define CORCAST_GROW_REFINE_REFINE_JOINT_H

#include "grow/refine/refine_arbor.h"
#include "grow/refine/refine_clearance.h"

/* The block of a node in a Newton step, which minimises the second-order model of S_root. Nodes are
 * eliminated from the terminals to the root. `matrix` and `gradient` then hold what the eliminated
 * segments below the node contribute. */
typedef struct JointSpring {
    double matrix[6]; /* second derivatives of S_root by the position: xx, yx, yy, zx, zy, zz. After
                       * the node's elimination: the inverse of the sum of this matrix and the
                       * second derivatives of the segment that ends at the node */
    Vec3 gradient;    /* first derivatives of S_root by the position */
    Vec3 step;        /* displacement of the node, mm */
} JointSpring;

/* The state of a node, and of the segment that ends there, in approach_goals. */
typedef struct JointMark {
    bool was_clear;   /* the segment kept the rules of clearance before the move */
    bool fixed;       /* the node must keep its position */
    uint32_t returns; /* number of times that the node's displacement from its start was halved */
} JointMark;

/* The workspace of joint_move. Arrays have one entry per node, unless stated, and are owned. */
typedef struct Joints {
    int32_t *order;             /* the segments, parents before daughters */
    int32_t *parent;            /* parent node, as in the arbor */
    Vec3 *start, *goal, *place; /* positions before the move, at the goal, and at present, mm */
    JointSpring *spring;
    JointMark *mark;
    size_t n;              /* number of segments in `order` */
    double predicted_gain; /* decrease of S_root, per unit of step, that the gradients predict */
    double smoothing; /* mm; the model uses sqrt(l^2 + smoothing^2) for a length l, because a length
                       * has no derivative at 0 */
    double level;     /* factor by which the rules multiply radii [Clearance.level] */
    double margin;    /* approach_goals moves segments that break a rule apart by this fraction more
                       * than the rule requires */
} Joints;

/* Allocates the workspace. Release it with joints_release, also after an error.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status joints_init(Joints *joints, size_t nodes, Err *err);
/* Frees the arrays and zeroes *joints, which may be zeroed before. */
void joints_release(Joints *joints);

/* Moves all bifurcations together towards the positions with the least S_root for this topology, as
 * far as the domain and the rules of clearance allow. No segment that kept the rules before breaks
 * a rule afterwards. Leaves the sums of the arbor exact, and calls clearance_reserve.
 *
 * kept     receives false if the move does not lower S_root. Positions are then as before.
 * Errors   STATUS_MEMORY.
 * Cost     O(n). */
MUST_CHECK Status joint_move(Joints *joints, Arbor *arbor, Clearance *clearance, bool *kept,
                             Err *err);

/* The second half of joint_move, in a file of its own [refine_approach.c]; joint_move alone calls
 * it, and has set parent, order, n, start, goal and was_clear. Moves every node from its start by
 * `fraction` of the straight path to its goal. A node whose segments then break a rule of clearance
 * or leave the domain is pushed aside or moved back towards its start. Leaves the sums of the arbor
 * exact, and calls clearance_reserve.
 *
 * arrived  receives true if no segment that kept the rules before breaks a rule. If it receives
 *          false, the caller must restore the tree.
 * Errors   STATUS_MEMORY.
 * Cost     O(n). */
MUST_CHECK Status approach_goals(Joints *joints, Arbor *arbor, Clearance *clearance,
                                 double fraction, bool *arrived, Err *err);

#endif
