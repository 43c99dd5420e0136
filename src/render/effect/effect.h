/* Fading, outlines, halos and a graded background [scene/effects.h], drawn over the samples of a
 * shaded image. The image is rendered at `side` x `side` samples per pixel. effects_draw changes
 * the colors of the samples, and effects_reduce averages them to pixels. */
#ifndef CORCAST_RENDER_EFFECT_EFFECT_H
#define CORCAST_RENDER_EFFECT_EFFECT_H

#include "base/base.h"
#include "image/image.h"
#include "render/job.h"
#include "scene/scene.h"

/* The radius of one vessel. */
typedef struct IdRadius {
    uint32_t id;
    float radius_mm; /* the largest radius of this id */
} IdRadius;

/* The radii of all vessels, by rising id. */
typedef struct RadiusTable {
    IdRadius *rows; /* owned */
    size_t n;
} RadiusTable;

/* Makes the table of a geometry; release it with radiustable_release. Errors: STATUS_MEMORY.
 * O(n log n). */
MUST_CHECK Status radiustable_make(const Geometry *geometry, RadiusTable *table, Err *err);
void radiustable_release(RadiusTable *table);
/* Returns the distance, in samples, up to which other samples change a sample. A pixel is `side`
 * samples wide. */
int effects_reach(const Effects *effects, int side);

/* The band of samples that effects are drawn on. All pointers are borrowed. */
typedef struct EffectSamples {
    /* The view with its effects, fade, background and camera. The pixels of the camera are the
     * samples. */
    const View *view;
    const RadiusTable *radii;
    int side; /* samples per pixel width */
    int threads;
    Band band;    /* rows of samples */
    Frame *frame; /* color, depth and ids; normals if outlines follow creases */
} EffectSamples;

/* Draws the effects into the colors of the band's rows, except the rows above and below. Those are
 * effects_reach() rows, or all rows up to the edge of the picture; then the result depends neither
 * on the band nor on the number of threads. Errors: STATUS_MEMORY. */
MUST_CHECK Status effects_draw(const EffectSamples *samples, Err *err);

/* Averages the colors of side x side samples to pixels. Leaves out the rows above and below the
 * band. Writes the pixels to the rows of `color` from row `row` on; `color` has three channels and
 * is as wide as the image. */
void effects_reduce(const EffectSamples *samples, Plane *color, int row);

#endif
