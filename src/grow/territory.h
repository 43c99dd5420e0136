/* Territories: how much tissue each terminal supplies. The territory of a terminal is the set of
 * points that are nearer to it than to any other terminal. */
#ifndef CORCAST_GROW_TERRITORY_H
#define CORCAST_GROW_TERRITORY_H

#include "domain/domain.h"
#include "grow/network.h"

/* The inputs of territory_count. Pointers are borrowed. */
typedef struct TerritoryParams {
    const Domain *domain;
    const Demand *demand; /* demand of a point [demand_at]; NULL: every point has the demand 1 */
    double points;        /* number of lattice points per terminal, on average; a double, because
                           * callers compute it */
    int threads;          /* 0: all processors */
} TerritoryParams;

/* Measures the territory of each terminal by the points of a square or cubic lattice over the
 * domain. Without a demand map, the measure is the number of lattice points in the territory. With
 * a map, the measure is the sum of the demands at these points. Reads only the structure of the
 * network [network.h].
 *
 * share    receives, per node: the measure of the terminal's territory, but at least half of a
 *          lattice point of demand 1, so that no terminal is without flow; 0 for a node that is not
 *          a terminal.
 * Errors   STATUS_MEMORY.
 * Threads  The result does not depend on the number of threads. */
MUST_CHECK Status territory_count(const Network *net, const TerritoryParams *params, double *share,
                                  Err *err);

#endif
