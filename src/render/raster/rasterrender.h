/* Pictures of primitives, tile by tile. */
#ifndef CORCAST_RENDER_RASTERRENDER_H
#define CORCAST_RENDER_RASTERRENDER_H

#include "render/cast/caster.h"
#include "render/job.h"
#include "render/raster/rastershadow.h"
#include "render/raster/rasterview.h"

/* What the camera and the lights see of a scene of primitives. Zeroed before the first band, kept
 * from band to band while camera, lights and antialiasing stay. */
typedef struct RasterPrepared {
    RasterBins *bins;       /* owned; of the whole picture; NULL: nothing is made yet */
    RasterShadow **shadows; /* owned; one a light; NULL where it casts none, or rays do */
    size_t n_lights;
    Caster *caster; /* owned; for lights too near for a view of their own; NULL without */
} RasterPrepared;

/* Draws the band of a scene of primitives into planes that are there, and adds the time it takes to
 * *stats. Makes *prepared if it is not made yet. */
MUST_CHECK Status rasterrender(const Scene *scene, const RenderParams *params, const Band *band,
                               RasterPrepared *prepared, Frame *frame, RenderStats *stats,
                               Err *err);

/* Leaves *prepared zeroed. */
void rasterprepared_release(RasterPrepared *prepared);

#endif
