/* The wall of vessels as triangles. */
#ifndef CORCAST_SCENE_TRIANGLES_H
#define CORCAST_SCENE_TRIANGLES_H

#include "base/base.h"
#include "geom/geom.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Set in the label of a triangle that is flat, as one that closes an end; of the inner side of a
 * wall; or of a block or a plate, and not of the segment. */
#define MESH_CAP 0x80000000u
#define MESH_LUMEN 0x40000000u
#define MESH_FRAME 0x20000000u
#define MESH_FLAGS (MESH_CAP | MESH_LUMEN | MESH_FRAME)

/* Triangles, counterclockwise seen from outside. Points are single precision, as most formats hold
 * them, so that what is checked is what is written. */
typedef struct VesselMesh {
    float (*points)[3];  /* mm; owned, as all of it */
    float (*normals)[3]; /* unit, outward, of the exact surface; on the rim of a cap, of the wall */
    size_t n_points;
    uint32_t (*triangles)[3];
    uint32_t *labels; /* one a triangle: index of its segment, and MESH_FLAGS */
    size_t n_triangles;
} VesselMesh;

/* Frees the arrays and zeroes *mesh. */
void vesselmesh_release(VesselMesh *mesh);

static inline Vec3 mesh_point(const VesselMesh *mesh, uint32_t i)
{
    const float *x = mesh->points[i];
    return vec3((double)x[0], (double)x[1], (double)x[2]);
}

/* The triangles of `n` segments, given by rising index, and their points, in *out (owned); labels
 * become indices of that list. STATUS_MEMORY. O(points + triangles log n). */
MUST_CHECK Status vesselmesh_part(const VesselMesh *mesh, const uint32_t *segments, size_t n,
                                  VesselMesh *out, Err *err);

/* Index of the segment that a triangle belongs to, and whether the triangle is flat. */
static inline uint32_t mesh_segment(const VesselMesh *mesh, size_t triangle)
{
    return mesh->labels[triangle] & ~MESH_FLAGS;
}
static inline bool mesh_is_cap(const VesselMesh *mesh, size_t triangle)
{
    return (mesh->labels[triangle] & MESH_CAP) != 0;
}

/* The unit normal of a triangle, by the right hand; 0 where it has no area. */
void mesh_flat_normal(const VesselMesh *mesh, size_t triangle, float normal[3]);

#endif
