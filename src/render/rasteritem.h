/* One primitive as a view sees it. */
#ifndef CORCAST_RENDER_RASTERITEM_H
#define CORCAST_RENDER_RASTERITEM_H

#include "render/rasterview.h"

/* Makes the item of a scene's primitive, but for its tiles and box. joints[joint] is set if it is a
 * RASTER_JOINT. */
void rasteritem_make(const Scene *scene, const RasterView *view, uint32_t number, uint32_t joint,
                     RasterJoint *joints, RasterItem *item);

#endif
