/* Pairs of terminals, for example of an arterial and a venous tree. Every terminal of the first
 * tree has a partner (its mate) in the second tree, at a fixed distance. Both trees are in one
 * Network, and later in one Tree. */
#ifndef CORCAST_GROW_MATES_H
#define CORCAST_GROW_MATES_H

#include "grow/grow.h"
#include "grow/network.h"

/* Returns a random position, mm, for the mate of a terminal at the position `terminal`, mm. The
 * distance is `distance_mm`, and the direction is uniformly distributed; if `dimension` is 2, it is
 * parallel to the plane z = 0. The position may be outside the domain. Draws one number from
 * `random` in two dimensions, and two numbers in three dimensions. */
Vec3 mates_place(Vec3 terminal, double distance_mm, int dimension, Random *random);

/* Stores the pairs of the network's terminals in `tree` [tree/pairs.h]. `tree` must have the nodes
 * of the network, in the same order. Errors: STATUS_MEMORY. */
MUST_CHECK Status mates_write(const Network *net, Tree *tree, Err *err);

/* Checks that the walls of paired terminals of `tree` are at least params->clearance_mm apart.
 * Their ends are params->pair_mm apart. A tree without pairs is accepted. Errors: STATUS_INFEASIBLE
 * if vessels are too wide; the sentence states a pair_mm that would suffice. STATUS_MEMORY. */
MUST_CHECK Status mates_check(const GrowParams *params, const Tree *tree, Err *err);

#endif
