/* Pictures ray by ray: of any model, with all that a view may have. */
#ifndef CORCAST_RENDER_RAYRENDER_H
#define CORCAST_RENDER_RAYRENDER_H

#include "render/engine.h"

extern const Engine ray_engine;

#endif
