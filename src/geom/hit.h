/* Intersections of rays with spheres, cylinders and boxes.
 *
 *     Hit hits[4];
 *     CylinderFrame cylinder = cylinder_frame(a, b, radius);
 *     int n = hit_cylinder(ray, &cylinder, hits);
 *
 * Spheres and cylinders are intersected with the whole line through the ray, so hits may be behind
 * the origin (t < 0). The formulas and their tolerances are those of POV-Ray 3.7 [docs/POVRAY.md
 * section 4], so that silhouettes fall on the same pixels. */
#ifndef CORCAST_GEOM_HIT_H
#define CORCAST_GEOM_HIT_H

#include "geom/box.h"
#include "geom/vec3.h"
#include <stdbool.h>

typedef struct Ray {
    Vec3 origin;    /* mm */
    Vec3 direction; /* unit */
} Ray;

/* Returns the point at the distance t from the origin of the ray. */
static inline Vec3 ray_at(Ray ray, double t)
{
    return vec3_add_scaled(ray.origin, ray.direction, t);
}

/* A cylinder with two end discs, prepared for many rays. */
typedef struct CylinderFrame {
    Vec3 base; /* centre of the first end disc, mm */
    Vec3 axis; /* unit */
    double length;
    double radius;
} CylinderFrame;

/* Prepares the cylinder from `a` to `b`, which must differ. The radius, mm, is above 0. */
CylinderFrame cylinder_frame(Vec3 a, Vec3 b, double radius);

/* An intersection of a line with a surface. */
typedef struct Hit {
    double t;    /* distance along the ray, mm; may be negative */
    Vec3 normal; /* unit, outward */
} Hit;

/* Finds the intersections of the line with the sphere, in the order of increasing t. Returns their
 * number, 0 or 2. A line that only grazes the sphere has none: the square of half the chord must
 * exceed 1e-10 mm^2, as in POV-Ray (shapes/spheres.cpp). */
int hit_sphere(Ray ray, Vec3 center, double radius, Hit hits[2]);

/* Finds the intersections of the line with the wall and the two end discs of the cylinder, in
 * no particular order. Returns their number: 0 or 2; for a line through a rim, 0 to 4. */
int hit_cylinder(Ray ray, const CylinderFrame *cylinder, Hit hits[4]);

/* Narrows the interval [*low, *high] of t to the part of a line between two planes that are
 * perpendicular to an axis, at the coordinates box_low and box_high. `origin` and `inverse` are the
 * components along this axis of the origin and of 1 / direction.
 *
 * If the line lies in one of the planes, 0 * infinity gives NaN. Every comparison with NaN is
 * false, so this plane does not narrow the interval. */
static inline void clip_slab(double origin, double inverse, double box_low, double box_high,
                             double *low, double *high)
{
    double near = ((inverse < 0 ? box_high : box_low) - origin) * inverse;
    double far = ((inverse < 0 ? box_low : box_high) - origin) * inverse;
    *low = near > *low ? near : *low;
    *high = far < *high ? far : *high;
}

/* Returns true if the line intersects or touches the box at a t in [*t0, *t1], and then narrows the
 * interval to the part inside the box. Otherwise leaves the interval unchanged. `inverse` is
 * vec3_inverse of the direction; infinite components are allowed. */
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
