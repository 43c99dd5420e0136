/* The few vessels that widened more than the rules' reserves allow for are put right. */
#ifndef CORCAST_GROW_REPAIR_H
#define CORCAST_GROW_REPAIR_H

#include "domain/domain.h"
#include "grow/cco/grid.h"
#include "grow/connection.h"
#include "grow/network.h"

/* Moves bifurcations until, at all radii as of the last refresh times rules->thickness,
 * every segment is longer than wide and clear of those it shares no node with, as far as small
 * moves can bring that about. *left: the number of segments for which it is still not so. `grid`
 * holds the segments of `net`. `threads` do not change the result. */
MUST_CHECK Status repair_network(Network *net, Grid *grid, const Domain *domain, const Rules *rules,
                                 int threads, size_t *left, Err *err);

#endif
