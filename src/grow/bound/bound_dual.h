/* The lower bound that a step of Newton's method proves. */
#ifndef CORCAST_GROW_BOUND_DUAL_H
#define CORCAST_GROW_BOUND_DUAL_H

#include "grow/bound/bound_newton.h"

typedef struct Dual {
    double bound; /* the best so far; 0: none */
    State *force; /* of each outlet, scaled to prove it: its pull, and its charge */
    State *sum;   /* workspace: of each joint, the forces of the outlets at and below it */
    double *kept; /* likewise: the share of its pulls that a segment lets pass */
} Dual;

/* Ends with dual_release, also on failure, STATUS_MEMORY. */
MUST_CHECK Status dual_init(Dual *dual, const Problem *problem, Err *err);
void dual_release(Dual *dual);

/* Takes the forces at the end of the present step if they prove a better bound. O(n). */
void dual_take(Dual *dual, const Problem *problem, const Newton *newton, double smoothing);

/* The least cost of 1 mm of a segment that carries `flow` and pays `charge` for each unit of drop:
 * min over g of charge g + flow^a g^-a. */
double dual_mm(double a, double flow, double charge);

#endif
