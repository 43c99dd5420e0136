/* One primitive as a view sees it. */
#ifndef CORCAST_RENDER_RASTERITEM_H
#define CORCAST_RENDER_RASTERITEM_H

#include "render/raster/rasterview.h"

/* Makes the item of a primitive of the scene, but for its tiles and box. Number `joint` of the
 * bins' joints or hulls is set if it is a RASTER_JOINT. */
void rasteritem_make(const RasterBins *bins, uint32_t number, uint32_t joint, RasterItem *item);

#endif
