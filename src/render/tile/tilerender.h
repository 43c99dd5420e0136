/* The pipeline of the engines that draw an image tile by tile. */
#ifndef CORCAST_RENDER_TILERENDER_H
#define CORCAST_RENDER_TILERENDER_H

#include "render/tile/tileengine.h"

/* The functions of an Engine [render/engine.h], given the engine of the tiles. The drawing must
 * have a caster if shadowengine_needs_rays returns true. */
MUST_CHECK Status tilerender_prepare(const TileEngine *engine, const Drawing *drawing,
                                     void **prepared, Err *err);
MUST_CHECK Status tilerender_rows(const Drawing *drawing, void *prepared, Frame *frame, Err *err);
void tilerender_free(void *prepared);
LightBins *tilerender_light_bins(const void *prepared, size_t light);

#endif
