/* An engine: one method of drawing a Drawing [job.h], such as tile by tile or ray by ray. render.c
 * takes the first engine of its list that supports the drawing, prepares it once per view, and lets
 * it draw the image band by band:
 *
 *     void *prepared = NULL;
 *     Status status = STATUS_OK;
 *     if (engine->prepare)                                                  once per view
 *         status = engine->prepare(engine->tiles, &drawing, &prepared, err);
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
    const char *name; /* name for statistics and messages, such as "raster" */
    /* The functions that draw one tile, of an engine that draws tile by tile [tile/tilerender.h];
     * NULL: another engine. Only an engine of tiles can do the following. It writes 8-bit sRGB
     * codes instead of linear float colors, if RenderParams.codes_suffice is true. It leaves out
     * the vessels of Drawing.hidden, which are thinner than a pixel, and blends Drawing.thin, which
     * stands for them, over the samples; for another engine, both are NULL. It answers shadow
     * queries by TileEngine.shadows; for another engine, shadow rays are traced. */
    const struct TileEngine *tiles;
    /* Returns true if the engine supports the drawing's geometry and view, and the parameters
     * select it. Does not read band, caster or appearance. */
    bool (*supports)(const Drawing *drawing);
    /* Returns true if the engine traces rays for this drawing; Drawing.caster must then not be
     * NULL. Reads the same fields as `supports`. NULL: shadowengine_needs_rays decides for an
     * engine of tiles; another engine traces no rays. */
    bool (*needs_rays)(const Drawing *drawing);
    /* Prepares a view: builds the data that all bands of the view share. The data do not depend on
     * the appearance. NULL: the engine needs no preparation.
     *
     * tiles     Engine.tiles.
     * prepared  receives the data; release it with `free`. Unchanged on failure.
     * Errors    STATUS_MEMORY; STATUS_USAGE if the view has a fault that `supports` does not look
     *           for. No other engine is then tried. */
    Status (*prepare)(const struct TileEngine *tiles, const Drawing *drawing, void **prepared,
                      Err *err);
    /* Draws the drawing's band into the planes that `frame` has. `prepared` is the result of
     * `prepare` for the same view, or NULL if `prepare` is NULL. After an error the planes are
     * incomplete. Errors: STATUS_MEMORY; STATUS_CANCELLED if the progress callback returns
     * false. */
    Status (*rows)(const Drawing *drawing, void *prepared, Frame *frame, Err *err);
    /* Frees the result of `prepare`, which is not NULL. The member is NULL if `prepare` is. */
    void (*free)(void *prepared);
} Engine;

/* Draws the x-ray effect of a view, if colors are wanted: colors only, one sample per pixel. */
extern const Engine xray_engine;

/* Draws implicit models tile by tile, at their proven positions: the potential, unless POV-Ray's
 * cells are specified, and the blob, unless the method is RENDER_TRACE. Traces rays only for soft
 * shadows, for lights that lightview_sees_all rejects, and for the colors of all samples if
 * raycolor_is_needed() returns true. */
extern const Engine field_engine;

/* Draws primitives tile by tile, in single precision: for RENDER_RASTER, and for RENDER_FASTEST if
 * the number of primitives and the size of the image are within the limits of rasterbins_supports.
 * Traces shadow rays only for lights that raster_shadows does not support: lights among the vessels
 * or next to them, and lights on the other side of the ground. */
extern const Engine raster_engine;

/* Draws primitives by sampling their surfaces into a depth buffer, as the paper does [N, section
 * 3]: for RENDER_ZBUFFER. Takes one sample per pixel and draws no shadows. `prepare` returns
 * STATUS_USAGE for a camera among the vessels. */
extern const Engine zbuffer_engine;

/* Draws everything, ray by ray: every model and every option of a view. It comes last, where no
 * other engine supports the drawing or RENDER_TRACE is asked for. */
extern const Engine ray_engine;

#endif
