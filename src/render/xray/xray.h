/* Lengths of rays inside vessels, for the x-ray view: there, the color of a pixel depends on the
 * length of its ray inside vessels [Xray in scene/effects.h]. All functions are pure. */
#ifndef CORCAST_RENDER_XRAY_XRAY_H
#define CORCAST_RENDER_XRAY_XRAY_H

#include "scene/scene.h"

/* A part of a ray inside a vessel, mm from the ray's origin. */
typedef struct RayStretch {
    double from, to;
} RayStretch;

/* Finds the parts of a ray, from its origin on, that lie inside a primitive: a sphere, a cylinder
 * with its end discs, or a joint with its discs. Exact except for rounding. Sets stretches[] in
 * ascending order, without overlaps, and returns their number. */
int primitive_stretches(const Primitive *primitive, const PrimitiveFrame *frame, Ray ray,
                        RayStretch stretches[3]);

/* Sorts stretches and returns the length of their union, mm. O(n log n), or O(n) if they rise. */
double stretches_length(RayStretch *stretches, size_t n);

#endif
