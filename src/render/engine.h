/* An engine: one method of drawing a Drawing [job.h], such as tile by tile or ray by ray. render.c
 * takes the first engine of its list that supports the drawing, prepares it once per view, and lets
 * it draw the image band by band:
 *
 *     void *prepared = NULL;
 *     if (engine->supports(&drawing)) {
 *         TRY(engine->prepare(&drawing, &prepared, err));     once per view
 *         TRY(engine->rows(&drawing, prepared, frame, err));  once per band
 *         engine->free(prepared);
 *     }
 *
 * All engines are constants. The caller may use one engine for several drawings at once. */
#ifndef CORCAST_RENDER_ENGINE_H
#define CORCAST_RENDER_ENGINE_H

#include "render/job.h"

typedef struct Engine {
    const char *name;  /* name for statistics and messages, such as "raster" */
    bool writes_codes; /* can write 8-bit sRGB codes instead of linear float colors
                        * [RenderParams.codes_suffice] */
    bool draws_thin;   /* leaves out the vessels of Drawing.hidden, and draws Drawing.thin over its
                        * samples */
    /* Returns true if the engine supports the drawing's geometry and view, and the parameters
     * select it. Does not read band, caster or appearance. */
    bool (*supports)(const Drawing *drawing);
    /* Returns true if the engine traces rays for this drawing; Drawing.caster must then not be
     * NULL. Reads the same fields as `supports`. */
    bool (*needs_rays)(const Drawing *drawing);
    /* Prepares a view: builds the data that all bands of the view share. The data do not depend on
     * the appearance. NULL: the engine needs no preparation.
     *
     * prepared  receives the data; release it with `free`. Unchanged on failure.
     * Errors    STATUS_MEMORY; STATUS_USAGE if the engine cannot draw this view after all. */
    Status (*prepare)(const Drawing *drawing, void **prepared, Err *err);
    /* Draws the drawing's band into the planes that `frame` has. `prepared` is the result of
     * `prepare` for the same view, or NULL. Errors: STATUS_MEMORY; STATUS_CANCELLED if the progress
     * callback asks to stop. */
    Status (*rows)(const Drawing *drawing, void *prepared, Frame *frame, Err *err);
    /* Frees the result of `prepare`; NULL if the engine has no `prepare`. */
    void (*free)(void *prepared);
    /* Answers shadow queries [render/light/shadowengine.h]; NULL: shadow rays are traced
     * instead. */
    const struct ShadowEngine *shadows;
    /* Returns the light bins of light `light` (an index in View.lights) from `prepared`, for points
     * in the frame of the camera. Borrowed. NULL: none were prepared. The function pointer is NULL
     * if `shadows` is NULL. */
    struct LightBins *(*light_bins)(const void *prepared, size_t light);
} Engine;

#endif
