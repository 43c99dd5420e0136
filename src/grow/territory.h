/* How much tissue each terminal supplies. */
#ifndef CORCAST_GROW_TERRITORY_H
#define CORCAST_GROW_TERRITORY_H

#include "domain/domain.h"
#include "grow/network.h"

/* Sets share[i], one for each node, to the number of points of a square or cubic lattice over the
 * domain that are nearer to the terminal i than to any other, or with a map to the sum of what
 * these ask for [demand_at], but to 1/2 at least; and to 0 for nodes that are no terminals. The
 * lattice has `points` points for each terminal. Needs no sums. The result is the same for any
 * number of threads. STATUS_MEMORY. */
MUST_CHECK Status territory_count(const Network *net, const Domain *domain, const Demand *demand,
                                  double points, int threads, double *share, Err *err);

#endif
