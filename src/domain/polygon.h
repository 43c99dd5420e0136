/* A polygon of one or more closed rings, as its edges. A point is inside if it is enclosed by an
 * odd number of rings. Private to the module domain. */
#ifndef CORCAST_DOMAIN_POLYGON_H
#define CORCAST_DOMAIN_POLYGON_H

#include "domain/domain.h"

/* A straight edge of a ring. */
typedef struct Edge {
    Vec3 a, b;   /* its two ends, mm, in the plane z = 0 */
    size_t next; /* index of the edge that begins at `b` */
    size_t line; /* line of the file that states `a`, from 1 */
} Edge;

/* The edges, ring after ring, in order along each ring. */
struct Polygon {
    Edge *edges; /* owned */
    size_t n, capacity;
    BoxTree tree; /* over the edges; owned */
};

/* Reads the rings of a file into a zeroed polygon. Does not build polygon->tree. The domain owns
 * the polygon and releases it, also after an error.
 *
 * mm       length of a unit of the file, mm.
 * Errors   STATUS_INPUT with the name of the file and the line; STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status polygon_read(Polygon *polygon, const char *path, double mm, Err *err);

/* Checks that no edges cross, touch or overlap, except neighbours at their common end.
 * polygon->tree must be built. Errors: STATUS_INPUT, with two lines of the file `path`. */
MUST_CHECK Status polygon_check_crossings(const Polygon *polygon, const char *path, Err *err);

/* Returns twice the signed area of the triangle a, b, c in the plane, mm^2: above 0 if its corners
 * are in counter-clockwise order. */
double polygon_twice_area(Vec3 a, Vec3 b, Vec3 c);

#endif
