/* One primitive as a view sees it. */
#ifndef CORCAST_RENDER_RASTERITEM_H
#define CORCAST_RENDER_RASTERITEM_H

#include "render/rasterview.h"

/* The item of a scene's primitive. joints[joint] is set if the item is a RASTER_JOINT. */
RasterItem rasteritem_make(const Scene *scene, const RasterView *view, uint32_t number,
                           uint32_t joint, RasterJoint *joints);

#endif
