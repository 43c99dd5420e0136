/* The pipeline of the engines that draw an image tile by tile. */
#ifndef CORCAST_RENDER_TILE_TILERENDER_H
#define CORCAST_RENDER_TILE_TILERENDER_H

#include "render/tile/tileengine.h"

/* Functions for the members prepare, rows, free and light_bins of an Engine, with the contracts of
 * render/engine.h. `engine` contains the functions that draw one tile; it is borrowed until
 * tilerender_free. The drawing must have a caster if shadowengine_needs_rays returns true for
 * it. */
MUST_CHECK Status tilerender_prepare(const TileEngine *engine, const Drawing *drawing,
                                     void **prepared, Err *err);
MUST_CHECK Status tilerender_rows(const Drawing *drawing, void *prepared, Frame *frame, Err *err);
void tilerender_free(void *prepared);
LightBins *tilerender_light_bins(const void *prepared, size_t light);

#endif
