/* The joint move: moves all bifurcations at once. The positions where the target is least for the
 * present topology are the goals; approach_goals [refine_approach.h] moves the nodes towards
 * them. Joint moves are needed where bifurcations would merge: moved one by one, each waits for
 * the other. */
#ifndef CORCAST_GROW_REFINE_REFINE_JOINT_H
#define CORCAST_GROW_REFINE_REFINE_JOINT_H

#include "grow/refine/refine_arbor.h"
#include "grow/refine/refine_clearance.h"

/* The workspace of joint_move. Arrays have one entry per node, unless stated, and are owned. */
typedef struct Joints {
    int32_t *order; /* the segments, mothers first */
    int32_t *parent;
    Vec3 *start, *goal, *place; /* mm */
    Vec3 *load, *step;
    double (*spring)[6]; /* a symmetric matrix: 00, 10, 11, 20, 21, 22 */
    bool *was_clear;     /* the segment kept the rules at the start */
    bool *fixed;         /* the node must stay */
    uint32_t *returns;   /* how often the node went half of the path back to its start */
    size_t n;            /* number of segments in `order` */
    double promise;      /* gain of S_root that the step's first derivatives promise */
    double smoothing;    /* mm, of lengths */
    double level;        /* of the clearance */
    double margin;       /* by which pushes exceed what the rules require, as a fraction */
} Joints;

/* Allocates the workspace. Release it with joints_release, also after an error.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status joints_init(Joints *joints, size_t nodes, Err *err);
void joints_release(Joints *joints);

/* Moves all bifurcations together towards the positions where S_root is least for this topology.
 * Each moves as far as the domain and the rules of clearance allow: no segment that kept the rules
 * breaks a rule. Needs right sums and fresh reservations, and leaves them.
 *
 * kept     receives false if the move does not lower S_root. The arbor is then as before.
 * Errors   STATUS_MEMORY.
 * Cost     O(n). */
MUST_CHECK Status joint_move(Joints *joints, Arbor *arbor, Clearance *clearance, bool *kept,
                             Err *err);

#endif
