/* Puts right what widened too much after it was made. */
#ifndef CORCAST_GROW_MEND_H
#define CORCAST_GROW_MEND_H

#include "domain/domain.h"
#include "grow/grid.h"
#include "grow/network.h"
#include "grow/place.h"

/* Moves bifurcations, as little as it takes, until all segments are at least as long as wide and
 * those without a common node clear of each other, at the present radii; what cannot be put right
 * so is left. The grid is that of the network and knows all its segments. Fails with STATUS_MEMORY
 * only. */
MUST_CHECK Status mend_network(Network *net, Grid *grid, const Domain *domain, const Rules *rules,
                               Err *err);

#endif
