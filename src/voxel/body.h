/* The convex bodies that vessels are united of, and boxes; private to the room voxel. */
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

/* A cylinder from a to b, which are a ball's centre when they are the same. */
Body body_make(Vec3 a, Vec3 b, double radius, uint32_t segment);

static inline bool body_is_ball(const Body *body)
{
    return body->length == 0;
}

Box body_box(const Body *body);

/* A box across the axes. */
typedef struct Cell {
    Vec3 center, half;
} Cell;

static inline double cell_volume(const Cell *cell)
{
    return 8 * cell->half.x * cell->half.y * cell->half.z;
}

/* False only where they have no point in common. */
bool body_meets(const Body *body, const Cell *cell);
/* Whether all of the cell lies in the body. */
bool body_holds(const Body *body, const Cell *cell);
/* The part of the cell, in [0, 1], that lies in the body, to 1e-7. */
double body_part(const Body *body, const Cell *cell);

/* From where to where a line along axis 0, 1 or 2 is in the body, in mm from `at`, a point of it;
 * false: nowhere. `wider` and `longer` mm are added to the radius and at both ends. */
bool body_chord(const Body *body, Vec3 at, int axis, double wider, double longer, double *low,
                double *high);

/* From where to where, in mm from its start, the axis of a cylinder is in the cell, the sides to
 * high coordinates left out; false: nowhere. */
bool body_axis_in(const Body *body, const Cell *cell, double *from, double *to);

#endif
