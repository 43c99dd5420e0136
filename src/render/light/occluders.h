/* The vessels that beams towards the sky meet. */
#ifndef CORCAST_RENDER_OCCLUDERS_H
#define CORCAST_RENDER_OCCLUDERS_H

#include "base/base.h"
#include "scene/scene.h"

/* Capsules, in mm from OccluderSet.origin. One of a radius below 0 fills up the last block. */
enum { BEAM_BLOCK = 16 };
typedef struct CapsuleBlock {
    float a[3][BEAM_BLOCK], b[3][BEAM_BLOCK], radius[BEAM_BLOCK];
} CapsuleBlock;

/* The capsules of a geometry, which stand for its vessels in any model. */
typedef struct OccluderSet {
    CapsuleBlock *capsules; /* owned */
    size_t n_blocks;
    Vec3 origin; /* the middle of the geometry; places are relative to it */
    float wide;  /* mm: half of what a beam is wide at most */
    float slack; /* mm: more than what rounding moves a place by */
} OccluderSet;

/* Lists the capsules of a geometry. O(n). STATUS_MEMORY. */
MUST_CHECK Status occluderset_new(const Geometry *geometry, OccluderSet *beams, Err *err);
void occluderset_release(OccluderSet *beams);

/* Of `n` lines whose both directions are spread evenly over the sphere, the one of number k that
 * points up: unit. */
Vec3 occlusion_direction(int n, int k);

#endif
