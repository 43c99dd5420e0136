/* How much tissue each terminal supplies. */
#ifndef CORCAST_GROW_TERRITORY_H
#define CORCAST_GROW_TERRITORY_H

#include "domain/domain.h"
#include "grow/network.h"

/* Sets share[i] of every terminal i to the number of points of a square or cubic lattice over the
 * domain, `points` of them a terminal, that are nearer to it than to any other; 1/2 where there are
 * none, and 0 at all other nodes. The same for any number of threads. */
MUST_CHECK Status territory_count(const Network *net, const Domain *domain, double points,
                                  int threads, double *share, Err *err);

#endif
