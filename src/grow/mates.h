/* Pairs of terminals, one of each of two trees, whose ends are in a given distance. */
#ifndef CORCAST_GROW_MATES_H
#define CORCAST_GROW_MATES_H

#include "grow/grow.h"
#include "grow/network.h"

/* A random place `mm` from a terminal, mm, in the plane z = 0 in two dimensions. */
Vec3 mates_place(Vec3 terminal, double mm, int dimension, Random *random);

/* Says the network's pairs in the tree, which has the same nodes. STATUS_MEMORY. */
MUST_CHECK Status mates_write(const Network *net, Tree *tree, Err *err);

/* Checks that the ends of pairs, which stand `pair_mm` apart, leave the clearance between the walls
 * of their vessels. STATUS_INFEASIBLE where vessels are too wide for that; then the sentence says
 * which distance would do. */
MUST_CHECK Status mates_check(const GrowParams *params, const Tree *tree, Err *err);

#endif
