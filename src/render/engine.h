/* An engine: one method of drawing a Drawing [job.h], such as tile by tile or ray by ray. render.c
 * selects the first engine of its list that supports the drawing, prepares it once per view, and
 * lets it draw the image band by band:
 *
 *     void *prepared = NULL;
 *     Status status = STATUS_OK;
 *     // once per view:
 *     if (engine->prepare)
 *         status = engine->prepare(engine->tiles, &drawing, &prepared, err);
 *     // once per band:
 *     if (status == STATUS_OK)
 *         status = engine->rows(&drawing, prepared, frame, err);
 *     if (prepared)
 *         engine->free(prepared);
 *
 * All engines are constants. One engine may draw several drawings at the same time. */
#ifndef CORCAST_RENDER_ENGINE_H
#define CORCAST_RENDER_ENGINE_H

#include "render/job.h"

/* An engine: a table of functions. */
typedef struct Engine {
    const char *name; /* name for statistics and messages, such as "raster" */
    /* For an engine that draws tile by tile: the functions that draw one tile [tile/tilerender.h].
     * NULL if the engine does not draw by tiles.
     *
     * Only engines that draw by tiles:
     * - write 8-bit sRGB codes instead of linear colors, if RenderParams.codes_suffice is true;
     * - skip the vessels of Drawing.hidden, which are thinner than a pixel, and blend Drawing.thin,
     *   which represents them, over the samples; for other engines both are NULL;
     * - answer shadow queries by TileEngine.shadows; other engines trace shadow rays. */
    const struct TileEngine *tiles;
    /* Returns true if the engine supports the drawing's geometry and view, and the parameters
     * select it. Does not read band, caster or appearance. */
    bool (*supports)(const Drawing *drawing);
    /* Returns true if the engine traces rays for this drawing; Drawing.caster must then not be
     * NULL. Reads the same fields as `supports`. NULL: the default. Engines that draw by tiles then
     * trace rays if shadowengine_needs_rays returns true; other engines trace none. */
    bool (*needs_rays)(const Drawing *drawing);
    /* Builds the data that all bands of a view share. The data do not depend on the appearance.
     * NULL: the engine needs no preparation.
     *
     * tiles     Engine.tiles.
     * prepared  receives the data; release it with `free`. Unchanged on failure.
     * Errors    STATUS_MEMORY; STATUS_USAGE if the engine cannot draw this view for a reason that
     *           `supports` does not test. No other engine is then tried. */
    Status (*prepare)(const struct TileEngine *tiles, const Drawing *drawing, void **prepared,
                      Err *err);
    /* Draws the drawing's band into the planes that `frame` has. `prepared` is the result of
     * `prepare` for the same view, or NULL if `prepare` is NULL. After an error the planes are
     * incomplete. Errors: STATUS_MEMORY; STATUS_CANCELLED if the progress callback returns
     * false. */
    Status (*rows)(const Drawing *drawing, void *prepared, Frame *frame, Err *err);
    /* Frees the result of `prepare`, which must not be NULL. The member is NULL if `prepare` is
     * NULL. */
    void (*free)(void *prepared);
} Engine;

/* Draws the x-ray effect of a view: colors only, one sample per pixel. Supports views with the
 * effect, if colors are wanted. */
extern const Engine xray_engine;

/* Draws implicit surfaces tile by tile, at their proven positions: the potential, unless POV-Ray's
 * cells are specified; and the blob, unless the method is RENDER_TRACE. It traces rays only in
 * these cases: for soft shadows, for lights that lightview_sees_all rejects, and for the colors of
 * all samples if raycolor_is_needed() returns true. */
extern const Engine field_engine;

/* Draws primitives tile by tile, in single precision: for RENDER_RASTER, and for RENDER_FASTEST if
 * the number of primitives and the size of the image are within the limits of rasterbins_supports.
 * Traces shadow rays only for lights that raster_shadows does not support: lights among the vessels
 * or next to them, and lights on the other side of the ground. */
extern const Engine raster_engine;

/* Draws primitives by sampling their surfaces into a depth buffer, as Neumann et al. do [N in
 * docs/METHODS.md]: for RENDER_ZBUFFER. Takes one sample per pixel and draws no shadows. `prepare`
 * returns STATUS_USAGE for a camera among the vessels. */
extern const Engine zbuffer_engine;

/* Draws every model with every option of a view, ray by ray. It is the last engine of the list, for
 * RENDER_TRACE and for drawings that no other engine supports. */
extern const Engine ray_engine;

#endif
