/* Axis-aligned boxes. A box contains its faces, and may be flat. To compute the bounds of points,
 * start with box_empty():
 *
 *     Box bounds = box_empty();
 *     for each point:  bounds = box_with_ball(bounds, point, radius); */
#ifndef CORCAST_GEOM_BOX_H
#define CORCAST_GEOM_BOX_H

#include "geom/vec3.h"
#include <stdbool.h>

/* A box, given by its corners with the lowest and the highest coordinates, mm. */
typedef struct Box {
    Vec3 low, high;
} Box;

/* box_min and box_max return the smaller and the larger of two numbers, which must not be NaN.
 * Unlike fmin and fmax, each is one machine instruction. */
static inline double box_min(double a, double b)
{
    return a < b ? a : b;
}

static inline double box_max(double a, double b)
{
    return a > b ? a : b;
}

/* Returns the box that contains no point. */
static inline Box box_empty(void)
{
    return (Box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

/* Returns true if the box contains no point. */
static inline bool box_is_empty(Box box)
{
    return !(box.low.x <= box.high.x);
}

/* Returns the smallest box that contains `box` and the ball of `radius` >= 0 around `center`. */
static inline Box box_with_ball(Box box, Vec3 center, double radius)
{
    box.low.x = box_min(box.low.x, center.x - radius);
    box.low.y = box_min(box.low.y, center.y - radius);
    box.low.z = box_min(box.low.z, center.z - radius);
    box.high.x = box_max(box.high.x, center.x + radius);
    box.high.y = box_max(box.high.y, center.y + radius);
    box.high.z = box_max(box.high.z, center.z + radius);
    return box;
}

/* Returns the smallest box that contains both boxes. */
static inline Box box_union(Box a, Box b)
{
    return (Box){
        {box_min(a.low.x, b.low.x), box_min(a.low.y, b.low.y), box_min(a.low.z, b.low.z)},
        {box_max(a.high.x, b.high.x), box_max(a.high.y, b.high.y), box_max(a.high.z, b.high.z)}};
}

/* Returns the box, with each face moved outwards by `by`, mm. */
static inline Box box_padded(Box box, double by)
{
    Vec3 pad = vec3(by, by, by);
    return (Box){vec3_sub(box.low, pad), vec3_add(box.high, pad)};
}

/* Returns true if the boxes have a point in common, also if they only touch. */
static inline bool box_overlaps(Box a, Box b)
{
    return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y &&
           b.low.y <= a.high.y && a.low.z <= b.high.z && b.low.z <= a.high.z;
}

/* Returns true if the point is in the box, or at most `margin`, mm, outside it along each axis. */
static inline bool box_contains(Box box, Vec3 point, double margin)
{
    return box.low.x - margin <= point.x && point.x <= box.high.x + margin &&
           box.low.y - margin <= point.y && point.y <= box.high.y + margin &&
           box.low.z - margin <= point.z && point.z <= box.high.z + margin;
}

/* Returns the axis (0: x, 1: y, 2: z) along which the box is longest; on a tie, the lowest. */
static inline int box_longest_axis(Box box)
{
    Vec3 size = vec3_sub(box.high, box.low);
    return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

static inline Vec3 box_center(Box box)
{
    return vec3_scale(vec3_add(box.low, box.high), 0.5);
}

#endif
