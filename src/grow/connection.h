/* Where on the tree a new terminal is best connected, and whether there is room. */
#ifndef CORCAST_GROW_CONNECTION_H
#define CORCAST_GROW_CONNECTION_H

#include "domain/domain.h"
#include "grow/cco/bifurcation.h"
#include "grow/network.h"
#include "grow/network_grid.h"

/* The segments that a connection makes beside the PROXIMAL one [bifurcation.h]. */
enum { DISTAL = LEFT, FRESH = RIGHT };

/* A way to connect a terminal: `segment` is split at `bifurcation`. By connection_estimate, price
 * and bifurcation are first guesses and the radii are not set; by connection_optimise all are
 * final. */
typedef struct Connection {
    int32_t segment;
    double price; /* the increase of S_root [law.h], to first order */
    Vec3 bifurcation;
    double radius[ENDS]; /* mm */
} Connection;

/* The item [grid.h] of one of the three segments (PROXIMAL, DISTAL or FRESH) that an optimised
 * connection makes. */
GridItem connection_item(const Network *net, const Grid *grid, const Rules *rules,
                         const Connection *connection, Vec3 terminal, int part);

/* Whether a segment is long enough to be split into two that are longer than wide, with the radius
 * that the grid has of it. A piece of a given vessel, and a segment that keeps its radius, may
 * always be split. */
bool connection_may_split(const Network *net, const Grid *grid, const Rules *rules,
                          int32_t segment);

/* Finds a good bifurcation for connecting `terminal`, mm, to `segment`, and its price, in *out.
 * Needs the segment's sums, gauge and sensitivity as of the last refresh. False when a figure is
 * not finite. O(1). */
bool connection_estimate(const Network *net, const Rules *rules, int32_t segment, Vec3 terminal,
                         Connection *out);

/* Finds the best bifurcation for an estimated connection, its price and the three radii. Needs the
 * same. False when one of the three segments would be shorter than the rules allow. O(1). */
bool connection_optimise(const Network *net, const Rules *rules, Vec3 terminal,
                         Connection *connection);

/* Of a domain that is a surface: moves the bifurcation of an optimised connection onto it; one on a
 * given segment stays. False when a segment then is shorter than the rules allow. */
bool connection_settle(const Network *net, const Rules *rules, const Domain *domain, Vec3 terminal,
                       Connection *connection);

/* Whether the three segments of an optimised connection lie in the domain. In a convex domain they
 * do when the bifurcation does; the two parts of a given segment may lie anywhere. */
bool connection_is_inside(const Network *net, const Domain *domain, const Connection *connection,
                          Vec3 terminal);

typedef enum ConnectionClearance {
    CONNECTION_CLEAR,
    CONNECTION_BLOCKED, /* another segment is in the way */
    CONNECTION_BEYOND,  /* undecided, because that needs cells outside the zone */
} ConnectionClearance;

/* Whether the three segments of an optimised connection keep clear of all others in the grid, but
 * for those of a given segment, which stays where it is. Looks at nothing outside `zone`. */
ConnectionClearance connection_clearance(const Network *net, const Grid *grid, const Rules *rules,
                                         Box zone, const Connection *connection, Vec3 terminal);

/* Whether the segments of two connections, of different trees, keep clear of each other; the new
 * ones, which end in terminal[0] and terminal[1], mm, are then those of a pair. */
bool connections_are_clear(const Network *net, const Rules *rules, const Connection connection[2],
                           const Vec3 terminal[2]);

#endif
