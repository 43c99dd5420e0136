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
    uint32_t *shell;     /* per triangle: its shell, as soup_find_shells numbers them; owned */
    size_t n;
    BoxTree tree; /* over the triangles; owned */
};

/* Reads domain->file, each unit of it `mm`, and fills mesh, dimension, bounds, volume and inlet.
 * STATUS_INPUT for what is no closed surface. */
MUST_CHECK Status mesh_read(Domain *domain, double mm, Err *err);
void mesh_release(Domain *domain);

/* Returns how often the surface, whose bounds these are, winds round the point: 0 outside, 1
 * inside, 2 where two shells overlap. The point is in the domain when the number is above 0. */
int mesh_winding(const Mesh *mesh, const Box *bounds, Vec3 point);
/* The squared distance of a point from a triangle, mm^2. */
double mesh_distance2(const Triangle *triangle, Vec3 point);

/* Triangles as a file holds them: three corners each, nothing shared. */
typedef struct Soup {
    Vec3 *corners; /* owned */
    size_t n, capacity;
    uint32_t *shell; /* per triangle, once soup_find_shells has found it; owned */
} Soup;

/* Reads a file that ends in .stl (binary or ASCII) or .obj, each unit of it `mm`, into an empty
 * soup; faces of more than three corners are cut into triangles. STATUS_INPUT naming the file and,
 * of a text, the line. The caller frees the corners, also on failure. */
MUST_CHECK Status soup_read(Soup *soup, const char *path, double mm, Err *err);

/* Leaves out triangles that repeat another one, corner by corner and the same way round, and finds
 * the shells of the others: triangles that hang together by their edges. Fills soup->shell with
 * numbers from 0 to *n_shells - 1.
 *
 * Corners are the same when their coordinates are equal. Triangles with two equal corners are
 * allowed; they bound nothing.
 *
 * Errors   STATUS_INPUT, naming `path` and how many edges are wrong, unless each edge has as many
 *          triangles that run along it one way as the other: then the surface is closed and its
 *          sides agree. STATUS_MEMORY.
 * Cost     O(n log n). */
MUST_CHECK Status soup_find_shells(Soup *soup, const char *path, size_t *n_shells, Err *err);

#endif
