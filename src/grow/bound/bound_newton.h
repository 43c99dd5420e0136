/* One step of Newton's method for a Problem [bound_problem.h]. A joint is a node of the tree; its
 * state is its position and its pressure drop from the inlet. A step changes the states of all free
 * joints to lower the target, the sum of the costs of all segments. In all functions, lengths are
 * smoothed by `smoothing`, mm. Segment i ends at joint i.
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

/* A step and its workspace. Arrays have one entry per joint and are owned. */
typedef struct Newton {
    State *step; /* change of the joint's state by a full step; 0 if the joint is fixed */
    State *load; /* workspace: derivative, with respect to the joint's state, of the cost of the
                  * subtree below it; the joints below have been eliminated */
    Symmetric *spring; /* workspace: second derivatives of the same cost */
} Newton;

/* Allocates the arrays for `n` joints. Release *newton with newton_release, also after an error.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status newton_init(Newton *newton, size_t n, Err *err);
void newton_release(Newton *newton);

/* Returns the target, with smoothed lengths, at the end of the fraction `part` of the step;
 * INFINITY if a pressure drop would not be above 0 there. Moves no joint. */
double newton_cost(const Problem *problem, const Newton *newton, double smoothing, double part);

/* Computes the step to the minimum of the target's second-order model, with smoothed lengths.
 * Returns the derivative of the target along the step, at its beginning; it is at most 0.
 * Cost: O(n). */
double newton_step(const Problem *problem, Newton *newton, double smoothing);

/* Computes the force of segment i on joint i at the end of the step, by the second-order model: the
 * derivative of the segment's cost with respect to the state of the joint. At every free joint the
 * forces of all segments balance. */
void newton_force(const Problem *problem, const Newton *newton, double smoothing, size_t i,
                  State force);

/* Moves the free joints by a fraction of the step. The first fraction is 1, or 0.95 of the fraction
 * at which a pressure drop would be 0, if that is smaller. It is halved, up to 40 times, until the
 * target falls as Armijo's rule requires, with the usual constant 1e-4. Returns false, and moves no
 * joint, if no fraction that was tried satisfies the rule.
 *
 * slope    the result of newton_step. */
bool newton_move(Problem *problem, const Newton *newton, double smoothing, double slope);

#endif
