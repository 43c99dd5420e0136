/* Convex bodies, cylinders and balls, and their intersections with boxes.
 *
 * The vessels of a volume are the union of such bodies. The functions here treat one body: whether
 * a voxel touches it, is inside it, or which fraction of the voxel it fills. cover.h treats unions.
 * All lengths are in mm. Private to the module voxel. */
#ifndef CORCAST_VOXEL_BODY_H
#define CORCAST_VOXEL_BODY_H

#include "geom/geom.h"
#include <stdbool.h>
#include <stdint.h>

/* A cylinder with two flat ends, or a ball. */
typedef struct Body {
    Vec3 start;       /* start of the cylinder's axis, or centre of the ball, mm */
    Vec3 axis, u, v;  /* of a cylinder: its axis and two directions across, unit, right-handed */
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

/* Returns true if the body may meet the cell. Returns false only if the two have no common inner
 * point; true is not certain for a cylinder. */
bool body_meets(const Body *body, const VoxelCell *cell);
/* Returns true if the whole cell is inside the body. */
bool body_holds(const Body *body, const VoxelCell *cell);
/* Returns the fraction of the cell, in [0, 1], that the body fills. The error is at most 1e-7. */
double body_fraction(const Body *body, const VoxelCell *cell);

/* Intersects a body with a line parallel to a coordinate axis. Returns false if they do not meet;
 * then *low and *high have no meaning.
 *
 * at         a point of the line.
 * axis       the axis that the line is parallel to: 0, 1 or 2.
 * wider      mm that are added to the radius first; 0 for the body itself.
 * longer     mm that are added at both ends of a cylinder first; 0 for the body itself.
 * low, high  receive the ends of the chord, in mm from `at` along the axis. */
bool body_chord(const Body *body, Vec3 at, int axis, double wider, double longer, double *low,
                double *high);

/* Finds the part of a cylinder's axis in the cell. Returns false if there is none, and for a ball.
 * *from and *to receive its ends, in mm from the axis's start. A cell does not include its sides
 * towards high coordinates, so that an axis in a face belongs to one voxel. */
bool body_axis_in(const Body *body, const VoxelCell *cell, double *from, double *to);

#endif
