/* The surface of vessels as a mesh of triangles. Each triangle has a label: the index of its
 * segment, and flags that mark caps, the lumen of a hollow wall, and the block or plate of a print.
 */
#ifndef CORCAST_SCENE_TRIANGLES_H
#define CORCAST_SCENE_TRIANGLES_H

#include "base/base.h"
#include "geom/geom.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Flags in the label of a triangle. MESH_CAP: the triangle is part of a flat face, such as the disc
 * that closes an end. MESH_LUMEN: it is on the inner side of a hollow wall. MESH_FRAME: it belongs
 * to a block or a base plate, not to the segment. */
#define MESH_CAP 0x80000000u
#define MESH_LUMEN 0x40000000u
#define MESH_FRAME 0x20000000u
#define MESH_FLAGS (MESH_CAP | MESH_LUMEN | MESH_FRAME)

/* A mesh of triangles. The corners of a triangle are counterclockwise seen from outside.
 * Coordinates are in single precision, as in most file formats, so that the checked mesh is equal
 * to the written mesh. All arrays are owned. */
typedef struct VesselMesh {
    float (*points)[3];  /* mm */
    float (*normals)[3]; /* per point: unit, outward normal of the exact surface; on the boundary of
                          * a cap, the normal of the wall */
    size_t n_points;
    uint32_t (*triangles)[3]; /* indices of points */
    uint32_t *labels;         /* per triangle: index of its segment, below 2^29, and flags */
    size_t n_triangles;
} VesselMesh;

/* Frees the arrays and zeroes *mesh. */
void vesselmesh_release(VesselMesh *mesh);

/* Returns point i in double precision. */
static inline Vec3 mesh_point(const VesselMesh *mesh, uint32_t i)
{
    const float *x = mesh->points[i];
    return vec3((double)x[0], (double)x[1], (double)x[2]);
}

/* Copies the triangles of n segments, and the points of these triangles. `segments` holds segment
 * indices in ascending order; the labels of *out are indices in this list, with the flags of the
 * original. Release *out with vesselmesh_release. Errors: STATUS_MEMORY. O(points + triangles log
 * n). */
MUST_CHECK Status vesselmesh_part(const VesselMesh *mesh, const uint32_t *segments, size_t n,
                                  VesselMesh *out, Err *err);

/* Returns the index of the segment that a triangle belongs to. */
static inline uint32_t mesh_segment(const VesselMesh *mesh, size_t triangle)
{
    return mesh->labels[triangle] & ~MESH_FLAGS;
}
/* Returns true if the triangle is part of a flat face [MESH_CAP]. */
static inline bool mesh_is_cap(const VesselMesh *mesh, size_t triangle)
{
    return (mesh->labels[triangle] & MESH_CAP) != 0;
}

/* Computes the unit outward normal of a triangle; (0, 0, 0) if the triangle has no area. */
void mesh_flat_normal(const VesselMesh *mesh, size_t triangle, float normal[3]);

#endif
