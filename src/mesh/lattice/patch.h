/* A piece of the vessel surface in the making. */
#ifndef CORCAST_MESH_LATTICE_PATCH_H
#define CORCAST_MESH_LATTICE_PATCH_H

#include "base/base.h"
#include "geom/geom.h"
#include "mesh/zones/junctionfield.h"
#include <stdint.h>

typedef struct PatchPoint {
    Vec3 x;           /* mm */
    Vec3 normal;      /* unit, outward */
    double radius_mm; /* of the vessel whose term is largest there */
    uint32_t segment; /* that vessel */
    uint16_t tube;    /* that vessel's arm, or NO_ARM */
    uint16_t arm;     /* the arm on the rim of whose plane it lies, or NO_ARM */
} PatchPoint;

typedef struct Triangle {
    uint32_t at[3]; /* points, counterclockwise from outside */
} Triangle;

typedef struct Patch {
    PatchPoint *points; /* owned, as all of it */
    size_t n_points, point_capacity;
    Triangle *triangles;
    size_t n_triangles, triangle_capacity;
} Patch;

void patch_release(Patch *patch);

/* A point of the wall where the field has this value and gradient. */
PatchPoint patch_wall_point(const ZoneField *field, Vec3 x, const FieldValue *value, Vec3 gradient);

MUST_CHECK Status patch_add_point(Patch *patch, PatchPoint point, uint32_t *number, Err *err);
MUST_CHECK Status patch_add_triangle(Patch *patch, Triangle triangle, Err *err);

/* Returns a coordinate as the nearest integer multiple of `grid_mm`. */
static inline float patch_rounded(double x_mm, double grid_mm)
{
    return (float)(round(x_mm / grid_mm) * grid_mm);
}

/* Leaves out the triangles whose first point is UINT32_MAX, and the points that no triangle has;
 * the order of the others stays. `renamed` has room for the points. */
void patch_compact(Patch *patch, uint32_t *renamed);

#endif
