/* Fading, outlines and halos: what neighbouring samples of a shaded picture add to it. */
#ifndef CORCAST_RENDER_EFFECT_H
#define CORCAST_RENDER_EFFECT_H

#include "base/base.h"
#include "image/image.h"
#include "render/job.h"
#include "scene/scene.h"

typedef struct IdRadius {
    uint32_t id;
    float radius_mm; /* the largest of that id */
} IdRadius;

/* The radius of each vessel, by rising id. */
typedef struct RadiusTable {
    IdRadius *rows; /* owned */
    size_t n;
} RadiusTable;

/* STATUS_MEMORY. O(n log n). */
MUST_CHECK Status radiustable_make(const Geometry *geometry, RadiusTable *table, Err *err);
void radiustable_release(RadiusTable *table);
/* 0 where the id is not in the table. O(log n). */
double radiustable_find(const RadiusTable *table, uint32_t id);

/* How many samples from a sample what it becomes is decided, if `side` samples make a pixel's
 * width. */
int effects_reach(const Effects *effects, int side);

/* What effects are drawn on: a band of samples, `side` x `side` to a pixel, the camera being that
 * of the samples. The frame has colour, depth, ids, and normals where there are creases. */
typedef struct EffectSamples {
    const Effects *effects;
    const Camera *camera;
    const RadiusTable *radii;
    Rgb paper;
    int side, threads;
    Band band;
    Frame *frame;
} EffectSamples;

/* Draws the effects into the colours of the band's rows, but for those above and below, which have
 * to be effects_reach() or reach the edge of the picture: the same bytes whatever the band and the
 * number of threads. STATUS_MEMORY. */
MUST_CHECK Status effects_draw(const EffectSamples *samples, Err *err);

/* The colours of `side` x `side` samples become their mean, that of one pixel: rows of the frame,
 * those above and below left out, into the rows of `color` from `row` on. */
void effects_reduce(const EffectSamples *samples, Plane *color, int row);

#endif
