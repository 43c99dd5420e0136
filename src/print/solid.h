/* A closed solid that is assembled from surfaces, each of which meshreport_check accepts.
 *
 * The surfaces are meshes of vesselmesh_build. Their flat ends are discs of triangles. Where an end
 * is opened, its disc is not copied to the solid. The rim of the opened end is then joined to
 * another rim by a ring of triangles, or becomes the edge of a hole in a flat face. After an error
 * the solid is incomplete and may only be released. The calls are: cutends_find, set
 * `opened`, solid_surface, solid_ring and face_fill, solid_release. Private to the module print. */
#ifndef CORCAST_PRINT_SOLID_H
#define CORCAST_PRINT_SOLID_H

#include "mesh/mesh.h"

/* A flat end of a surface: a disc of n consecutive triangles of the mesh around one point. The rim
 * of the disc has n points. */
typedef struct CutEnd {
    uint32_t segment; /* index of the segment */
    int end;          /* the segment's end, 0 or 1 */
    uint32_t first;   /* index of the first triangle */
    uint32_t n;
    bool opened;   /* set by the caller; true: solid_surface leaves out the disc */
    uint32_t *rim; /* the n points of the rim, as indices in the solid, by ascending angle about the
                    * segment's axis; set by solid_surface */
} CutEnd;

/* The flat ends of one mesh. Release it with cutends_release. */
typedef struct CutEnds {
    CutEnd *items; /* owned; by ascending segment, then end */
    size_t n, capacity;
    uint32_t *rims; /* owned; the items point into it */
} CutEnds;

/* Lists the flat ends of a mesh of vesselmesh_build, with `opened` false. Release *out with
 * cutends_release. Errors: STATUS_MEMORY. O(triangles). */
MUST_CHECK Status cutends_find(const VesselMesh *mesh, CutEnds *out, Err *err);
void cutends_release(CutEnds *ends);
/* Returns the flat end of a segment, or NULL if this end is not flat. It is borrowed from `ends`.
 * O(log n). */
CutEnd *cutends_at(const CutEnds *ends, uint32_t segment, int end);

/* The solid while it is assembled. Zero it before first use and set grid_mm; release it with
 * solid_release. */
typedef struct Solid {
    VesselMesh mesh;
    double grid_mm; /* grid step: coordinates are integer multiples of it */
    size_t point_capacity, normal_capacity, triangle_capacity, label_capacity;
} Solid;

void solid_release(Solid *solid);

/* Adds a point, rounded to the grid, with its unit normal, and sets *index to its index. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status solid_point(Solid *solid, Vec3 x, Vec3 normal, uint32_t *index, Err *err);
/* Adds a triangle of three points of the solid, counterclockwise seen from outside. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status solid_triangle(Solid *solid, uint32_t a, uint32_t b, uint32_t c, uint32_t label,
                                 Err *err);

/* How a surface is added to a solid. */
typedef struct SurfaceUse {
    bool turned;    /* true: the surface is turned inside out and bounds a cavity */
    uint32_t flags; /* flags that are added to the labels of all its triangles [MESH_LUMEN] */
} SurfaceUse;

/* Copies a surface to the solid, without the discs of its opened ends. Sets CutEnd.rim of all ends.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status solid_surface(Solid *solid, const VesselMesh *mesh, CutEnds *ends, SurfaceUse use,
                                Err *err);
/* Joins two rims of n points each by a ring of 2 n triangles with this label. Point i of one rim is
 * opposite point i of the other. Walking along `rim` by ascending index on the outside of the
 * solid, `next` is on the left. Errors: STATUS_MEMORY. */
MUST_CHECK Status solid_ring(Solid *solid, const uint32_t *rim, const uint32_t *next, uint32_t n,
                             uint32_t label, Err *err);

/* A closed loop of points of a solid, as indices in order around the loop. */
typedef struct FaceLoop {
    const uint32_t *points; /* borrowed */
    uint32_t n;
} FaceLoop;

/* Fills a flat face with triangles.
 *
 * face     number of the face [casing.h]: 2 axis + 1 if the outside is towards high coordinates of
 *          the axis, 2 axis if it is towards low coordinates. All points have the same coordinate
 *          along the axis.
 * loops    the first loop is the face's edge, counterclockwise seen from outside. The other loops
 *          are holes, clockwise seen from outside.
 * Errors   STATUS_INFEASIBLE if loops touch each other; STATUS_MEMORY.
 * Cost     O(n^2) for n points. */
MUST_CHECK Status face_fill(Solid *solid, int face, const FaceLoop *loops, size_t n_loops,
                            uint32_t label, Err *err);

#endif
