/* Ambient occlusion: the part of the sky that the places of a picture see. */
#ifndef CORCAST_RENDER_SKYLIGHT_H
#define CORCAST_RENDER_SKYLIGHT_H

#include "render/light/sharedlight.h"
#include "render/sky/beams.h"

/* Sets light->open (owned by *light even when this fails) by `drawing->params->occlusion` beams.
 * `light` has places and numbers; its first row is even. What a place sees depends on those up to
 * SHARE_MARGIN rows above it and below. STATUS_MEMORY. */
MUST_CHECK Status skylight_find(const Drawing *drawing, const Beams *beams, SharedLight *light,
                                Err *err);

#endif
