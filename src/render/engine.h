/* An engine: one method of drawing a Drawing [job.h], such as tile by tile or ray by ray. render.c
 * takes the first engine of its list that supports the drawing, prepares it once per view, and lets
 * it draw the image band by band:
 *
 *     void *prepared = NULL;
 *     Status status = STATUS_OK;
 *     if (engine->prepare)                                                  once per view
 *         status = engine->prepare(&drawing, &prepared, err);
 *     if (status == STATUS_OK)
 *         status = engine->rows(&drawing, prepared, frame, err);            once per band
 *     if (prepared)
 *         engine->free(prepared);
 *
 * All engines are constants. The caller may use one engine for several drawings at once. */
#ifndef CORCAST_RENDER_ENGINE_H
#define CORCAST_RENDER_ENGINE_H

#include "render/job.h"

typedef struct Engine {
    const char *name;  /* name for statistics and messages, such as "raster" */
    bool writes_codes; /* can write 8-bit sRGB codes instead of linear float colors
                        * [RenderParams.codes_suffice] */
    bool draws_thin;   /* leaves out the vessels of Drawing.hidden, which are thinner than a pixel,
                        * and blends Drawing.thin, which stands for them, over the samples. If
                        * false, render.c sets neither */
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
     * Errors    STATUS_MEMORY; STATUS_USAGE if the view has a fault that `supports` does not look
     *           for. No other engine is then tried. */
    Status (*prepare)(const Drawing *drawing, void **prepared, Err *err);
    /* Draws the drawing's band into the planes that `frame` has. `prepared` is the result of
     * `prepare` for the same view, or NULL if `prepare` is NULL. After an error the planes are
     * incomplete. Errors: STATUS_MEMORY; STATUS_CANCELLED if the progress callback returns
     * false. */
    Status (*rows)(const Drawing *drawing, void *prepared, Frame *frame, Err *err);
    /* Frees the result of `prepare`, which is not NULL. The member is NULL if `prepare` is. */
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
