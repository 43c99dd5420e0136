/* Pictures of primitives by sampled surfaces and a depth buffer, as the paper draws them [N,
 * section 3]. */
#ifndef CORCAST_RENDER_ZBUFFER_H
#define CORCAST_RENDER_ZBUFFER_H

#include "render/engine.h"

/* Draws what RENDER_ZBUFFER asks for: one sample a pixel, without shadows. Cannot prepare a view
 * from among the vessels. */
extern const Engine zbuffer_engine;

#endif
