/* Pairs of terminals, such as an artery's and a vein's: every terminal of the first tree has a
 * partner (its mate) in the second tree, at a fixed distance. */
#ifndef CORCAST_GROW_MATES_H
#define CORCAST_GROW_MATES_H

#include "grow/grow.h"
#include "grow/network.h"

/* Returns a random point at the distance `mm` from `terminal`, both in mm, as the position of its
 * mate. The direction is uniformly distributed; in two dimensions it is in the plane z = 0. Draws
 * one number from `random` in two dimensions, two in three. */
Vec3 mates_place(Vec3 terminal, double mm, int dimension, Random *random);

/* Records the network's pairs in the tree, which has the same nodes. Errors: STATUS_MEMORY. */
MUST_CHECK Status mates_write(const Network *net, Tree *tree, Err *err);

/* Checks that the ends of pairs, which are `pair_mm` apart, leave the clearance between the walls
 * of their vessels. Errors: STATUS_INFEASIBLE if vessels are too wide, with the distance that would
 * be sufficient; STATUS_MEMORY. */
MUST_CHECK Status mates_check(const GrowParams *params, const Tree *tree, Err *err);

#endif
