/* One step of Newton's method on all free joints at once, to minimise the target of a Problem.
 * Lengths are smoothed [bound_problem.h] by `smoothing`, mm, in all functions.
 *
 *     double slope = newton_step(&problem, &newton, smoothing);     (computes the step)
 *     bool moved = newton_move(&problem, &newton, smoothing, slope);  (takes a part of the step) */
#ifndef CORCAST_GROW_BOUND_BOUND_NEWTON_H
#define CORCAST_GROW_BOUND_BOUND_NEWTON_H

#include "grow/bound/bound_problem.h"

/* The state of a joint, a change of the state, or a derivative with respect to it. */
typedef double State[STATE];
/* A symmetric matrix over states. Its entries are 00, 10, 11, 20, 21, 22, 30, 31, 32, 33. */
typedef double Symmetric[STATE * (STATE + 1) / 2];

/* Arrays have one entry per joint and are owned. */
typedef struct Newton {
    State *step;       /* change of the joint's state by a full step; 0 if the joint is fixed */
    State *load;       /* workspace: gradient of the subtree below the joint, after elimination */
    Symmetric *spring; /* workspace: second derivatives of that subtree, after elimination */
} Newton;

/* Allocates the arrays for `n` joints. Release *newton with newton_release, also after an error.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status newton_init(Newton *newton, size_t n, Err *err);
void newton_release(Newton *newton);

/* Returns the target with smoothed lengths that the tree would have if the free joints moved by
 * `part` of the step; INFINITY if a pressure drop would not be above 0. Moves nothing. */
double newton_cost(const Problem *problem, const Newton *newton, double smoothing, double part);

/* Computes the step to the minimum of the target's second-order model, with smoothed lengths.
 * Returns the derivative of the target along the step, at its beginning; it is at most 0.
 * Cost: O(n). */
double newton_step(const Problem *problem, Newton *newton, double smoothing);

/* Computes the force that segment i exerts on its joint at the end of the step, by the second-order
 * model. At every free joint these forces balance. */
void newton_force(const Problem *problem, const Newton *newton, double smoothing, size_t i,
                  State force);

/* Moves the free joints by a part of the step. Halves the part, from 1 or from the part at which a
 * pressure drop comes near 0, until the target falls by enough (Armijo's rule). `slope` is the
 * result of newton_step. Returns false, and moves nothing, if no tried part lowers the target by
 * enough. */
bool newton_move(Problem *problem, const Newton *newton, double smoothing, double slope);

#endif
