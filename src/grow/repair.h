/* Moves bifurcations of a growing tree, for two reasons: to repair the few vessels that touch
 * others or whose diameter exceeds their length (repair_network), and to lower the objective
 * function of the growth (relax_network).
 *
 * The rules are that every segment is longer than its diameter, and does not touch segments with
 * which it shares no node. They apply to radii multiplied by rules.thickness [site.h]. A tree that
 * breaks a rule is still a valid tree. Both functions take a Site [site.h]: the tree, the domain,
 * the rules, and the grid that finds neighbours. */
#ifndef CORCAST_GROW_REPAIR_H
#define CORCAST_GROW_REPAIR_H

#include "grow/site.h"

/* Moves the bifurcations at the ends of segments that break a rule, in up to 6 rounds. Moves
 * nothing if more than one segment in 20 breaks a rule, because small moves do not help then. Call
 * it right after network_refresh. Afterwards the network's sums over subtrees [network.h] are
 * exact, and the radii are those after the last round of moves.
 *
 * left     receives the number of segments that still break a rule; undefined after an error.
 * Errors   STATUS_MEMORY; after it the caller may only release the site.
 * Threads  The result does not depend on `threads`. */
MUST_CHECK Status repair_network(Site *site, int threads, size_t *left, Err *err);

/* Moves every bifurcation once towards the position with the lowest value of the objective
 * function, by the whole distance, a half or a quarter of it. A bifurcation moves only if the rules
 * hold afterwards with radii that are 15 % larger, because radii still grow. Segments of a tree
 * that is continued (given segments [network.h]) do not move. Call it right after network_refresh.
 * Afterwards the sums are exact, and the radii are still those of network_refresh. Errors:
 * STATUS_MEMORY; after it the caller may only release the site. Cost: O(depth) per bifurcation. */
MUST_CHECK Status relax_network(Site *site, Err *err);

#endif
