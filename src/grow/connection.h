/* Where on the tree a new terminal is best connected, and whether there is room. */
#ifndef CORCAST_GROW_CONNECTION_H
#define CORCAST_GROW_CONNECTION_H

#include "domain/domain.h"
#include "grow/cco/bifurcation.h"
#include "grow/network.h"
#include "grow/network_grid.h"

/* The three segments that a connection makes. */
enum {
    PROXIMAL = BIFURCATION_PROXIMAL,
    DISTAL = BIFURCATION_LEFT,
    FRESH = BIFURCATION_RIGHT,
    PARTS = BIFURCATION_ENDS
};

/* A way to connect a terminal: `segment` is split at `bifurcation`. */
typedef struct Connection {
    int32_t segment;
    double price; /* growth of S_root, by the segment's sensitivities */
    Vec3 bifurcation;
    double radius[PARTS]; /* mm */
} Connection;

/* One of the segments that a connection makes, as it enters the grid. */
GridItem connection_item(const Network *net, const Grid *grid, const Rules *rules,
                         const Connection *connection, Vec3 terminal, int part);

/* Whether a segment is long enough to become two that are longer than wide, or need not be. */
bool connection_may_split(const Network *net, const Grid *grid, const Rules *rules,
                          int32_t segment);

/* A connection of `terminal` to `segment` that is good and, to first order, priced; its radii are
 * not set. False when there is none. */
bool connection_estimate(const Network *net, const Rules *rules, int32_t segment, Vec3 terminal,
                         Connection *out);

/* Finds the best bifurcation, the price and the radii to the end. False when a segment would be too
 * short. */
bool connection_optimise(const Network *net, const Rules *rules, Vec3 terminal,
                         Connection *connection);

/* Whether the three segments are inside the domain, those of a given one wherever that is; in a
 * convex domain they are when the bifurcation is. */
bool connection_is_inside(const Network *net, const Domain *domain, const Connection *connection,
                          Vec3 terminal);

/* Whether the segments of a settled connection that are not given keep clear of all others. */
typedef enum ConnectionClearance {
    CONNECTION_CLEAR,
    CONNECTION_BLOCKED,
    CONNECTION_BEYOND, /* they, or the one that they replace, are not all in the zone */
} ConnectionClearance;
ConnectionClearance connection_clearance(const Network *net, const Grid *grid, const Rules *rules,
                                         Box zone, const Connection *connection, Vec3 terminal);

#endif
