/* Ambient occlusion: the part of the sky that the places of a picture see. */
#ifndef CORCAST_RENDER_OCCLUSION_H
#define CORCAST_RENDER_OCCLUSION_H

#include "render/light/occluders.h"
#include "render/light/visibility.h"

/* Sets light->ambient (owned by *light even when this fails) by `drawing->params->occlusion` beams.
 * `light` has places and numbers; its first row is even. What a place sees depends on those up to
 * VISIBILITY_MARGIN rows above it and below. STATUS_MEMORY. */
MUST_CHECK Status occlusion_compute(const Drawing *drawing, const OccluderSet *beams,
                                    PixelVisibility *light, Err *err);

#endif
