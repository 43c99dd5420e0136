/* Connections: where a new terminal is best connected to the tree, and whether there is room
 * for it.
 *
 * A connection splits a segment at a new bifurcation, from which a new segment leads to the
 * terminal. The planner [plan.h] first estimates the price of a connection to each candidate
 * segment. It then takes the connections cheapest first: it optimises the bifurcation, and tests
 * whether the three segments are inside the domain and clear of all other segments. */
#ifndef CORCAST_GROW_CONNECTION_H
#define CORCAST_GROW_CONNECTION_H

#include "grow/cco/bifurcation.h"
#include "grow/site.h"

/* The three segments of a connection: PROXIMAL [bifurcation.h] leads to the bifurcation, DISTAL is
 * the other part of the split segment, and FRESH leads to the new terminal. */
enum { DISTAL = LEFT, FRESH = RIGHT };

/* A connection of `terminal`: the segment with the index `segment` is split at `bifurcation`. */
typedef struct Connection {
    Vec3 terminal; /* mm */
    int32_t segment;
    double price; /* first-order estimate of the increase of S_root, the tree's target without the
                   * factor q^lambda [law.h] */
    Vec3 bifurcation;    /* mm */
    double radius[ENDS]; /* of PROXIMAL, DISTAL and FRESH, mm; set by connection_optimise */
} Connection;

/* Returns true if a segment is long enough to be split into two segments that are longer than wide,
 * with the radius that the grid has of the segment. A piece of a given vessel, and a segment that
 * keeps its radius, may always be split. */
bool connection_may_split(const Site *site, int32_t segment);

/* Estimates a good bifurcation for the connection of `terminal`, mm, to `segment`, and its price.
 * Requires the segment's sums, gauge and sensitivity of the last network_refresh.
 *
 * out      receives the connection, without radii.
 * Returns  false if a number is not finite; *out is then undefined.
 * Cost     O(1). */
bool connection_estimate(const Site *site, int32_t segment, Vec3 terminal, Connection *out);

/* Finds the best bifurcation of an estimated connection, its price and the three radii. Requires
 * what connection_estimate requires. Returns false if one of the three segments would be shorter
 * than the rules [Rules] allow; the connection may then not be used. Cost: O(1). */
bool connection_optimise(const Site *site, Connection *connection);

/* Moves the bifurcation of an optimised connection onto the surface in the middle of the domain,
 * which must have a projection [domain_has_projection]. A bifurcation on a given segment stays.
 * Returns false if a segment then is shorter than the rules allow. */
bool connection_project(const Site *site, Connection *connection);

/* Returns true if the three segments of an optimised connection are in the domain. In a convex
 * domain this is so if the bifurcation is in the domain. The two parts of a given segment
 * [network.h] may be outside. */
bool connection_is_inside(const Site *site, const Connection *connection);

typedef enum ConnectionClearance {
    CONNECTION_CLEAR,
    CONNECTION_BLOCKED, /* another segment is in the way */
    CONNECTION_BEYOND   /* undecided, because cells outside the zone would have to be searched */
} ConnectionClearance;

/* Tests whether the three segments of an optimised connection keep clear of all other segments in
 * the grid. The two parts of a given segment are not tested, because they stay where they are.
 * Searches no cell outside `zone`. */
ConnectionClearance connection_clearance(const Site *site, Box zone, const Connection *connection);

/* Returns true if the segments of two connections of different trees keep clear of each other. The
 * two terminals are a pair. */
bool connections_are_clear(const Site *site, const Connection connection[2]);

/* Returns the grid's item for one of the three segments (PROXIMAL, DISTAL or FRESH) that an
 * optimised connection makes. */
GridItem connection_item(const Site *site, const Connection *connection, int part);

#endif
