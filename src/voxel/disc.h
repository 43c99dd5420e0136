/* Integrals over the intersection of a disc and a polygon, and over the rest of the polygon. Each
 * function integrates over the triangle of the origin and the edge from p to q of the polygon. The
 * sign is positive if the edge runs counterclockwise around the origin, so that the sum over all
 * edges is the integral over the polygon. Private to the module voxel. */
#ifndef CORCAST_VOXEL_DISC_H
#define CORCAST_VOXEL_DISC_H

typedef struct DiscPoint {
    double u, v;
} DiscPoint;

/* The integrals of 1, u and v. */
typedef struct DiscPart {
    double one, u, v;
} DiscPart;

/* Adds the integrals over the part of the triangle in the disc of `radius` around the origin. */
void discpart_add(DiscPart *part, DiscPoint p, DiscPoint q, double radius);

/* Returns the integral of min(1, (radius / distance)^3), where the distance is measured from a
 * point at height `above`, not 0, over the origin. */
double ballshade_edge(DiscPoint p, DiscPoint q, double radius, double above);

#endif
