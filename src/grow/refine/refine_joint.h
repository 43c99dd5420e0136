/* The joint move: moves all bifurcations of an arbor [refine_arbor.h] at the same time. The goals
 * of the move are the positions with the lowest target for the present topology. approach_goals
 * then moves the nodes towards the goals. Joint moves are needed where bifurcations would merge: if
 * they are moved one by one, each waits for the other. */
#ifndef CORCAST_GROW_REFINE_REFINE_JOINT_H
#define CORCAST_GROW_REFINE_REFINE_JOINT_H

#include "grow/refine/refine_arbor.h"
#include "grow/refine/refine_clearance.h"

/* The workspace of Newton's method at a node: sums over the subtree below it, and the step. */
typedef struct JointSpring {
    double matrix[6]; /* second derivatives of S_root, a symmetric matrix: 00, 10, 11, 20, 21, 22 */
    Vec3 load;        /* first derivatives */
    Vec3 step;        /* mm */
} JointSpring;

/* What approach_goals records of a node and of the segment that ends there. */
typedef struct JointMark {
    bool was_clear;   /* the segment kept the rules at the start */
    bool fixed;       /* the node must keep its position */
    uint32_t returns; /* how often the node went half of the path back to its start */
} JointMark;

/* The workspace of joint_move. Arrays have one entry per node, unless stated, and are owned. */
typedef struct Joints {
    int32_t *order;             /* the segments, parents before daughters */
    int32_t *parent;            /* parent node, as in the arbor */
    Vec3 *start, *goal, *place; /* positions before the move, wanted, and at present, mm */
    JointSpring *spring;
    JointMark *mark;
    size_t n;         /* number of segments in `order` */
    double promise;   /* gain of S_root that the step's first derivatives promise */
    double smoothing; /* mm, of lengths */
    double level;     /* of the clearance */
    double margin;    /* fraction by which pushes exceed the distance that the rules require */
} Joints;

/* Allocates the workspace. Release it with joints_release, also after an error.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status joints_init(Joints *joints, size_t nodes, Err *err);
/* Frees the arrays and zeroes *joints, which may be zeroed before. */
void joints_release(Joints *joints);

/* Moves all bifurcations together towards the positions where S_root is least for this topology.
 * Each moves as far as the domain and the rules of clearance allow: no segment that kept the rules
 * breaks a rule. Requires exact sums. Leaves exact sums, and reserved radii of the new positions.
 *
 * kept     receives false if the move does not lower S_root. The arbor is then as before.
 * Errors   STATUS_MEMORY.
 * Cost     O(n). */
MUST_CHECK Status joint_move(Joints *joints, Arbor *arbor, Clearance *clearance, bool *kept,
                             Err *err);

/* Part of joint_move [refine_approach.c]: moves every node from its start along the straight path
 * to its goal, by the fraction `whole` of the path, or as near to that point as the domain and the
 * rules of clearance allow. Updates sums and reserved radii.
 *
 * arrived  receives true if no segment that kept the rules breaks a rule. Otherwise the caller must
 *          restore the tree.
 * Errors   STATUS_MEMORY.
 * Cost     O(n). */
MUST_CHECK Status approach_goals(Joints *joints, Arbor *arbor, Clearance *clearance, double whole,
                                 bool *arrived, Err *err);

#endif
