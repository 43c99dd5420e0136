/* First hits of primitives, by a bounding volume hierarchy. */
#ifndef CORCAST_RENDER_BVH_H
#define CORCAST_RENDER_BVH_H

#include "base/base.h"
#include "scene/scene.h"

/* Constant once built, shared by threads. */
typedef struct Bvh Bvh;

/* `primitives` is borrowed and must outlive the hierarchy; n >= 1. O(n log n). STATUS_MEMORY. */
MUST_CHECK Status bvh_build(const Primitive *primitives, size_t n, Bvh **out, Err *err);
void bvh_free(Bvh *bvh);

/* The nearest crossing with t >= t_min: true and *hit, *primitive (its index; of equally near ones
 * the lowest), or false. The normal is the surface's own, outward. */
bool bvh_first_hit(const Bvh *bvh, Ray ray, double t_min, Hit *hit, size_t *primitive);

/* Whether there is a crossing with t in (t_min, t_max). */
bool bvh_any_hit(const Bvh *bvh, Ray ray, double t_min, double t_max);

#endif
