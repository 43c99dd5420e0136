/* Pictures of primitives, tile by tile. */
#ifndef CORCAST_RENDER_RASTERRENDER_H
#define CORCAST_RENDER_RASTERRENDER_H

#include "render/band.h"
#include "render/render.h"

/* Draws the band of a scene of primitives into planes that are there, and adds the time it takes to
 * *stats. */
MUST_CHECK Status rasterrender(const Scene *scene, const RenderParams *params, const Band *band,
                               Frame *frame, RenderStats *stats, Err *err);

#endif
