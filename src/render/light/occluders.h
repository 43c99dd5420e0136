/* The vessels that block ambient light, as capsules. Every model is reduced to capsules, because
 * ambient occlusion needs no exact surface. */
#ifndef CORCAST_RENDER_LIGHT_OCCLUDERS_H
#define CORCAST_RENDER_LIGHT_OCCLUDERS_H

#include "base/base.h"
#include "scene/scene.h"

/* Sixteen capsules: all points within `radius` of the segment from a to b, mm, relative to
 * OccluderSet.origin. Capsules that fill up the last block have a negative radius. */
enum { OCCLUDER_BLOCK = 16 };
typedef struct CapsuleBlock {
    float a[3][OCCLUDER_BLOCK], b[3][OCCLUDER_BLOCK], radius[OCCLUDER_BLOCK];
} CapsuleBlock;

/* The capsules of the vessels of a geometry of any model. Immutable once built. */
typedef struct OccluderSet {
    CapsuleBlock *capsules; /* owned */
    size_t n_blocks;
    Vec3 origin; /* middle of the geometry; shading points are relative to it, mm */
    float wide;  /* largest half width of an occlusion cone, mm */
    float slack; /* an upper bound of the distance by which rounding moves a point, mm */
} OccluderSet;

/* Builds the capsules of a geometry.
 *
 * occluders  receives the capsules; release with occluderset_release. Set on success only.
 * Errors     STATUS_MEMORY; there is nothing to release then.
 * Cost       O(n). */
MUST_CHECK Status occluderset_new(const Geometry *geometry, OccluderSet *occluders, Err *err);
void occluderset_release(OccluderSet *occluders);

/* Returns the unit direction of line k of n lines, 0 <= k < n. The direction points up; the 2 n
 * directions of all lines and their opposites are evenly spread over the sphere. */
Vec3 occlusion_direction(int n, int k);

#endif
