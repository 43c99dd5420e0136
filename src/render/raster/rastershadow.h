/* Answers shadow queries among primitives [render/light/shadowengine.h]. */
#ifndef CORCAST_RENDER_RASTER_RASTERSHADOW_H
#define CORCAST_RENDER_RASTER_RASTERSHADOW_H

#include "render/light/shadowengine.h"

/* Supports every light for which lightview_sees_all is true. A point is in shadow if a primitive is
 * between the point and the light. The primitive must be nearer to the light than the point by more
 * than 0.001 mm, POV-Ray's limit, plus the rounding error of the light view. ShadowPoints.item is
 * as in RasterHits: a sphere or cylinder whose hit was found in single precision does not shadow
 * its own points. */
extern const ShadowEngine raster_shadows;

#endif
