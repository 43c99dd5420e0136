/* The triangles of one junction region while they are made.
 *
 * The steps that make the surface [lattice.h, planecut.h, collapse.h, facerefine.h] append points
 * and triangles to a patch, mark triangles as REMOVED, and compact the patch. Private to the module
 * mesh. */
#ifndef CORCAST_MESH_LATTICE_PATCH_H
#define CORCAST_MESH_LATTICE_PATCH_H

#include "base/base.h"
#include "geom/geom.h"
#include "mesh/lattice/octree.h"
#include <stdint.h>

typedef struct PatchPoint {
    Vec3 x;               /* mm */
    Vec3 normal;          /* unit, outward */
    double radius_mm;     /* the local radius: that of `segment` */
    uint32_t segment;     /* index of the segment with the largest term at x */
    uint16_t vessel_stub; /* index of the branch stub of `segment`, or NO_STUB */
    uint16_t rim_stub;    /* index of the stub whose rim the point is on, or NO_STUB */
} PatchPoint;

/* Indices of three points, counterclockwise seen from outside. */
typedef struct PatchTriangle {
    uint32_t at[3];
} PatchTriangle;

/* A triangle with this value in at[0] is removed by patch_compact. */
#define REMOVED UINT32_MAX

/* All arrays are owned. Zero it before first use; release it with patch_release. */
typedef struct Patch {
    PatchPoint *points;
    size_t n_points, point_capacity;
    PatchTriangle *triangles;
    size_t n_triangles, triangle_capacity;
    uint32_t *scratch; /* per point: for patch_compact and the functions on connected parts */
    size_t scratch_capacity;
} Patch;

void patch_release(Patch *patch);

/* One region: its plan, its octree and its patch, as the steps that make the surface need them. All
 * pointers are borrowed. */
typedef struct JunctionSurface {
    const JunctionPlan *plan;
    Octree *tree;
    Patch *patch;
} JunctionSurface;

/* Returns the point of a patch at x. `value` and `gradient` are the field's value and gradient
 * there. `gradient` must not be 0. */
PatchPoint patch_surface_point(const JunctionField *field, Vec3 x, const FieldValue *value,
                               Vec3 gradient);

/* Appends a point, and sets *index to its index. Errors: STATUS_MEMORY. */
MUST_CHECK Status patch_add_point(Patch *patch, PatchPoint point, uint32_t *index, Err *err);
/* Appends a triangle. Errors: STATUS_MEMORY. */
MUST_CHECK Status patch_add_triangle(Patch *patch, PatchTriangle triangle, Err *err);

/* Removes the triangles whose at[0] is REMOVED, and the points that no triangle uses. The other
 * triangles and points stay in order; points get new indices. Errors: STATUS_MEMORY. */
MUST_CHECK Status patch_compact(Patch *patch, Err *err);

/* Sets *parts to the number of connected parts of the patch. Errors: STATUS_MEMORY. */
MUST_CHECK Status patch_count_parts(Patch *patch, size_t *parts, Err *err);

/* Removes all connected parts except the one with most points. Errors: STATUS_MEMORY. */
MUST_CHECK Status patch_keep_largest(Patch *patch, Err *err);

#endif
