/* Repairs the few vessels that came to touch others, or wider than long, while the tree grew. */
#ifndef CORCAST_GROW_REPAIR_H
#define CORCAST_GROW_REPAIR_H

#include "domain/domain.h"
#include "grow/cco/grid.h"
#include "grow/connection.h"
#include "grow/network.h"

/* Moves bifurcations until every segment is longer than wide and clear of those it shares no node
 * with, vessels counting at rules->thickness times their radii, as far as small moves can bring
 * that about. *left: the number of segments for which it is still not so. Needs a network just
 * refreshed, and its segments in `grid`; leaves right sums, and radii as of the last round of
 * moves. `threads` do not change the result. STATUS_MEMORY. */
MUST_CHECK Status repair_network(Network *net, Grid *grid, const Domain *domain, const Rules *rules,
                                 int threads, size_t *left, Err *err);

/* Moves every bifurcation once to where the target is less, or a part of the way there, if the
 * rules are then kept with 0.15 of the radii to spare. Given segments stay. Needs a network just
 * refreshed, and its segments in `grid`; leaves right sums, and radii as they were. O(depth) a
 * bifurcation. STATUS_MEMORY. */
MUST_CHECK Status relax_network(Network *net, Grid *grid, const Domain *domain, const Rules *rules,
                                Err *err);

#endif
