/* The edges of a polygon; private to the room domain. */
#ifndef CORCAST_DOMAIN_POLYGON_H
#define CORCAST_DOMAIN_POLYGON_H

#include "domain/domain.h"

typedef struct Edge {
    Vec3 a, b;   /* in the plane z = 0 */
    size_t next; /* the edge that begins at `b` */
    size_t line; /* of `a` in the file */
} Edge;

/* The edges of each ring stand together, in order. */
struct Polygon {
    Edge *edges; /* owned */
    size_t n, capacity;
    BoxTree tree; /* over the edges; owned */
};

/* Reads the rings of `path`, each unit of it `mm`, into a zeroed polygon; builds no tree.
 * STATUS_INPUT naming file and line. */
MUST_CHECK Status polygon_read(Polygon *polygon, const char *path, double mm, Err *err);

/* STATUS_INPUT, naming two lines of `path`, when edges cross, touch or lie on each other. */
MUST_CHECK Status polygon_check_crossings(const Polygon *polygon, const char *path, Err *err);

/* Twice the signed area of the triangle a b c: positive when it is counter-clockwise. */
double polygon_turn(Vec3 a, Vec3 b, Vec3 c);

#endif
