/* The grown network becomes a Tree. */
#ifndef CORCAST_GROW_FINISH_H
#define CORCAST_GROW_FINISH_H

#include "grow/grow.h"
#include "grow/network.h"

/* Renumbers `net`, whose terminals have their shares, computes all radii from the coordinates and
 * writes the tree and its meta into *out. STATUS_INFEASIBLE when a radius is beyond the range of
 * a double. */
MUST_CHECK Status finish_tree(Network *net, const GrowParams *params, const Domain *domain,
                              Tree *out, Err *err);

#endif
