/* The joint move: moves all bifurcations of an arbor [refine_arbor.h] at the same time. It first
 * computes a goal for every bifurcation: the positions that together minimise the target for the
 * present topology. approach_goals then moves the nodes towards their goals. Joint moves are needed
 * where bifurcations come close to each other: moved one at a time, each would block the other. */
#ifndef CORCAST_GROW_REFINE_REFINE_JOINT_H
#define CORCAST_GROW_REFINE_REFINE_JOINT_H

#include "grow/refine/refine_arbor.h"
#include "grow/refine/refine_clearance.h"

/* The workspace of Newton's method at a node: sums over the subtree below it, and the step. */
typedef struct JointSpring {
    double matrix[6]; /* second derivatives of S_root: entries 00, 10, 11, 20, 21, 22 of a symmetric
                       * matrix */
    Vec3 load;        /* first derivatives */
    Vec3 step;        /* mm */
} JointSpring;

/* The state of a node, and of the segment that ends there, in approach_goals. */
typedef struct JointMark {
    bool was_clear;   /* the segment kept the rules of clearance before the move */
    bool fixed;       /* the node must keep its position */
    uint32_t returns; /* number of times that the node went back half of its path to the start */
} JointMark;

/* The workspace of joint_move. Arrays have one entry per node, unless stated, and are owned. */
typedef struct Joints {
    int32_t *order;             /* the segments, parents before daughters */
    int32_t *parent;            /* parent node, as in the arbor */
    Vec3 *start, *goal, *place; /* positions before the move, at the goal, and at present, mm */
    JointSpring *spring;
    JointMark *mark;
    size_t n;         /* number of segments in `order` */
    double promise;   /* decrease of S_root that the first derivatives predict for the step */
    double smoothing; /* mm; a length l counts as sqrt(l^2 + smoothing^2) */
    double level;     /* Clearance.level */
    double margin; /* a push moves two segments apart by this fraction more than the rules need */
} Joints;

/* Allocates the workspace. Release it with joints_release, also after an error.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status joints_init(Joints *joints, size_t nodes, Err *err);
/* Frees the arrays and zeroes *joints, which may be zeroed before. */
void joints_release(Joints *joints);

/* Moves all bifurcations together towards the positions with the least S_root [law.h] for this
 * topology, as far as the domain and the rules of clearance allow. No segment that kept the rules
 * before breaks a rule afterwards. Sums are exact after the move, and reserved radii are updated.
 *
 * kept     receives false if the move does not lower S_root. The arbor is then as before.
 * Errors   STATUS_MEMORY.
 * Cost     O(n). */
MUST_CHECK Status joint_move(Joints *joints, Arbor *arbor, Clearance *clearance, bool *kept,
                             Err *err);

/* The second half of joint_move [refine_approach.c]: moves every node from its start by the
 * fraction `whole` of the straight path to its goal. Where the domain or the rules of clearance
 * forbid this position, the node moves as near to it as they allow. Updates sums and reserved
 * radii.
 *
 * arrived  receives true if no segment that kept the rules before breaks a rule. If it receives
 *          false, the caller must restore the tree.
 * Errors   STATUS_MEMORY.
 * Cost     O(n). */
MUST_CHECK Status approach_goals(Joints *joints, Arbor *arbor, Clearance *clearance, double whole,
                                 bool *arrived, Err *err);

#endif
