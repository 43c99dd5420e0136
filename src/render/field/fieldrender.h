/* The engine that draws implicit models (potential and blob), tile by tile. */
#ifndef CORCAST_RENDER_FIELD_FIELDRENDER_H
#define CORCAST_RENDER_FIELD_FIELDRENDER_H

#include "render/engine.h"

/* Supports the potential, unless POV-Ray's cells are specified, and the blob, unless the method is
 * RENDER_TRACE. Surfaces are drawn at their proven positions. Traces rays only for soft shadows,
 * for lights that lightview_sees_all rejects, and for the colors of all samples if
 * raycolor_is_needed() returns true. */
extern const Engine field_engine;

#endif
