/* The engine that draws primitives tile by tile, in single precision. */
#ifndef CORCAST_RENDER_RASTER_RASTERRENDER_H
#define CORCAST_RENDER_RASTER_RASTERRENDER_H

#include "render/engine.h"

/* Supports geometries of primitives. Used for RENDER_RASTER, and for RENDER_FASTEST if the number
 * of primitives and the size of the image are within the limits of rasterbins_take. Traces shadow
 * rays only for lights that raster_shadows does not support: lights among the vessels or next to
 * them, and lights on the other side of the ground. */
extern const Engine raster_engine;

#endif
