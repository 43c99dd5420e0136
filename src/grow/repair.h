/* Moves bifurcations while a tree grows, for two reasons: to repair the few vessels that
 * have come to touch others or to be wider than long (repair_network), and to lower the
 * target (relax_network).
 *
 * The rules [site.h] are: every segment is longer than wide, and clear of all segments with which
 * it shares no node. */
#ifndef CORCAST_GROW_REPAIR_H
#define CORCAST_GROW_REPAIR_H

#include "grow/site.h"

/* Moves bifurcations until every segment is longer than wide and clear of those it shares no node
 * with, as far as small moves can bring that about. Vessels count at rules.thickness times their
 * radii. Needs a network that was just refreshed. Leaves right sums, and radii as of the last round
 * of moves.
 *
 * left     receives the number of segments that still break a rule.
 * Errors   STATUS_MEMORY.
 * Threads  The result does not depend on `threads`. */
MUST_CHECK Status repair_network(Site *site, int threads, size_t *left, Err *err);

/* Moves every bifurcation once to where the target is lower, or a part of the way there, if the
 * rules are then kept with 0.15 of the radii to spare. Given segments stay. Needs a network that
 * was just refreshed. Leaves right sums, and radii as they were. Errors: STATUS_MEMORY. Cost:
 * O(depth) per bifurcation. */
MUST_CHECK Status relax_network(Site *site, Err *err);

#endif
