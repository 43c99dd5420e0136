/* Where on the tree a new terminal is best connected, and whether there is room. */
#ifndef CORCAST_GROW_PLACE_H
#define CORCAST_GROW_PLACE_H

#include "domain/domain.h"
#include "grow/grid.h"
#include "grow/network.h"

/* What a new connection must keep to. */
typedef struct Rules {
    double thickness;    /* how much of their radii vessels are taken to have, in [0, 1] */
    double least_length; /* mm; segments are at least this long and `thickness` diameters */
    double gap;          /* mm; vessels without a common node are further apart than this */
} Rules;

/* A way to connect a terminal: `segment` is split at `bifurcation`. */
typedef struct Connection {
    int32_t segment;
    double price; /* growth of S_root, by the segment's sensitivities */
    Vec3 bifurcation;
    double radius[3]; /* mm, of the proximal, the distal and the new segment */
} Connection;

/* Whether `point` lies in a vessel. */
bool place_is_in_vessel(const Network *net, const Grid *grid, const Rules *rules, Vec3 point);

/* The cheapest connection of `terminal` to `segment` that keeps to the length rule. False when
 * there is none. */
bool place_connection(const Network *net, const Rules *rules, int32_t segment, Vec3 terminal,
                      Connection *out);

/* Whether the three segments are inside the domain; in a convex one they are when the bifurcation is. */
bool place_is_inside(const Network *net, const Domain *domain, const Connection *connection,
                     Vec3 terminal);

/* Whether the three segments keep clear of all others. */
bool place_is_free(const Network *net, const Grid *grid, const Rules *rules,
                   const Connection *connection, Vec3 terminal);

/* Squared distance of two straight segments of positive length [Ericson, Real-Time Collision
 * Detection, 2005, sec. 5.1.9]. */
double segment_distance2(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1);

#endif
