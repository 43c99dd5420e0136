/* The lower bound that a step of Newton's method [bound_newton.h] proves. Each outlet gets a force,
 * which is a dual variable of the optimisation problem: its pull on the tree, and the charge for
 * its pressure drop. If the forces balance at every bifurcation, no tree of this topology has a
 * lower target than the bound that follows from them [METHODS 1.5]. */
#ifndef CORCAST_GROW_BOUND_BOUND_DUAL_H
#define CORCAST_GROW_BOUND_BOUND_DUAL_H

#include "grow/bound/bound_newton.h"

/* The best proof so far. The arrays are owned. A State here is a force: the pull along x, y and z,
 * and the charge in place DROP. */
typedef struct Dual {
    double bound; /* the best bound so far, mm^(1 + lambda); 0: none */
    State *force; /* per outlet: the force that proves the bound */
    State *sum; /* workspace, per joint: sum of the forces of the outlets at and below the joint */
    double *kept; /* workspace, per joint: factor by which the pulls below the joint are reduced, so
                   * that the segment to the joint can bear them */
} Dual;

/* Allocates the arrays. Release *dual with dual_release, also after an error.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status dual_init(Dual *dual, const Problem *problem, Err *err);
void dual_release(Dual *dual);

/* Computes the bound that the forces at the end of the present step prove. Stores the bound and the
 * forces if the bound is above dual->bound. newton_step [bound_newton.h] was called with the same
 * smoothing, mm. Cost: O(n). */
void dual_take(Dual *dual, const Problem *problem, const Newton *newton, double smoothing);

#endif
