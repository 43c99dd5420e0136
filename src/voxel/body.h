/* Convex bodies whose union vessels are, and their intersections with boxes. Private to the module
 * voxel. */
#ifndef CORCAST_VOXEL_BODY_H
#define CORCAST_VOXEL_BODY_H

#include "geom/geom.h"
#include <stdbool.h>
#include <stdint.h>

/* A closed cylinder, or a ball. */
typedef struct Body {
    Vec3 start;      /* of the axis, or the centre of a ball, mm */
    Vec3 axis, u, v; /* unit, right-handed; of a cylinder */
    double length;   /* 0: a ball */
    double radius;   /* > 0 */
    uint32_t segment;
} Body;

/* Makes a cylinder from a to b; a ball around a if a and b are equal. */
Body body_make(Vec3 a, Vec3 b, double radius, uint32_t segment);

static inline bool body_is_ball(const Body *body)
{
    return body->length == 0;
}

/* Returns the box around a body. */
Box body_box(const Body *body);

/* A box whose sides are parallel to the axes. */
typedef struct VoxelCell {
    Vec3 center, half;
} VoxelCell;

static inline double cell_volume(const VoxelCell *cell)
{
    return 8 * cell->half.x * cell->half.y * cell->half.z;
}

/* Returns false only if body and cell have no point in common. */
bool body_meets(const Body *body, const VoxelCell *cell);
/* Returns true if the whole cell lies in the body. */
bool body_holds(const Body *body, const VoxelCell *cell);
/* Returns the fraction of the cell, in [0, 1], that lies in the body, with an error of 1e-7. */
double body_fraction(const Body *body, const VoxelCell *cell);

/* Intersects a body with the line through `at` parallel to axis 0, 1 or 2. Returns false if they do
 * not meet. `low` and `high` receive the ends of the chord, in mm from `at`. Before, `wider` mm are
 * added to the radius, and `longer` mm at both ends. */
bool body_chord(const Body *body, Vec3 at, int axis, double wider, double longer, double *low,
                double *high);

/* Finds the part of a cylinder's axis in the cell, as distances from the axis's start in mm.
 * Returns false if there is none. The cell does not include its sides towards high coordinates. */
bool body_axis_in(const Body *body, const VoxelCell *cell, double *from, double *to);

#endif
