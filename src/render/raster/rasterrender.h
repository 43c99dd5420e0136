/* Pictures of primitives, tile by tile. */
#ifndef CORCAST_RENDER_RASTERRENDER_H
#define CORCAST_RENDER_RASTERRENDER_H

#include "render/engine.h"

/* Draws what RENDER_RASTER asks for; rays are asked by lights that are among the vessels or next to
 * them. */
extern const Engine raster_engine;

#endif
