/* The engine that traces each ray separately. It draws every model and supports every option of a
 * view. It draws where no engine of tiles can, or RENDER_TRACE is asked for. */
#ifndef CORCAST_RENDER_LIGHT_RAYRENDER_H
#define CORCAST_RENDER_LIGHT_RAYRENDER_H

#include "render/engine.h"

extern const Engine ray_engine;

#endif
