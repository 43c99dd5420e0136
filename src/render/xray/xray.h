/* Pictures of the length of vessel along each ray. */
#ifndef CORCAST_RENDER_XRAY_H
#define CORCAST_RENDER_XRAY_H

#include "render/engine.h"

/* Draws colours alone, one sample a pixel. */
extern const Engine xray_engine;

/* How much of the ray, mm, from its origin on, lies inside a primitive, as stretches of it: at most
 * 3, in *stretches, rising and apart; returns how many. Exact but for rounding: a cylinder with its
 * end discs, a sphere, a joint with its discs. */
typedef struct RayStretch {
    double from, to;
} RayStretch;

int primitive_stretches(const Primitive *primitive, const PrimitiveFrame *frame, Ray ray,
                        RayStretch stretches[3]);

/* The length of the union of stretches, mm, which it sorts. O(n log n), or O(n) where they rise. */
double stretches_length(RayStretch *stretches, size_t n);

#endif
