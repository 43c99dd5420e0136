/* States a tree as a convex optimisation problem: move the joints so that the sum of the costs of
 * all segments is least.
 *
 * A joint is a node of the tree together with its state: its position and its pressure drop from
 * the inlet. Outlets and inlets are fixed; all other joints are free. The radius of a segment
 * follows from its length and pressure drop by Poiseuille's law, so that radii are no unknowns. The
 * cost of a segment is l r^lambda, expressed by its length l and its pressure drop. */
#ifndef CORCAST_GROW_BOUND_BOUND_PROBLEM_H
#define CORCAST_GROW_BOUND_BOUND_PROBLEM_H

#include "base/base.h"
#include "tree/tree.h"
#include <stdbool.h>

/* The state of a joint: x, y, z in mm, and the drop of pressure from the inlet in the unit
 * of Outlet. */
enum { PLACE_AXES = 3, DROP = 3, STATE = 4 };

/* Lengths are smoothed [Reach], so that the cost has derivatives where joints coincide. The first
 * smoothing is this multiple of Problem.mean_length. Reason for 0.3 not recorded. */
#define FIRST_SMOOTHING 0.3

/* A joint and the segment that leads to it. */
typedef struct Joint {
    double at[STATE];
    double flow;    /* sum of the shares of the outlets at and below the joint */
    double factor;  /* flow^a */
    int32_t parent; /* index of the parent joint, lower than the joint's own; -1 at an inlet */
    int32_t outlet; /* index of the outlet; -1: the joint is not an outlet */
    bool is_free;
} Joint;

typedef struct Problem {
    double a;           /* lambda / 4 */
    Joint *joint;       /* owned */
    size_t n;           /* number of joints */
    int32_t *node;      /* per outlet: its node in the tree; owned */
    size_t outlets;     /* number of outlets */
    double target;      /* of the tree as it is, mm^(1 + lambda) */
    double mean_length; /* of the segments, mm; above 0 */
} Problem;

/* Makes the problem of a tree. Leaves out nodes with one child that are no outlets, and segments
 * without flow. An outlet that is not a terminal becomes two joints: a free joint, and a fixed
 * outlet that is a child of the free joint. Free joints begin at their positions in the tree, with
 * pressure drops that rise along every path to an outlet.
 *
 * problem  receives the problem; release it with problem_release.
 * Errors   STATUS_INPUT as bound_tree; STATUS_MEMORY. */
MUST_CHECK Status problem_init(Problem *problem, const Tree *tree, double lambda, Err *err);
void problem_release(Problem *problem);

static inline bool joint_is_inlet(const Joint *joint)
{
    return joint->parent < 0;
}

/* The segment to a joint, as the difference of the states of its two ends. Its length l is
 * smoothed: sqrt(l^2 + smoothing^2). */
typedef struct Reach {
    double by[STATE]; /* distal minus proximal state */
    double length2;   /* square of the smoothed length, mm^2 */
} Reach;

/* Returns the segment to joint i, which is not an inlet. `smoothing`, mm, is 0 or above. */
static inline Reach problem_reach(const Problem *problem, size_t i, double smoothing)
{
    const double *to = problem->joint[i].at;
    const double *from = problem->joint[problem->joint[i].parent].at;
    Reach reach;
    for (int k = 0; k < STATE; k++)
        reach.by[k] = to[k] - from[k];
    reach.length2 = reach.by[0] * reach.by[0] + reach.by[1] * reach.by[1] +
                    reach.by[2] * reach.by[2] + smoothing * smoothing;
    return reach;
}

/* Returns the cost of the segment to joint i: factor l^(1 + a) d^-a, with its length l and pressure
 * drop d; 0 if the length is 0. */
static inline double problem_cost(const Problem *problem, size_t i, const Reach *reach)
{
    if (reach->length2 == 0)
        return 0;
    double length = sqrt(reach->length2);
    return problem->joint[i].factor * length * elementary_pow(length / reach->by[DROP], problem->a);
}

#endif
