/* Moves bifurcations while a tree grows, for two reasons: to repair the few vessels that
 * have come to touch others or to be wider than long (repair_network), and to lower the
 * target (relax_network).
 *
 * The rules are that every segment is longer than wide, and clear of all segments with which it
 * shares no node. A vessel counts with rules.thickness [site.h] times its radius. A tree that
 * breaks a rule is still a valid tree. */
#ifndef CORCAST_GROW_REPAIR_H
#define CORCAST_GROW_REPAIR_H

#include "grow/site.h"

/* Moves the bifurcations at the ends of segments that break a rule, in up to 6 rounds. Moves
 * nothing if more than one segment in 20 breaks a rule, because small moves do not help then. Call
 * it right after network_refresh. Leaves exact sums [network.h], and the radii of the last round of
 * moves.
 *
 * left     receives the number of segments that still break a rule; undefined after an error.
 * Errors   STATUS_MEMORY; the site is then only fit to be released.
 * Threads  The result does not depend on `threads`. */
MUST_CHECK Status repair_network(Site *site, int threads, size_t *left, Err *err);

/* Moves every bifurcation once towards the position with the lowest target, by the whole distance,
 * a half or a quarter of it. A bifurcation moves only if the rules hold afterwards with radii that
 * are 15 % larger, because radii still grow. Given segments [network.h] stay. Call it right after
 * network_refresh. Leaves exact sums, and does not update radii. Errors: STATUS_MEMORY. Cost:
 * O(depth) per bifurcation. */
MUST_CHECK Status relax_network(Site *site, Err *err);

#endif
