/* Computes the length of a ray inside vessels, on which the color of a pixel of the x-ray effect
 * depends [Xray in scene/effects.h]: primitive_stretches finds the intervals of the ray inside each
 * primitive, stretches_length the length of their union. All functions are pure. */
#ifndef CORCAST_RENDER_XRAY_XRAY_H
#define CORCAST_RENDER_XRAY_XRAY_H

#include "scene/scene.h"

/* An interval of a ray inside a vessel, mm from the ray's origin. */
typedef struct RayStretch {
    double from, to;
} RayStretch;

/* Computes the intervals of a ray, from its origin on, that are inside a primitive: a sphere, a
 * cylinder with its discs, or a joint with its discs. Exact except for rounding. Sets stretches[],
 * ascending and without overlaps, and returns their number, 0 to 3. */
int primitive_stretches(const Primitive *primitive, const PrimitiveFrame *frame, Ray ray,
                        RayStretch stretches[3]);

/* Sorts the n intervals in place and returns the length of their union, mm. O(n log n), or O(n) if
 * they are already ascending. */
double stretches_length(RayStretch *stretches, size_t n);

#endif
