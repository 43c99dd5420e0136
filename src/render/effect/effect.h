/* Draws the effects of scene/effects.h (fading, outlines, halos and a graded background) over the
 * samples of a shaded image. The image is rendered with `side` x `side` samples per pixel.
 * effects_draw changes the colors of the samples; effects_reduce then averages them to pixels. */
#ifndef CORCAST_RENDER_EFFECT_EFFECT_H
#define CORCAST_RENDER_EFFECT_EFFECT_H

#include "base/base.h"
#include "image/image.h"
#include "render/job.h"
#include "scene/scene.h"

/* The radius of one vessel. Effects measure jumps of depth in radii of the vessel. */
typedef struct IdRadius {
    uint32_t id;     /* SWC id */
    float radius_mm; /* largest radius of the vessels with this id */
} IdRadius;

/* The radii of all vessels, by ascending id. */
typedef struct RadiusTable {
    IdRadius *rows; /* owned */
    size_t n;
} RadiusTable;

/* Makes the table of a geometry; release it with radiustable_release. Errors: STATUS_MEMORY.
 * O(n log n). */
MUST_CHECK Status radiustable_make(const Geometry *geometry, RadiusTable *table, Err *err);
void radiustable_release(RadiusTable *table);
/* Returns the maximum distance, in samples, at which one sample influences another. A pixel is
 * `side` samples wide. */
int effects_reach(const Effects *effects, int side);

/* The input and output of effects_draw and effects_reduce. All pointers are borrowed. */
typedef struct EffectSamples {
    /* The view with its effects, fade, background and camera. The pixels of the camera are the
     * samples. */
    const View *view;
    const RadiusTable *radii;
    int side; /* samples along a side of a pixel */
    int threads;
    Band band;    /* the rows of samples */
    Frame *frame; /* colors, which are changed; depth and ids; normals if outlines follow creases */
} EffectSamples;

/* Draws the effects into the colors of the band's rows, except its first band.above and last
 * band.below rows. If these are at least effects_reach() rows, or reach the edge of the picture,
 * the result does not depend on the band. The result does not depend on the number of threads.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status effects_draw(const EffectSamples *samples, Err *err);

/* Averages the colors of side x side samples to pixels, without the first band.above and the last
 * band.below rows. Stores the pixels in the rows of `color` from row `row` on; `color` has three
 * channels and is as wide as the image. */
void effects_reduce(const EffectSamples *samples, Plane *color, int row);

#endif
