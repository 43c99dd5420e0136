/* Where on the tree a new terminal is best connected, and whether there is room. */
#ifndef CORCAST_GROW_PLACE_H
#define CORCAST_GROW_PLACE_H

#include "domain/domain.h"
#include "grow/cco/grid.h"
#include "grow/network.h"

/* What a new connection must keep to. */
typedef struct Rules {
    double thickness;    /* how much of their radii vessels are taken to have, in [0, 1] */
    double least_length; /* mm; segments are at least this long and `thickness` diameters */
    double gap;          /* mm; vessels without a common node are further apart than this */
    double widest;       /* mm; vessels count as no thicker than this */
} Rules;

/* The three segments that a connection makes. */
enum { PROXIMAL, DISTAL, FRESH, PARTS };

/* A way to connect a terminal: `segment` is split at `bifurcation`. */
typedef struct Connection {
    int32_t segment;
    double price; /* growth of S_root, by the segment's sensitivities */
    Vec3 bifurcation;
    double radius[PARTS]; /* mm */
} Connection;

/* The radius of the capsule that stands in the grid for a vessel of `radius`: with room to widen
 * until the grid is made anew. */
double place_reach(const Rules *rules, double radius);

/* One of the segments that a connection makes, as it enters the grid. */
GridItem place_item(const Network *net, const Grid *grid, const Rules *rules,
                    const Connection *connection, Vec3 terminal, int part);

/* Enters a segment of the tree, unless it has no length: others begin and end there. */
MUST_CHECK Status place_enter(Grid *grid, const Rules *rules, const Network *net, int32_t segment,
                              Err *err);
/* Enters it anew, after it moved or widened. */
MUST_CHECK Status place_enter_again(Grid *grid, const Rules *rules, const Network *net,
                                    int32_t segment, Err *err);
/* Brings all radii in the grid up to date with the network's. */
MUST_CHECK Status place_widen(Grid *grid, const Rules *rules, const Network *net, Err *err);

/* Whether a segment is long enough to become two that are longer than wide, or need not be. */
bool place_is_splittable(const Network *net, const Grid *grid, const Rules *rules, int32_t segment);

/* A connection of `terminal` to `segment` that is good and, to first order, priced; its radii are
 * not set. False when there is none. */
bool place_connection(const Network *net, const Rules *rules, int32_t segment, Vec3 terminal,
                      Connection *out);

/* Finds the best bifurcation, the price and the radii to the end. False when a segment would be too
 * short. */
bool place_settle(const Network *net, const Rules *rules, Vec3 terminal, Connection *connection);

/* Whether the three segments are inside the domain, those of a given one wherever that is; in a
 * convex domain they are when the bifurcation is. */
bool place_is_inside(const Network *net, const Domain *domain, const Connection *connection,
                     Vec3 terminal);

/* Whether the segments of a settled connection that are not given keep clear of all others. */
typedef enum PlaceRoom {
    PLACE_FREE,
    PLACE_TAKEN,
    PLACE_BEYOND, /* they, or the one that they replace, are not all in the zone */
} PlaceRoom;
PlaceRoom place_room(const Network *net, const Grid *grid, const Rules *rules, Box zone,
                     const Connection *connection, Vec3 terminal);

#endif
