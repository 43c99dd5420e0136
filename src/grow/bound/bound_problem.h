/* A tree as a convex optimisation problem: outlets and inlets are fixed, all else is free. */
#ifndef CORCAST_GROW_BOUND_PROBLEM_H
#define CORCAST_GROW_BOUND_PROBLEM_H

#include "base/base.h"
#include "tree/tree.h"
#include <stdbool.h>

/* x, y, z in mm, and the drop of pressure from the inlet in the unit of Outlet. */
enum { PLACE_AXES = 3, DROP = 3, STATE = 4 };

/* By how much lengths are smoothed at first, relative to the mean length. */
#define FIRST_SMOOTHING 0.3

/* A node and the segment that leads to it. */
typedef struct Joint {
    double at[STATE];
    double flow;    /* the outlets' shares at and below it */
    double factor;  /* flow^a */
    int32_t parent; /* below the own index; -1 at an inlet */
    int32_t outlet; /* its number; -1: none */
    bool is_free;
} Joint;

typedef struct Problem {
    double a; /* lambda / 4 */
    Joint *joint;
    size_t n;
    int32_t *node; /* of each outlet, in the tree */
    size_t outlets;
    double target;      /* of the tree */
    double mean_length; /* of the segments, mm; above 0 */
} Problem;

/* Makes *problem (owned; problem_release) of a tree. Nodes that blood only passes, and segments
 * that have no flow, are left out. An outlet that is no terminal becomes a free joint and an outlet
 * that hangs on it. Free joints begin where the tree has them, with drops that rise along every way
 * to an outlet. Errors as bound_tree. */
MUST_CHECK Status problem_init(Problem *problem, const Tree *tree, double lambda, Err *err);
void problem_release(Problem *problem);

static inline bool joint_is_inlet(const Joint *joint)
{
    return joint->parent < 0;
}

/* The segment to a joint as a difference of states, its length smoothed: sqrt(l^2 + smoothing^2).
 */
typedef struct Reach {
    double by[STATE];
    double length2; /* mm^2 */
} Reach;

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

/* What the segment costs: factor l^(1 + a) d^-a. */
static inline double problem_cost(const Problem *problem, size_t i, const Reach *reach)
{
    if (reach->length2 == 0)
        return 0;
    double length = sqrt(reach->length2);
    return problem->joint[i].factor * length * elementary_pow(length / reach->by[DROP], problem->a);
}

#endif
