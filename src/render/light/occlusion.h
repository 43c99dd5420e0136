/* Ambient occlusion: occluderset_new converts the vessels to capsules, which block ambient light,
 * and occlusion_compute computes the ambient visibility of the pixels of a band. Capsules are used
 * for every model, because ambient occlusion needs no exact surface.
 *
 *     OccluderSet occluders;
 *     // once per geometry:
 *     TRY(occluderset_new(&geometry, &occluders, err));
 *     // per band:
 *     TRY_GOTO(occlusion_compute(&drawing, &occluders, &visibility, err));
 *     occluderset_release(&occluders); */
#ifndef CORCAST_RENDER_LIGHT_OCCLUSION_H
#define CORCAST_RENDER_LIGHT_OCCLUSION_H

#include "base/base.h"
#include "render/light/visibility.h"
#include "scene/scene.h"

/* A block of OCCLUDER_BLOCK capsules. A capsule is all points within `radius` of the segment from a
 * to b, mm, relative to OccluderSet.origin. Padding at the end of the last block has a negative
 * radius. */
enum { OCCLUDER_BLOCK = 16 };
typedef struct CapsuleBlock {
    float a[3][OCCLUDER_BLOCK], b[3][OCCLUDER_BLOCK], radius[OCCLUDER_BLOCK];
} CapsuleBlock;

/* The capsules of the vessels of a geometry. They do not change after occluderset_new. */
typedef struct OccluderSet {
    CapsuleBlock *capsules; /* owned */
    size_t n_blocks;
    Vec3 origin;          /* middle of the geometry; shading points are relative to it, mm */
    float max_half_width; /* maximum half width of an occlusion cone, mm; cones widen from their
                           * apex up to this width */
    float slack;          /* an upper bound of the distance by which rounding moves a point, mm */
} OccluderSet;

/* Builds the capsules of a geometry.
 *
 * occluders  receives the capsules; release with occluderset_release. Set on success only.
 * Errors     STATUS_MEMORY; there is nothing to release then.
 * Cost       O(n). */
MUST_CHECK Status occluderset_new(const Geometry *geometry, OccluderSet *occluders, Err *err);
void occluderset_release(OccluderSet *occluders);

/* Occlusion is sampled along n lines through a shading point, with a cone along the end of each
 * line that is outside the surface. Returns the unit vector of the upward direction of line k, 0 <=
 * k < n. The 2 n directions of all lines are evenly distributed over the sphere. */
Vec3 occlusion_direction(int n, int k);

/* Computes the ambient visibility of all pixels with a hit. drawing->params->occlusion is the
 * number of cones of a shading point.
 *
 * Pixels are processed in quads, squares of 2 x 2. The visibility of a pixel averages over 3 x 3
 * quads, so it depends on the shading points up to three rows above and below.
 *
 * visibility  its shading points and point_index must be set. Its first_row must be even, so that
 *             bands have the quads of the whole image. Its `ambient` is set, and is owned by
 *             *visibility even after an error.
 * Errors      STATUS_MEMORY. */
MUST_CHECK Status occlusion_compute(const Drawing *drawing, const OccluderSet *occluders,
                                    PixelVisibility *visibility, Err *err);

#endif
