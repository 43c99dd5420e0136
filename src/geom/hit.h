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

/* Whether the line meets the box for some t in [*t0, *t1], and if so that part of the interval.
 * `inverse` holds 1 / direction, infinities allowed. */
bool hit_box(Vec3 origin, Vec3 inverse, const Box *box, double *t0, double *t1);

#endif
