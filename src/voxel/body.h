/* Convex bodies (cylinders and balls), and their intersections with boxes and lines.
 *
 * The vessels of a volume are the union of such bodies. The functions here treat one body: whether
 * a voxel meets it, whether it contains a voxel, and which fraction of a voxel it fills. cover.h
 * treats unions. All lengths are in mm. Private to the module voxel. */
#ifndef CORCAST_VOXEL_BODY_H
#define CORCAST_VOXEL_BODY_H

#include "geom/geom.h"
#include <stdbool.h>
#include <stdint.h>

/* A cylinder with two flat ends, or a ball. */
typedef struct Body {
    Vec3 start;       /* start of the cylinder's axis, or centre of the ball, mm */
    Vec3 axis, u, v;  /* of a cylinder: unit vectors along the axis and across it, perpendicular,
                       * right-handed */
    double length;    /* mm; 0: a ball */
    double radius;    /* mm, above 0 */
    uint32_t segment; /* index of the segment that the body belongs to */
} Body;

/* Returns the cylinder from a to b, or the ball around a if a and b are equal. */
Body body_make(Vec3 a, Vec3 b, double radius, uint32_t segment);

/* Returns true for a ball, false for a cylinder. */
static inline bool body_is_ball(const Body *body)
{
    return body->length == 0;
}

/* Returns the smallest box around a body. */
Box body_box(const Body *body);

/* A box whose sides are parallel to the axes, such as a voxel. */
typedef struct VoxelCell {
    Vec3 center, half; /* its centre, and half of its sides, mm */
} VoxelCell;

/* Returns the volume of a cell, mm^3. */
static inline double cell_volume(const VoxelCell *cell)
{
    return 8 * cell->half.x * cell->half.y * cell->half.z;
}

/* Returns false if the body and the cell have no common inner point. Returns true if they may have
 * one; for a cylinder, true is not certain. */
bool body_meets(const Body *body, const VoxelCell *cell);
/* Returns true if the whole cell is inside the body. */
bool body_holds(const Body *body, const VoxelCell *cell);
/* Returns the fraction of the cell, in [0, 1], that the body fills. The error is at most 1e-7. */
double body_fraction(const Body *body, const VoxelCell *cell);

/* Intersects a body with a line parallel to a coordinate axis. Returns false if they do not meet;
 * *low and *high are then not set.
 *
 * at         a point of the line.
 * axis       coordinate axis that the line is parallel to: 0, 1 or 2.
 * wider      mm by which the radius is increased before the intersection; 0 for the body itself.
 * longer     mm by which a cylinder is extended at both ends before it; 0 for the body itself.
 * low, high  receive the ends of the intersection, in mm from `at` along the axis. */
bool body_chord(const Body *body, Vec3 at, int axis, double wider, double longer, double *low,
                double *high);

/* Intersects a cylinder's axis with a cell. Sets *from and *to to the ends of the axis in the cell,
 * in mm from the axis's start. Returns false if there is no intersection, and for a ball. A cell
 * does not include its faces at high coordinates, so that an axis in a common face belongs to one
 * voxel only. */
bool body_axis_in(const Body *body, const VoxelCell *cell, double *from, double *to);

#endif
