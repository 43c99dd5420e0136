/* Axis-aligned boxes. */
#ifndef CORCAST_GEOM_BOX_H
#define CORCAST_GEOM_BOX_H

#include "geom/vec3.h"
#include <stdbool.h>

typedef struct Box {
    Vec3 low, high;
} Box;

/* The box that holds nothing. */
static inline Box box_empty(void)
{
    return (Box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

static inline bool box_is_empty(Box box)
{
    return !(box.low.x <= box.high.x);
}

/* The smallest box that holds `box` and the ball of `radius` about `center`. */
static inline Box box_with_ball(Box box, Vec3 center, double radius)
{
    box.low.x = fmin(box.low.x, center.x - radius);
    box.low.y = fmin(box.low.y, center.y - radius);
    box.low.z = fmin(box.low.z, center.z - radius);
    box.high.x = fmax(box.high.x, center.x + radius);
    box.high.y = fmax(box.high.y, center.y + radius);
    box.high.z = fmax(box.high.z, center.z + radius);
    return box;
}

static inline Box box_union(Box a, Box b)
{
    return (Box){{fmin(a.low.x, b.low.x), fmin(a.low.y, b.low.y), fmin(a.low.z, b.low.z)},
                 {fmax(a.high.x, b.high.x), fmax(a.high.y, b.high.y), fmax(a.high.z, b.high.z)}};
}

/* Whether they have a point in common. */
static inline bool box_meets(Box a, Box b)
{
    return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y &&
           b.low.y <= a.high.y && a.low.z <= b.high.z && b.low.z <= a.high.z;
}

/* The axis along which it is longest, the first of equals. */
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
