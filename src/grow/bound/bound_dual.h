/* Computes the lower bound that a step of Newton's method [bound_newton.h] proves, and keeps the
 * best one. Each outlet has a force, a dual variable of the optimisation problem: the pull on its
 * position, and the charge for its pressure drop [Outlet]. If the forces balance at every
 * bifurcation, they prove a lower bound of the target [docs/METHODS.md section 1.5]. */
#ifndef CORCAST_GROW_BOUND_BOUND_DUAL_H
#define CORCAST_GROW_BOUND_BOUND_DUAL_H

#include "grow/bound/bound_newton.h"

/* The best proof so far. The arrays are owned. In this header a State is a force: entries 0 to 2
 * are the pull along x, y and z, and entry DROP is the charge. */
typedef struct Dual {
    double bound; /* the best bound so far, mm^(1 + lambda); 0: none */
    State *force; /* per outlet: the force that proves the bound */
    State *sum; /* workspace, per joint: sum of the forces of the outlets at and below the joint */
    double *kept; /* workspace, per joint: factor, at most 1, by which the pulls of the outlets at
                   * and below the joint are reduced, so that they are feasible for its segment */
} Dual;

/* Allocates the arrays. Release *dual with dual_release, also after an error.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status dual_init(Dual *dual, const Problem *problem, Err *err);
void dual_release(Dual *dual);

/* Computes the bound that the forces at the end of the present step prove. Stores the bound and the
 * forces if the bound is above dual->bound. Requires a call of newton_step [bound_newton.h] with
 * the same `smoothing`, mm. Cost: O(n). */
void dual_take(Dual *dual, const Problem *problem, const Newton *newton, double smoothing);

#endif
