/* Integrals over what a disc and a polygon have in common, and over the rest of the polygon;
 * private to the room voxel. Each adds what lies between the edge from p to q of a polygon and the
 * origin, signed, above 0 where the edge runs counterclockwise about it: the sum over the edges is
 * the polygon's. */
#ifndef CORCAST_VOXEL_DISC_H
#define CORCAST_VOXEL_DISC_H

typedef struct DiscPoint {
    double u, v;
} DiscPoint;

/* The integrals of 1, u and v. */
typedef struct DiscPart {
    double one, u, v;
} DiscPart;

/* Over the part of the polygon in the disc of `radius` about the origin. */
void discpart_add(DiscPart *part, DiscPoint p, DiscPoint q, double radius);

/* The integral of min(1, (radius / distance)^3), the distance being that from a point `above` the
 * origin, not 0. */
double ballshade_edge(DiscPoint p, DiscPoint q, double radius, double above);

#endif
