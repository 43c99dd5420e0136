/* Adds the first segment of every tree: the root segment, from the inlet to a random first
 * terminal. Growth then connects all other terminals [round.h]. */
#ifndef CORCAST_GROW_FIRST_SEGMENTS_H
#define CORCAST_GROW_FIRST_SEGMENTS_H

#include "grow/site.h"

/* State of the random search for the ends of root segments. A toss is a random point that is
 * drawn. */
typedef struct FirstTosses {
    Random *random;  /* borrowed */
    double distance; /* minimum distance of a point from its inlet at the start of the search, mm;
                      * the search lowers it */
    uint64_t count;  /* number of points drawn so far */
} FirstTosses;

/* Adds a root segment at each inlet. The network holds only inlets before the call.
 *
 * A root segment is in the domain. Its end is a random point that is nearer to this inlet than to
 * any other inlet, and about as far from the inlet as points of the domain can be. The walls of
 * root segments are at least rules.tree_gap [site.h] apart. If terminals are paired, the end of the
 * second root segment is a mate [mates.h] of the end of the first. In this case either end may be
 * nearer to another inlet than to its own.
 *
 * Afterwards the sums of the network are exact, and its radii are not set [network.h].
 *
 * tosses   `distance` receives the minimum distance at the end of the search; `count` increases.
 * Errors   STATUS_INFEASIBLE if no such point was found in 20,000 attempts for an inlet. */
MUST_CHECK Status first_segments_add(Site *site, FirstTosses *tosses, Err *err);

#endif
