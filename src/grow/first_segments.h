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

/* Adds a root segment at each inlet. The network holds only inlets before the call.
 *
 * A root segment is in the domain and leads to a random point that is nearer to this inlet than to
 * any other inlet. The point is about as far from the inlet as points of the domain can be. Root
 * segments keep clear of each other, and root segments of different trees keep rules.apart
 * [site.h]. If terminals are paired, the point of the second tree is a mate [mates.h] of the first
 * tree's point, and no point has to be nearest to its inlet.
 *
 * Leaves exact sums [network.h], and no radii.
 *
 * tosses   `distance` becomes the minimum distance that was required in the end; `count` increases.
 * Errors   STATUS_INFEASIBLE if no such point was found in 20,000 attempts for an inlet. */
MUST_CHECK Status first_segments_add(Site *site, FirstTosses *tosses, Err *err);

#endif
