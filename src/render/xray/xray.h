/* Computes the length of a ray inside vessels, on which the color of a pixel of the x-ray effect
 * depends [Xray in scene/effects.h]: primitive_inside finds the intervals of the ray inside each
 * primitive, intervals_length the length of their union. No function has state. */
#ifndef CORCAST_RENDER_XRAY_XRAY_H
#define CORCAST_RENDER_XRAY_XRAY_H

#include "scene/scene.h"

/* An interval of a ray inside a vessel, mm from the ray's origin. */
typedef struct RayInterval {
    double from, to;
} RayInterval;

/* Computes the intervals of a ray, from its origin on, that are inside a primitive: a sphere, or a
 * cylinder or joint that its end discs close. `frame` is the primitive's precomputed frame
 * [PrimitiveFrame]; the ray's direction is a unit vector. Exact except for rounding. Sets
 * intervals[], ascending and without overlaps, and returns their number, 0 to 3. */
int primitive_inside(const Primitive *primitive, const PrimitiveFrame *frame, Ray ray,
                     RayInterval intervals[3]);

/* Sorts the n intervals in place and returns the length of their union, mm. O(n log n), or O(n) if
 * they are already ascending. */
double intervals_length(RayInterval *intervals, size_t n);

#endif
