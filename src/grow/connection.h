/* Connections of a new terminal to a segment: their position and price, and tests whether they keep
 * the rules.
 *
 * A connection splits a segment at a new bifurcation. A new segment leads from the bifurcation to
 * the terminal. Its price is the increase of the target function [grow.h], divided by a constant
 * that all connections share: the increase of S_root [law.h]. All functions read a Site [site.h]:
 * the growing tree (network), its spatial index (grid), the domain, and the rules of length and
 * distance.
 *
 * The planner [plan.h] calls connection_may_split and connection_estimate for each nearby segment.
 * It then takes the connections in the order of their estimated prices: it calls
 * connection_optimise, connection_project if the domain is a surface, connection_is_inside, and
 * connection_clearance. */
#ifndef CORCAST_GROW_CONNECTION_H
#define CORCAST_GROW_CONNECTION_H

#include "grow/cco/bifurcation.h"
#include "grow/site.h"

/* The three segments of a connection. PROXIMAL [bifurcation.h] leads to the bifurcation, DISTAL is
 * the other part of the split segment, and FRESH leads to the new terminal. */
enum { DISTAL = LEFT, FRESH = RIGHT };

/* A connection. */
typedef struct Connection {
    Vec3 terminal;       /* position of the new terminal, mm */
    int32_t segment;     /* index of the segment that is split */
    double price;        /* increase of S_root, to first order */
    Vec3 bifurcation;    /* position of the new bifurcation, mm */
    double radius[ENDS]; /* of PROXIMAL, DISTAL and FRESH, mm; set by connection_optimise */
} Connection;

/* Returns true if a segment is long enough to be split into two segments that keep the rules. Uses
 * the copy of the segment's radius in the grid. Two kinds of segments of a continued tree may
 * always be split: one of several segments of a vessel [Trait.piece], and a segment that keeps its
 * radius [Trunk]. */
bool connection_may_split(const Site *site, int32_t segment);

/* Estimates the bifurcation and the price of a connection of `terminal`, mm, to `segment`. Requires
 * the segment's sums over its subtree, and its radii, of the last network_refresh [network.h].
 *
 * out      receives the connection, except `radius`.
 * Returns  false if a position or the price is not finite; *out is then undefined.
 * Cost     O(1). */
bool connection_estimate(const Site *site, int32_t segment, Vec3 terminal, Connection *out);

/* Finds the best bifurcation of an estimated connection, and sets its price and the three radii.
 * The sums and radii of the segment must still be those of connection_estimate. Returns false if
 * one of the three segments is shorter than the rules allow [Rules]; the connection must then not
 * be used. Cost: O(1). */
bool connection_optimise(const Site *site, Connection *connection);

/* Moves the bifurcation of an optimised connection onto the middle surface of the domain, which
 * must have a projection [domain_has_projection]. A bifurcation on a given segment [Trait.given]
 * does not move. Returns false if one of the three segments is then shorter than the rules allow.
 */
bool connection_project(const Site *site, Connection *connection);

/* Returns true if the three segments of an optimised connection are in the domain. The two parts of
 * a given segment may be outside the domain. */
bool connection_is_inside(const Site *site, const Connection *connection);

/* The result of connection_clearance. */
typedef enum ConnectionClearance {
    CONNECTION_CLEAR,    /* the connection keeps the minimum distances of the rules */
    CONNECTION_BLOCKED,  /* another segment is too near */
    CONNECTION_UNDECIDED /* the decision needs grid cells outside the zone */
} ConnectionClearance;

/* Tests whether the three segments of an optimised connection keep the minimum distances [Rules]
 * from all other segments in the grid. The two parts of a given segment are not tested, because
 * they are part of the tree already. Searches no grid cell outside the box `zone`, mm. */
ConnectionClearance connection_clearance(const Site *site, Box zone, const Connection *connection);

/* Returns true if the segments of two connections, to different trees, keep the minimum distances
 * from each other. The two terminals are a pair [mates.h]. */
bool connections_are_clear(const Site *site, const Connection connection[2]);

/* Returns the grid's item for one of the three segments (PROXIMAL, DISTAL or FRESH) that an
 * optimised connection makes. */
GridItem connection_item(const Site *site, const Connection *connection, int part);

#endif
