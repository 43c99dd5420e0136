/* The triangles of one junction region while they are made. */
#ifndef CORCAST_MESH_LATTICE_PATCH_H
#define CORCAST_MESH_LATTICE_PATCH_H

#include "base/base.h"
#include "geom/geom.h"
#include "mesh/lattice/octree.h"
#include <stdint.h>

typedef struct PatchPoint {
    Vec3 x;               /* mm */
    Vec3 normal;          /* unit, outward */
    double radius_mm;     /* radius of the vessel whose term is largest here */
    uint32_t segment;     /* that vessel */
    uint16_t vessel_stub; /* the branch stub of that vessel, or NO_STUB */
    uint16_t rim_stub;    /* the stub whose rim the point is on, or NO_STUB */
} PatchPoint;

/* Indices of three points, counterclockwise seen from outside. */
typedef struct PatchTriangle {
    uint32_t at[3];
} PatchTriangle;

/* In place of a triangle's first point: patch_compact removes the triangle. */
#define REMOVED UINT32_MAX

/* All arrays are owned. Zero it before first use; release it with patch_release. */
typedef struct Patch {
    PatchPoint *points;
    size_t n_points, point_capacity;
    PatchTriangle *triangles;
    size_t n_triangles, triangle_capacity;
    uint32_t *scratch; /* per point */
    size_t scratch_capacity;
} Patch;

void patch_release(Patch *patch);

/* One region and its surface, for the steps that make it. All pointers are borrowed. */
typedef struct JunctionSurface {
    const JunctionPlan *plan;
    Octree *tree;
    Patch *patch;
} JunctionSurface;

/* Returns the point of the surface at x, where the field has this value and gradient. */
PatchPoint patch_surface_point(const JunctionField *field, Vec3 x, const FieldValue *value,
                               Vec3 gradient);

/* Appends a point, and sets *index to its index. Errors: STATUS_MEMORY. */
MUST_CHECK Status patch_add_point(Patch *patch, PatchPoint point, uint32_t *index, Err *err);
/* Appends a triangle. Errors: STATUS_MEMORY. */
MUST_CHECK Status patch_add_triangle(Patch *patch, PatchTriangle triangle, Err *err);

/* Removes the triangles whose first point is REMOVED, and the points that no triangle uses. The
 * others stay in order. Errors: STATUS_MEMORY. */
MUST_CHECK Status patch_compact(Patch *patch, Err *err);

/* Counts the connected parts of the patch. Errors: STATUS_MEMORY. */
MUST_CHECK Status patch_count_parts(Patch *patch, size_t *parts, Err *err);

/* Removes all connected parts except the one with most points. Errors: STATUS_MEMORY. */
MUST_CHECK Status patch_keep_largest(Patch *patch, Err *err);

#endif
