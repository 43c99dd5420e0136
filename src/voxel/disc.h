/* Integrals over the intersection of a polygon and a disc. body.c computes from them the volume of
 * a cylinder or a ball in a box.
 *
 * The disc is around the origin. Each function integrates over the triangle of the origin and one
 * edge of the polygon, from p to q. The result is positive if the edge runs counterclockwise around
 * the origin, and negative otherwise. The sum over all edges of the polygon is therefore the
 * integral over the polygon. Private to the module voxel. */
#ifndef CORCAST_VOXEL_DISC_H
#define CORCAST_VOXEL_DISC_H

/* A point of the plane. */
typedef struct DiscPoint {
    double u, v;
} DiscPoint;

/* The integrals of 1, of u and of v over a region. Zero it before the first edge. */
typedef struct DiscIntegrals {
    double one, u, v;
} DiscIntegrals;

/* Adds the integrals over the part of the triangle that is inside the disc of this radius to
 * *part. */
void discintegrals_add(DiscIntegrals *part, DiscPoint p, DiscPoint q, double radius);

/* Returns the integral over the triangle of min(1, (radius / distance)^3). `distance` is the
 * distance of a point of the triangle from the point at height `above` over the origin; `above`
 * must not be 0. */
double ballshade_edge(DiscPoint p, DiscPoint q, double radius, double above);

#endif
