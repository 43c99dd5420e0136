/* Vectors of three doubles. Positions are in millimetres; directions have no unit. */
#ifndef CORCAST_GEOM_VEC3_H
#define CORCAST_GEOM_VEC3_H

#include "base/base.h"

#include <math.h>

typedef struct Vec3 {
    double x, y, z;
} Vec3;

static inline Vec3 vec3(double x, double y, double z)
{
    return (Vec3){x, y, z};
}

/* Returns component `axis` of v: 0 is x, 1 is y, 2 is z. */
static inline double vec3_component(Vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static inline Vec3 vec3_add(Vec3 a, Vec3 b)
{
    return vec3(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline Vec3 vec3_sub(Vec3 a, Vec3 b)
{
    return vec3(a.x - b.x, a.y - b.y, a.z - b.z);
}

static inline Vec3 vec3_scale(Vec3 a, double factor)
{
    return vec3(a.x * factor, a.y * factor, a.z * factor);
}

/* Returns a + b * factor. */
static inline Vec3 vec3_add_scaled(Vec3 a, Vec3 b, double factor)
{
    return vec3(a.x + b.x * factor, a.y + b.y * factor, a.z + b.z * factor);
}

static inline double vec3_dot(Vec3 a, Vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline Vec3 vec3_cross(Vec3 a, Vec3 b)
{
    return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline double vec3_length(Vec3 a)
{
    return sqrt(vec3_dot(a, a));
}

static inline double vec3_distance(Vec3 a, Vec3 b)
{
    return vec3_length(vec3_sub(a, b));
}

/* Returns the squared distance between the point `a` and the segment from the origin (0, 0, 0) to
 * `along`, which may be the zero vector. */
static inline double vec3_distance2_along(Vec3 a, Vec3 along)
{
    double length2 = vec3_dot(along, along), t = vec3_dot(a, along) / length2;
    Vec3 apart = vec3_add_scaled(a, along, length2 > 0 ? -fmin(fmax(t, 0), 1) : 0);
    return vec3_dot(apart, apart);
}

/* Returns a / |a|. The length of `a` must not be 0. */
static inline Vec3 vec3_normalized(Vec3 a)
{
    return vec3_scale(a, 1 / vec3_length(a));
}

/* Returns `a` rotated about the unit vector `axis` by `angle` radians, right-handed. */
static inline Vec3 vec3_rotated(Vec3 a, Vec3 axis, double angle)
{
    Vec3 result = vec3_scale(a, elementary_cos(angle));
    result = vec3_add_scaled(result, vec3_cross(axis, a), elementary_sin(angle));
    return vec3_add_scaled(result, axis, vec3_dot(axis, a) * (1 - elementary_cos(angle)));
}

/* Sets u and v to unit vectors perpendicular to the unit vector `axis` and to each other, so that
 * u x v = axis. */
static inline void vec3_perpendiculars(Vec3 axis, Vec3 *u, Vec3 *v)
{
    Vec3 other = fabs(axis.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    *u = vec3_normalized(vec3_cross(other, axis));
    *v = vec3_cross(axis, *u);
}

/* Returns the vector of 1 / component; infinite where a component is 0. */
static inline Vec3 vec3_inverse(Vec3 a)
{
    return vec3(1 / a.x, 1 / a.y, 1 / a.z);
}

/* Returns nonzero if no component is infinite or NaN. */
static inline int vec3_finite(Vec3 a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

#endif
