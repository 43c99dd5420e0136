/* All bifurcations moved at once. */
#ifndef CORCAST_GROW_REFINE_JOINT_H
#define CORCAST_GROW_REFINE_JOINT_H

#include "grow/refine/refine_arbor.h"
#include "grow/refine/refine_clearance.h"

/* Workspace of joint_move, by node. */
typedef struct Joints {
    int32_t *order, *parent; /* the segments, mothers first; and the parents of all nodes */
    Vec3 *start, *goal, *place;
    Vec3 *load, *step;
    double (*spring)[6]; /* a symmetric matrix: 00, 10, 11, 20, 21, 22 */
    bool *was_clear;     /* of the segment */
    bool *fixed;         /* whether the node has to stay */
    uint32_t *returns;   /* how often the node went half of the way back to its start */
    size_t n;            /* segments in `order` */
    double promise;      /* what the step would gain of S_root by its first derivatives */
    double smoothing;    /* mm, of lengths */
    double level;        /* of the clearance */
    double margin;       /* of pushes, over what the rules ask */
} Joints;

/* Ends with joints_release, also on failure, STATUS_MEMORY. */
MUST_CHECK Status joints_init(Joints *joints, size_t nodes, Err *err);
void joints_release(Joints *joints);

/* Moves all bifurcations jointly towards where S_root is least for this topology, each as far as
 * domain and rules of clearance let it: no segment that kept the rules breaks one. *kept: false,
 * and all as it was, when that does not lower S_root. Needs right sums and fresh reservations, and
 * leaves them. O(n). */
MUST_CHECK Status joint_move(Joints *joints, Arbor *arbor, Clearance *clearance, bool *kept,
                             Err *err);

#endif
