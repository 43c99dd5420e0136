/* A closed solid that is put together from surfaces: proved ones, whose flat ends are opened, and
 * what joins the rims. */
#ifndef CORCAST_PRINT_SOLID_H
#define CORCAST_PRINT_SOLID_H

#include "mesh/mesh.h"

/* A flat end of a surface: a disc of `n` triangles that follow each other, about one point. */
typedef struct CutEnd {
    uint32_t segment;
    int end;        /* of the segment, 0 or 1 */
    uint32_t first; /* triangle */
    uint32_t n;
    bool opened;   /* left out of the solid */
    uint32_t *rim; /* in a solid: its points there, by rising angle about the segment's axis */
} CutEnd;

typedef struct CutEnds {
    CutEnd *items; /* owned; by rising segments and ends */
    size_t n;
    uint32_t *rims; /* owned: what the items point into */
} CutEnds;

/* Lists the flat ends of a mesh of vesselmesh_build. O(triangles). */
MUST_CHECK Status cutends_find(const VesselMesh *mesh, CutEnds *out, Err *err);
void cutends_release(CutEnds *ends);
/* The end of this segment, or NULL. O(log n). */
CutEnd *cutends_at(const CutEnds *ends, uint32_t segment, int end);

/* Zeroed before the first use but for the grid. */
typedef struct Solid {
    VesselMesh mesh;
    double grid_mm; /* points lie on its multiples */
    size_t point_capacity, normal_capacity, triangle_capacity, label_capacity;
} Solid;

void solid_release(Solid *solid);

MUST_CHECK Status solid_point(Solid *solid, Vec3 x, Vec3 normal, uint32_t *number, Err *err);
/* Counterclockwise seen from outside. */
MUST_CHECK Status solid_triangle(Solid *solid, uint32_t a, uint32_t b, uint32_t c, uint32_t label,
                                 Err *err);
/* Adds a surface without the ends that are opened, `flags` set in its labels, with its inside
 * outside if it is `turned`; fills the ends' rims. */
MUST_CHECK Status solid_surface(Solid *solid, const VesselMesh *mesh, CutEnds *ends, bool turned,
                                uint32_t flags, Err *err);
/* Joins two rings of n points by 2 n triangles: seen from outside, `next` lies to the left of the
 * way along `ring`. */
MUST_CHECK Status solid_ring(Solid *solid, const uint32_t *ring, const uint32_t *next, uint32_t n,
                             uint32_t label, Err *err);

#endif
