/* The engine that draws primitives by sampling their surfaces into a depth buffer, as the paper
 * does [N, section 3]. */
#ifndef CORCAST_RENDER_RASTER_ZBUFFER_H
#define CORCAST_RENDER_RASTER_ZBUFFER_H

#include "render/engine.h"

/* Used for RENDER_ZBUFFER. Takes one sample per pixel and draws no shadows. `prepare` returns
 * STATUS_USAGE for a camera among the vessels. */
extern const Engine zbuffer_engine;

#endif
