/* Pictures of primitives, tile by tile. */
#ifndef CORCAST_RENDER_RASTERRENDER_H
#define CORCAST_RENDER_RASTERRENDER_H

#include "render/cast/caster.h"
#include "render/job.h"
#include "render/raster/rastershadow.h"
#include "render/raster/rasterview.h"

/* What the camera and the lights of a view see of primitives. Zeroed before the first band, kept
 * from band to band while camera, lights and antialiasing stay. */
typedef struct RasterPrepared {
    RasterBins *bins;       /* owned; of the whole picture; NULL: nothing is made yet */
    RasterShadow **shadows; /* owned; one a light; NULL where it casts none, or rays do */
    size_t n_lights;
} RasterPrepared;

/* Draws a band of primitives into planes that are there, and adds the time it takes to *stats. The
 * drawing has a caster if rastershadows_need_rays(). Makes *prepared if it is not made yet. */
MUST_CHECK Status rasterrender(const Drawing *drawing, RasterPrepared *prepared, Frame *frame,
                               RenderStats *stats, Err *err);

/* Leaves *prepared zeroed. */
void rasterprepared_release(RasterPrepared *prepared);

#endif
