/* One step of Newton's method on all free joints at once, to minimise the target of a Problem.
 * Lengths are smoothed [bound_problem.h] by `smoothing`, mm. */
#ifndef CORCAST_GROW_BOUND_BOUND_NEWTON_H
#define CORCAST_GROW_BOUND_BOUND_NEWTON_H

#include "grow/bound/bound_problem.h"

typedef double State[STATE];
/* A symmetric matrix: 00, 10, 11, 20, 21, 22, 30, 31, 32, 33. */
typedef double Symmetric[STATE * (STATE + 1) / 2];

/* Arrays have one entry per joint and are owned. */
typedef struct Newton {
    State *step;       /* 0 where the joint is fixed */
    State *load;       /* workspace: load of the subtree below the joint */
    Symmetric *spring; /* workspace: spring of the subtree below the joint */
} Newton;

/* Allocates the arrays for `n` joints. Release *newton with newton_release, also after an error.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status newton_init(Newton *newton, size_t n, Err *err);
void newton_release(Newton *newton);

/* Returns the target with smoothed lengths, after the free joints have moved by `part` of the step;
 * INFINITY if a pressure drop would not be above 0. */
double newton_cost(const Problem *problem, const Newton *newton, double smoothing, double part);

/* Computes the step to the minimum of the target's second-order model, with smoothed lengths.
 * Returns the derivative of the target along the step, at its beginning; it is at most 0.
 * Cost: O(n). */
double newton_step(const Problem *problem, Newton *newton, double smoothing);

/* Computes the force that segment i exerts on its joint at the end of the step, by the second-order
 * model. At every free joint these forces balance. */
void newton_force(const Problem *problem, const Newton *newton, double smoothing, size_t i,
                  State force);

/* Moves the free joints by the largest tried part of the step that lowers the target by enough.
 * `slope` is the result of newton_step. Returns false if no part does. */
bool newton_move(Problem *problem, const Newton *newton, double smoothing, double slope);

#endif
