/* Moves all bifurcations from their starts towards their goals at the same time [refine_joint.h],
 * as far as the rules of clearance allow. */
#ifndef CORCAST_GROW_REFINE_REFINE_APPROACH_H
#define CORCAST_GROW_REFINE_REFINE_APPROACH_H

#include "grow/refine/refine_joint.h"

/* Moves every node from its start along the straight path to its goal, by the fraction `whole` of
 * the path, or as near to that point as the domain and the rules of clearance allow. Updates sums
 * and reserved radii.
 *
 * arrived  receives true if no segment that kept the rules breaks a rule. Otherwise the caller must
 *          restore the tree.
 * Errors   STATUS_MEMORY.
 * Cost     O(n). */
MUST_CHECK Status approach_goals(Joints *joints, Arbor *arbor, Clearance *clearance, double whole,
                                 bool *arrived, Err *err);

#endif
