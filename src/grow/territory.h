/* Territories: how much tissue each terminal supplies. The territory of a terminal is the set of
 * points that are nearer to it than to any other terminal. */
#ifndef CORCAST_GROW_TERRITORY_H
#define CORCAST_GROW_TERRITORY_H

#include "domain/domain.h"
#include "grow/network.h"

typedef struct TerritoryParams {
    const Domain *domain;
    const Demand *demand; /* demand of a point [demand_at]; NULL: every point has the demand 1 */
    double points;        /* number of lattice points per terminal */
    int threads;
} TerritoryParams;

/* Counts the points of a square or cubic lattice over the domain that are nearer to a terminal than
 * to any other terminal, or adds up the demands of these points. Needs no sums.
 *
 * share    receives, per node, the result for a terminal, but at least 1/2; 0 for other nodes.
 * Errors   STATUS_MEMORY.
 * Threads  The result does not depend on the number of threads. */
MUST_CHECK Status territory_count(const Network *net, const TerritoryParams *params, double *share,
                                  Err *err);

#endif
