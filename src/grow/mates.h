/* Pairs of terminals, such as an artery's and a vein's: every terminal of the first tree has a
 * partner (its mate) in the second tree, at a fixed distance. */
#ifndef CORCAST_GROW_MATES_H
#define CORCAST_GROW_MATES_H

#include "grow/grow.h"
#include "grow/network.h"

/* Returns a random point at the distance `distance_mm` from `terminal`, mm, as the position of
 * its mate. The direction is uniformly distributed; if `dimension` is 2, it is in the plane z = 0.
 * Draws one number from `random` in two dimensions, two in three. */
Vec3 mates_place(Vec3 terminal, double distance_mm, int dimension, Random *random);

/* Records the pairs of the network's terminals in `tree` [tree/pairs.h]. `tree` must have the nodes
 * of the network, in the same order; it contains both trees of each pair. Errors: STATUS_MEMORY. */
MUST_CHECK Status mates_write(const Network *net, Tree *tree, Err *err);

/* Checks that the paired terminals of a tree, whose ends are params->pair_mm apart, leave
 * params->clearance_mm between the walls of their vessels. Errors: STATUS_INFEASIBLE if vessels are
 * too wide, with the distance that would be sufficient; STATUS_MEMORY. */
MUST_CHECK Status mates_check(const GrowParams *params, const Tree *tree, Err *err);

#endif
