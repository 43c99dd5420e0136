/* A closed surface of triangles; private to the room domain. */
#ifndef CORCAST_DOMAIN_MESH_H
#define CORCAST_DOMAIN_MESH_H

#include "domain/domain.h"

/* Corners a, a + ab, a + ac, counter-clockwise seen from outside. */
typedef struct Triangle {
    Vec3 a, ab, ac;
} Triangle;

struct Mesh {
    Triangle *triangles; /* owned */
    size_t n;
    BoxTree tree; /* over the triangles; owned */
};

/* Reads domain->file, each unit of it `mm`, and fills mesh, dimension, bounds, volume and inlet.
 * STATUS_INPUT for what is no closed surface. */
MUST_CHECK Status mesh_read(Domain *domain, double mm, Err *err);
void mesh_release(Domain *domain);

/* Whether the point is inside the surface, whose bounds these are. */
bool mesh_is_odd(const Mesh *mesh, const Box *bounds, Vec3 point);
/* The squared distance of a point from a triangle, mm^2. */
double mesh_distance2(const Triangle *triangle, Vec3 point);

/* Triangles as a file holds them: three corners each, nothing shared. */
typedef struct Soup {
    Vec3 *corners; /* owned */
    size_t n, capacity;
} Soup;

/* Reads a file that ends in .stl (binary or ASCII) or .obj, each unit of it `mm`, into an empty
 * soup; faces of more than three corners are cut into triangles. STATUS_INPUT naming the file and,
 * of a text, the line. The caller frees the corners, also on failure. */
MUST_CHECK Status soup_read(Soup *soup, const char *path, double mm, Err *err);

/* STATUS_INPUT, naming `path` and how many edges are wrong, unless each edge has as many triangles
 * that run along it one way as the other: then the surface is closed and its sides agree.
 * Corners are the same when their coordinates are equal; triangles with two such are no matter. */
MUST_CHECK Status soup_check_closed(const Soup *soup, const char *path, Err *err);

#endif
