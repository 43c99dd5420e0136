/* A domain bounded by a closed surface of triangles, and the reader of its file. Private to the
 * module domain.
 *
 * soup_read reads triangles without shared vertices (a triangle soup). soup_find_shells checks that
 * they form closed surfaces. mesh_read calls both, and builds the domain. */
#ifndef CORCAST_DOMAIN_MESH_H
#define CORCAST_DOMAIN_MESH_H

#include "domain/domain.h"

/* A triangle with the corners a, a + ab and a + ac, in mm, counter-clockwise as seen
 * from outside. */
typedef struct Triangle {
    Vec3 a, ab, ac;
} Triangle;

struct Mesh {
    Triangle *triangles; /* owned */
    uint32_t *shell;     /* per triangle: its shell, as soup_find_shells numbers them; owned */
    size_t n;
    BoxTree tree; /* over the triangles; owned */
};

/* Reads the mesh file domain->file, and sets mesh, dimension, bounds, volume and inlet of the
 * domain. The caller releases domain->mesh with mesh_release, also after an error.
 *
 * mm       length of a unit of the file, mm.
 * Errors   STATUS_INPUT if the file is malformed, or its triangles are not a closed surface;
 *          STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status mesh_read(Domain *domain, double mm, Err *err);
/* Frees domain->mesh. NULL is allowed. */
void mesh_release(Domain *domain);

/* Returns the winding number of the surface around the point: 0 outside, 1 inside, 2 where two
 * shells overlap. The point is in the domain if the number is above 0. The number is 0 in
 * a cavity, because the cavity's shell is oriented inwards. A point on the surface may get the
 * number of either side. `bounds` is the bounding box of the mesh. */
int mesh_winding(const Mesh *mesh, const Box *bounds, Vec3 point);
/* Returns the squared distance of a point from a triangle, mm^2. */
double mesh_distance2(const Triangle *triangle, Vec3 point);

/* Triangles without shared corners: corners 3 i, 3 i + 1 and 3 i + 2 are triangle i. */
typedef struct Soup {
    Vec3 *corners;      /* mm; owned */
    size_t n, capacity; /* number of corners, 3 per triangle, and number that the array can hold */
    uint32_t *shell;    /* per triangle: its shell, set by soup_find_shells; owned */
} Soup;

/* Reads a file whose name ends in .stl (binary or ASCII) or .obj. Faces with more than three
 * corners are cut into triangles.
 *
 * soup     is empty before. The caller frees its arrays with free(), also after an error.
 * mm       length of a unit of the file, mm.
 * Errors   STATUS_INPUT if the file is missing or malformed, with the name of the file and, for a
 *          text, the line; STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status soup_read(Soup *soup, const char *path, double mm, Err *err);

/* Removes triangles that repeat another triangle with the same orientation, and finds the shells:
 * sets of triangles that are connected by edges. Sets soup->shell to the index of each triangle's
 * shell, from 0 to *n_shells - 1.
 *
 * Two corners are the same vertex if their coordinates are equal. Degenerate triangles, with two
 * equal corners, are allowed: they stay in the soup, and their edges are not counted.
 *
 * path     the name of the file, for errors.
 * Errors   STATUS_INPUT, with `path` and the number of wrong edges, if the surface is not closed or
 *          its orientation is inconsistent: an edge must be used by equally many triangles in both
 *          directions. STATUS_MEMORY.
 * Cost     O(n log n). */
MUST_CHECK Status soup_find_shells(Soup *soup, const char *path, size_t *n_shells, Err *err);

#endif
