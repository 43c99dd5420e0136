/* Integrals over a polygon of the plane, from which body.c computes the volume of a cylinder
 * (discintegrals_add) or of a ball (ballcone_edge) in a box.
 *
 * Call a function for each edge of the polygon, from p to q. It integrates over the triangle that
 * the origin forms with the edge. The triangle counts positive if the edge runs counterclockwise
 * around the origin, else negative. The sum over all edges is therefore the integral over the
 * polygon. All lengths have the same unit. Private to the module voxel. */
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

/* Adds to *part the integrals over the part of the triangle that is inside the disc of this radius
 * around the origin. */
void discintegrals_add(DiscIntegrals *part, DiscPoint p, DiscPoint q, double radius);

/* Returns the integral over the triangle of min(1, (radius / distance)^3), where `distance` is the
 * distance of a point of the triangle from the apex: the point at the distance `above`, not 0, from
 * the origin, perpendicular to the plane. Times `above` / 3, this is the volume that the cone from
 * the apex to the triangle shares with the ball of this radius around the apex. */
double ballcone_edge(DiscPoint p, DiscPoint q, double radius, double above);

#endif
