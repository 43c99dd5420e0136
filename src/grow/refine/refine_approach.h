/* The way of all bifurcations to their goals. */
#ifndef CORCAST_GROW_REFINE_APPROACH_H
#define CORCAST_GROW_REFINE_APPROACH_H

#include "grow/refine/refine_joint.h"

/* Goes from the starts the share `whole` of the way to the goals, or as near to there as domain and
 * rules of clearance let it: *arrived, and no segment that kept the rules breaks one. Otherwise the
 * tree is not to be kept. Makes reservations anew. O(n). STATUS_MEMORY. */
MUST_CHECK Status approach_goals(Joints *joints, Arbor *arbor, Clearance *clearance, double whole,
                                 bool *arrived, Err *err);

#endif
