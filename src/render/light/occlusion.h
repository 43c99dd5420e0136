/* Ambient occlusion: the vessels that block ambient light (OccluderSet), and the ambient visibility
 * of the pixels of a band. Every model is reduced to capsules, because ambient occlusion needs no
 * exact surface.
 *
 *     OccluderSet occluders;
 *     TRY(occluderset_new(&geometry, &occluders, err));                    once per geometry
 *     TRY_GOTO(occlusion_compute(&drawing, &occluders, &visibility, err));    per band
 *     occluderset_release(&occluders); */
#ifndef CORCAST_RENDER_LIGHT_OCCLUSION_H
#define CORCAST_RENDER_LIGHT_OCCLUSION_H

#include "base/base.h"
#include "render/light/visibility.h"
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

/* Computes the ambient visibility of all pixels with a hit, by drawing->params->occlusion occlusion
 * directions: sets visibility->ambient (owned by *visibility, even after an error). Shading points
 * and point_index must be set, and first_row must be even. The ambient visibility of a pixel
 * depends on the shading points up to three rows above and below. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status occlusion_compute(const Drawing *drawing, const OccluderSet *occluders,
                                    PixelVisibility *visibility, Err *err);

#endif
