/* A way of drawing pictures. */
#ifndef CORCAST_RENDER_ENGINE_H
#define CORCAST_RENDER_ENGINE_H

#include "render/job.h"

typedef struct Engine {
    const char *name;  /* that of the method, where there is one */
    bool writes_codes; /* may make 8-bit codes instead of colors [RenderParams.codes_suffice] */
    bool draws_thin;   /* leaves out hidden vessels, and draws Drawing.thin over its samples */
    /* Whether the engine can draw this, and is asked to; band, caster and appearance do not matter.
     */
    bool (*supports)(const Drawing *drawing);
    /* Likewise whether it asks for rays: then the drawing is to have a caster. */
    bool (*needs_rays)(const Drawing *drawing);
    /* Makes in *prepared (owned) what all bands of a view have in common, whatever the appearance;
     * NULL: nothing. *prepared is unchanged on failure. STATUS_MEMORY; STATUS_USAGE when the engine
     * cannot draw this view after all. */
    Status (*prepare)(const Drawing *drawing, void **prepared, Err *err);
    /* Draws the band into planes that are there. STATUS_MEMORY. */
    Status (*rows)(const Drawing *drawing, void *prepared, Frame *frame, Err *err);
    /* Frees what was prepared; NULL where nothing is. */
    void (*free)(void *prepared);
    /* Answers shadow queries [render/light/shadowengine.h]; NULL: shadow rays are traced. */
    const struct ShadowEngine *shadows;
    /* Returns the light bins that were prepared for light `light` of the view and for points in the
     * frame of the camera; NULL: there are none. The function is NULL if `shadows` is. */
    struct LightBins *(*light_bins)(const void *prepared, size_t light);
} Engine;

#endif
