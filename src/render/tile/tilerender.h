/* The pipeline of the engines that draw an image tile by tile. */
#ifndef CORCAST_RENDER_TILERENDER_H
#define CORCAST_RENDER_TILERENDER_H

#include "render/tile/tileengine.h"

/* The functions of an Engine [render/engine.h], given the engine of the tiles. The drawing must
 * have a caster if tilerender_needs_rays returns true. */
bool tilerender_needs_rays(const Drawing *drawing, const LightViews *lights);
MUST_CHECK Status tilerender_prepare(const TileEngine *engine, const Drawing *drawing,
                                     void **prepared, Err *err);
MUST_CHECK Status tilerender_rows(const Drawing *drawing, void *prepared, Frame *frame, Err *err);
void tilerender_free(void *prepared);
const void *tilerender_shadow(const void *prepared, size_t light);

/* Returns true if hard shadows of the light come from a light view, not from rays. False for lights
 * that cast no shadows and for area lights. */
bool tilerender_uses_view(const Drawing *drawing, const LightViews *lights, const Light *light);

#endif
