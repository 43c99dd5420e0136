/* Adds the first segment of every tree: the root segment from the inlet to the first terminal. */
#ifndef CORCAST_GROW_FIRST_SEGMENTS_H
#define CORCAST_GROW_FIRST_SEGMENTS_H

#include "grow/site.h"

/* State of the random search for the ends of root segments. */
typedef struct FirstTosses {
    Random *random;
    double distance; /* mm; how far a point must be from its inlet at first */
    uint64_t count;  /* number of points drawn */
} FirstTosses;

/* Gives each inlet its root segment; the network holds nothing but inlets.
 *
 * A root segment is in the domain and leads to a random point that is nearer to this inlet than to
 * any other, and about as far from it as points of the domain are. Root segments keep clear of each
 * other, and trees apart as the rules say. If terminals are paired, the second tree's point is a
 * mate of the first tree's, and neither has to be nearer to its inlet.
 *
 * Leaves right sums, and no radii.
 *
 * tosses   `distance` becomes the minimum distance that was required in the end; `count` increases.
 * Errors   STATUS_INFEASIBLE if there is no such point. */
MUST_CHECK Status first_segments_add(Site *site, FirstTosses *tosses, Err *err);

#endif
