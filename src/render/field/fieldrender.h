/* Pictures of the potential, tile by tile. */
#ifndef CORCAST_RENDER_FIELDRENDER_H
#define CORCAST_RENDER_FIELDRENDER_H

#include "render/engine.h"

/* Draws implicit models where they are, by proof, but for blobs by RENDER_TRACE; rays are asked for
 * soft shadows and for lights that no view sees all from, and for the colors of all samples where
 * raycolor_is_needed(). */
extern const Engine field_engine;

#endif
