/* Integrals over what a disc and a polygon have in common; private to the room voxel. */
#ifndef CORCAST_VOXEL_DISC_H
#define CORCAST_VOXEL_DISC_H

typedef struct DiscPoint {
    double u, v;
} DiscPoint;

/* The integrals of 1, u and v. */
typedef struct DiscPart {
    double one, u, v;
} DiscPart;

/* Adds what lies between the edge from p to q, the origin and, beyond `radius` from it, the circle;
 * signed, above 0 where the edge runs counterclockwise about the origin. The sum over the edges of
 * a polygon is the integral over its part in the disc of that radius about the origin. */
void discpart_add(DiscPart *part, DiscPoint p, DiscPoint q, double radius);

#endif
