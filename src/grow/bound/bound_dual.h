/* The lower bound that a step of Newton's method proves. Each outlet gets a force (a dual
 * variable): its pull on the tree and the charge for its pressure drop. Forces that balance prove
 * that no tree of this topology has a lower target [METHODS 1.5]. */
#ifndef CORCAST_GROW_BOUND_BOUND_DUAL_H
#define CORCAST_GROW_BOUND_BOUND_DUAL_H

#include "grow/bound/bound_newton.h"

/* Arrays are owned. */
typedef struct Dual {
    double bound; /* the best bound so far; 0: none */
    State *force; /* per outlet: its pull and its charge, scaled to prove the bound */
    State *sum;   /* workspace, per joint: sum of the forces of the outlets at and below it */
    double *kept; /* workspace, per joint: share of its pulls that the segment to it lets pass */
} Dual;

/* Allocates the arrays. Release *dual with dual_release, also after an error.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status dual_init(Dual *dual, const Problem *problem, Err *err);
void dual_release(Dual *dual);

/* Stores the forces at the end of the present step, if they prove a better bound. Cost: O(n). */
void dual_take(Dual *dual, const Problem *problem, const Newton *newton, double smoothing);

/* Returns the least cost of 1 mm of a segment that carries `flow` and pays `charge` per unit of
 * pressure drop: the minimum over g of charge g + flow^a g^-a. */
double dual_mm(double a, double flow, double charge);

#endif
