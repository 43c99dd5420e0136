/* Tolls: the rules of room [refine_room.h] as prices, for a detour through trees that break them.
 *
 * While tolls are open, a vessel pays for every mm that it is shorter than wide, and two vessels
 * without a common node for every mm that they are in each other, at the higher of their prices. */
#ifndef CORCAST_GROW_REFINE_TOLL_H
#define CORCAST_GROW_REFINE_TOLL_H

#include "grow/refine/refine_arbor.h"
#include "grow/refine/refine_room.h"

typedef struct Tolls {
    bool open;
    double *price;   /* of each segment, S_root / mm */
    int32_t *broken; /* the segments that broke the rules at the last tolls_raise */
    size_t n_broken;
    uint64_t *seen, count; /* so that each count of tolls comes across a segment once */
} Tolls;

/* Start from (Tolls){0}; ends with tolls_release. */
MUST_CHECK Status tolls_init(Tolls *tolls, size_t segments, Err *err);
void tolls_release(Tolls *tolls);

/* Opens tolls; a mm costs `price` times what S_root is a mm of all vessels. */
void tolls_open(Tolls *tolls, const Arbor *arbor, double price);
/* Brings bookings, by which tolls are counted, to the present radii. */
MUST_CHECK Status tolls_book(Room *room, Arbor *arbor, Err *err);
/* Raises all prices, and most those of the segments that are not clear as of the last room_book. */
void tolls_raise(Tolls *tolls, const Room *room, const Arbor *arbor);

/* What `count` segments pay for themselves and with all others of the tree. 0 while tolls are
 * closed. */
double toll_of(Tolls *tolls, const Room *room, const Arbor *arbor, const int32_t *segment,
               int count);
/* What the three segments at the end of segment i pay, where the present move has put it; books for
 * them. */
double toll_of_fork(Tolls *tolls, const Room *room, Arbor *arbor, int32_t i);

#endif
