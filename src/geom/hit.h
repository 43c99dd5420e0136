/* Where rays meet spheres, cylinders and boxes. */
#ifndef CORCAST_GEOM_HIT_H
#define CORCAST_GEOM_HIT_H

#include "geom/box.h"
#include "geom/vec3.h"
#include <stdbool.h>

typedef struct Ray {
    Vec3 origin;
    Vec3 direction; /* unit */
} Ray;

static inline Vec3 ray_at(Ray ray, double t)
{
    return vec3_add_scaled(ray.origin, ray.direction, t);
}

/* A closed cylinder, prepared for many rays. */
typedef struct CylinderFrame {
    Vec3 base;
    Vec3 axis; /* unit */
    double length;
    double radius;
} CylinderFrame;

/* a and b differ, radius > 0. */
CylinderFrame cylinder_frame(Vec3 a, Vec3 b, double radius);

/* One crossing of a surface. */
typedef struct Hit {
    double t;    /* along the ray; may be negative */
    Vec3 normal; /* unit, outward */
} Hit;

/* All crossings of the line with the sphere, nearest first: 0 or 2. Grazing lines whose half chord
 * squared is below 1e-10 miss, as in POV-Ray (shapes/spheres.cpp). */
int hit_sphere(Ray ray, Vec3 center, double radius, Hit hits[2]);

/* All crossings of the line with the wall and the two end discs of the cylinder, in no order: at
 * most 4, two but for lines through a rim. */
int hit_cylinder(Ray ray, const CylinderFrame *cylinder, Hit hits[4]);

/* 1 / direction for hit_box, with a huge number where a component is 0, so that the product with
 * a distance is never NaN. */
static inline Vec3 ray_inverse(Vec3 direction)
{
    const double huge = 1e300;
    return vec3(direction.x == 0 ? huge : 1 / direction.x,
                direction.y == 0 ? huge : 1 / direction.y,
                direction.z == 0 ? huge : 1 / direction.z);
}

/* Narrows [*low, *high] to where the line lies between two planes across an axis. */
static inline void clip_slab(double from, double inverse, double box_low, double box_high,
                             double *low, double *high)
{
    double a = (box_low - from) * inverse, b = (box_high - from) * inverse;
    double near = a < b ? a : b, far = a < b ? b : a;
    *low = near > *low ? near : *low;
    *high = far < *high ? far : *high;
}

/* Whether the line meets the box for some t in [*t0, *t1], t0 >= 0, and if so that part of the
 * interval. `inverse` is ray_inverse(direction). A line that runs within a face may be taken to miss,
 * so boxes are made a little larger than what they hold. */
static inline bool hit_box(Vec3 origin, Vec3 inverse, const Box *box, double *t0, double *t1)
{
    double low = *t0, high = *t1;
    clip_slab(origin.x, inverse.x, box->low.x, box->high.x, &low, &high);
    clip_slab(origin.y, inverse.y, box->low.y, box->high.y, &low, &high);
    clip_slab(origin.z, inverse.z, box->low.z, box->high.z, &low, &high);
    if (!(low <= high))
        return false;
    *t0 = low;
    *t1 = high;
    return true;
}

#endif
