/* Computes the lower bound that a step of Newton's method [bound_newton.h] proves, and stores the
 * largest bound so far.
 *
 * The optimisation problem minimises the cost of the tree, called the target. Each outlet has four
 * Lagrange multipliers, together called its force. Three are the pull: the multipliers of the
 * outlet's position. The fourth is the charge: the multiplier of the outlet's pressure drop
 * [Outlet]. The force of a segment is the sum of the forces of the outlets below it. Forces are
 * feasible if no segment's pull is larger than the cost of 1 mm of this segment. By weak duality,
 * feasible forces prove a lower bound of the target [docs/METHODS.md section 1.5].
 *
 * A step of Newton's method computes forces that are nearly feasible. dual_take reduces pulls where
 * they are too large, and then evaluates the bound. */
#ifndef CORCAST_GROW_BOUND_BOUND_DUAL_H
#define CORCAST_GROW_BOUND_BOUND_DUAL_H

#include "grow/bound/bound_newton.h"

/* A force: entries 0 to 2 are the pull along x, y and z, and entry DROP is the charge. */
typedef State DualForce;

/* The proof of the largest bound so far. The arrays are owned. */
typedef struct Dual {
    double bound; /* the largest bound so far, in mm^(1 + lambda), the unit of the target; lambda is
                   * the exponent of the radius in the target. 0: no bound yet */
    DualForce *force; /* per outlet: the force that proves the bound */
    DualForce *sum;   /* workspace, per joint: sum of the forces of the outlets there and below */
    double *kept; /* workspace, per joint: factor in [0, 1] by which the pulls of the outlets at and
                   * below the joint are multiplied, so that forces become feasible */
} Dual;

/* Allocates the arrays. Release *dual with dual_release, also after an error.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status dual_init(Dual *dual, const Problem *problem, Err *err);
void dual_release(Dual *dual);

/* Computes the bound that the forces after the last newton_step [bound_newton.h] prove. Stores the
 * bound and the forces in *dual if the bound is above dual->bound. Otherwise only the workspace of
 * *dual changes.
 *
 * smoothing  length in mm that smooths the lengths of segments; the value of the last newton_step.
 * Cost       O(n) for n joints. */
void dual_take(Dual *dual, const Problem *problem, const Newton *newton, double smoothing);

#endif
