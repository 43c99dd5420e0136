/* The vessels that block ambient light, as capsules. */
#ifndef CORCAST_RENDER_OCCLUDERS_H
#define CORCAST_RENDER_OCCLUDERS_H

#include "base/base.h"
#include "scene/scene.h"

/* Sixteen capsules: all points within `radius` of the segment from a to b, mm, relative to
 * OccluderSet.origin. Capsules that fill up the last block have a negative radius. */
enum { OCCLUDER_BLOCK = 16 };
typedef struct CapsuleBlock {
    float a[3][OCCLUDER_BLOCK], b[3][OCCLUDER_BLOCK], radius[OCCLUDER_BLOCK];
} CapsuleBlock;

/* The capsules of a geometry, which stand for its vessels in any model. Immutable once made. */
typedef struct OccluderSet {
    CapsuleBlock *capsules; /* owned */
    size_t n_blocks;
    Vec3 origin; /* middle of the geometry; shading points are relative to it */
    float wide;  /* largest half width of an occlusion cone, mm */
    float slack; /* mm; more than rounding moves a point */
} OccluderSet;

/* Makes the capsules of a geometry in O(n). Release *occluders with occluderset_release. Errors:
 * STATUS_MEMORY; nothing is to be released then. */
MUST_CHECK Status occluderset_new(const Geometry *geometry, OccluderSet *occluders, Err *err);
void occluderset_release(OccluderSet *occluders);

/* Returns the unit direction, pointing up, of line k of n lines whose 2 n directions are evenly
 * spread over the sphere. */
Vec3 occlusion_direction(int n, int k);

#endif
