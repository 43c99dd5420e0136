/* Pictures of the potential, tile by tile. */
#ifndef CORCAST_RENDER_FIELDRENDER_H
#define CORCAST_RENDER_FIELDRENDER_H

#include "render/engine.h"

/* Draws implicit models where they are, by proof; rays are asked for shadows, and for the colours
 * of all samples where raycolor_is_needed(). */
extern const Engine field_engine;

#endif
