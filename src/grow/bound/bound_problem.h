/* States a tree as a convex optimisation problem: find the states of the joints that minimise the
 * sum of the costs of all segments. bound_newton.h solves the problem, and bound_dual.h derives
 * from the solution a lower bound of the cost of all trees with this topology [bound.h].
 *
 * A joint is a node of the tree. Its state is its position and its pressure drop from the inlet.
 * The states of inlets and outlets are fixed; all other joints are free. The radius r of a segment
 * follows from its length and pressure drop by Poiseuille's law, so radii are not unknowns. The
 * cost of a segment of length l is l r^lambda, expressed by l and the pressure drop. */
#ifndef CORCAST_GROW_BOUND_BOUND_PROBLEM_H
#define CORCAST_GROW_BOUND_BOUND_PROBLEM_H

#include "base/base.h"
#include "tree/tree.h"
#include <stdbool.h>

/* The entries of the state of a joint: x, y and z in mm, then the pressure drop from the inlet. The
 * unit of pressure is 8 mu Q / (pi mm^3), where mu is the viscosity and Q the flow of the flow
 * share 1. STATE is the number of entries, DROP the index of the pressure drop, and SPACE_AXES the
 * number of coordinates. */
enum { SPACE_AXES = 3, DROP = 3, STATE = 4 };

/* The first smoothing of lengths [JointDifference], as a multiple of Problem.mean_length. With
 * smoothed lengths, the cost has derivatives where joints coincide. The smoothing then shrinks in
 * stages. A larger first value makes the first stage easier and adds stages; a much smaller one
 * makes Newton's method overshoot at short segments. */
#define FIRST_SMOOTHING 0.3

/* A joint and the segment that leads to it. */
typedef struct Joint {
    double at[STATE]; /* the state */
    double flow;      /* sum of the flow shares of the outlets at and below the joint */
    double factor;    /* flow^a, a factor of the segment's cost */
    int32_t parent;   /* index of the parent joint, lower than the joint's own; -1 at an inlet */
    int32_t outlet;   /* index of the outlet; -1: the joint is not an outlet */
    bool is_free;
} Joint;

/* The problem. */
typedef struct Problem {
    double a;           /* lambda / 4 */
    Joint *joint;       /* owned */
    size_t n;           /* number of joints */
    int32_t *node;      /* per outlet: its node in the tree; owned */
    size_t outlets;     /* number of outlets */
    double target;      /* sum of l r^lambda over the segments of the given tree, mm^(1 + lambda) */
    double mean_length; /* mean length of the segments, mm; above 0 */
} Problem;

/* Makes the problem of a tree. Leaves out nodes with one child that are not outlets, and segments
 * without flow. An outlet that is not a terminal becomes two joints: a free joint, and its child, a
 * fixed outlet. Free joints begin at their positions in the tree, with pressure drops that rise
 * along every path to an outlet.
 *
 * problem  receives the problem; release it with problem_release.
 * Errors   STATUS_INPUT, as bound_tree [bound.h]; STATUS_MEMORY. */
MUST_CHECK Status problem_init(Problem *problem, const Tree *tree, double lambda, Err *err);
void problem_release(Problem *problem);

static inline bool joint_is_inlet(const Joint *joint)
{
    return joint->parent < 0;
}

/* The segment to a joint, as the difference between the states of its two ends. A length l is
 * smoothed to sqrt(l^2 + smoothing^2), because l has no derivative at 0. */
typedef struct JointDifference {
    double by[STATE]; /* distal minus proximal state */
    double length2;   /* square of the smoothed length, mm^2 */
} JointDifference;

/* Returns the segment to joint i, which must not be an inlet. `smoothing`, mm, is at least 0. */
static inline JointDifference problem_reach(const Problem *problem, size_t i, double smoothing)
{
    const double *to = problem->joint[i].at;
    const double *from = problem->joint[problem->joint[i].parent].at;
    JointDifference reach;
    for (int k = 0; k < STATE; k++)
        reach.by[k] = to[k] - from[k];
    reach.length2 = reach.by[0] * reach.by[0] + reach.by[1] * reach.by[1] +
                    reach.by[2] * reach.by[2] + smoothing * smoothing;
    return reach;
}

/* Returns the cost of the segment to joint i: factor l^(1 + a) d^-a, where l is the length and d
 * the pressure drop in `reach`, which must be above 0; 0 if l is 0. */
static inline double problem_cost(const Problem *problem, size_t i, const JointDifference *reach)
{
    if (reach->length2 == 0)
        return 0;
    double length = sqrt(reach->length2);
    return problem->joint[i].factor * length * elementary_pow(length / reach->by[DROP], problem->a);
}

#endif
