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

/* Narrows [*low, *high] to where the line lies between two planes across an axis. In the plane of
 * one of them 0 * infinity is NaN, every comparison with it is false, and that plane does not
 * narrow. */
static inline void clip_slab(double from, double inverse, double box_low, double box_high,
                             double *low, double *high)
{
    double near = ((inverse < 0 ? box_high : box_low) - from) * inverse;
    double far = ((inverse < 0 ? box_low : box_high) - from) * inverse;
    *low = near > *low ? near : *low;
    *high = far < *high ? far : *high;
}

/* Whether the line meets the box, its faces included, for some t in [*t0, *t1], and if so that part
 * of the interval. `inverse` holds 1 / direction, infinities allowed. */
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
