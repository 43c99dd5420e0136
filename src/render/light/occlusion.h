/* Ambient occlusion: the ambient visibility of the pixels of a band. */
#ifndef CORCAST_RENDER_LIGHT_OCCLUSION_H
#define CORCAST_RENDER_LIGHT_OCCLUSION_H

#include "render/light/occluders.h"
#include "render/light/visibility.h"

/* Computes the ambient visibility of all pixels with a hit, by drawing->params->occlusion occlusion
 * directions: sets visibility->ambient (owned by *visibility, even after an error). Shading points
 * and point_index must be set, and first_row must be even. The ambient visibility of a pixel
 * depends on the shading points up to three rows above and below. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status occlusion_compute(const Drawing *drawing, const OccluderSet *occluders,
                                    PixelVisibility *visibility, Err *err);

#endif
