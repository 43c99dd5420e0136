/* One step of Newton's method on all free joints at once. */
#ifndef CORCAST_GROW_BOUND_NEWTON_H
#define CORCAST_GROW_BOUND_NEWTON_H

#include "grow/bound/bound_problem.h"

typedef double State[STATE];
/* A symmetric matrix: 00, 10, 11, 20, 21, 22, 30, 31, 32, 33. */
typedef double Symmetric[STATE * (STATE + 1) / 2];

typedef struct Newton {
    State *step;       /* of each joint; 0 where it is fixed */
    State *load;       /* workspace: what hangs on each joint */
    Symmetric *spring; /* likewise */
} Newton;

/* Ends with newton_release, also on failure, STATUS_MEMORY. */
MUST_CHECK Status newton_init(Newton *newton, size_t n, Err *err);
void newton_release(Newton *newton);

/* The target with smoothed lengths, of the free joints moved by `part` of the step; INFINITY where
 * a drop would not be above 0. */
double newton_cost(const Problem *problem, const Newton *newton, double smoothing, double part);

/* Computes the step to the minimum of the target's second-order model, lengths smoothed. Returns
 * by how much the target falls along it at first, to first order; not above 0. O(n). */
double newton_step(const Problem *problem, Newton *newton, double smoothing);

/* The force that segment i exerts on its joint at the end of the step, by that model. At every free
 * joint these balance. */
void newton_force(const Problem *problem, const Newton *newton, double smoothing, size_t i,
                  State force);

/* Moves the free joints by as much of the step as lowers the target, whose slope newton_step gave.
 * False when none does. */
bool newton_move(Problem *problem, const Newton *newton, double smoothing, double slope);

#endif
