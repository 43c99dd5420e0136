/* Soft shadows: the visibility of area lights at the pixels of a band. */
#ifndef CORCAST_RENDER_LIGHT_AREALIGHTS_H
#define CORCAST_RENDER_LIGHT_AREALIGHTS_H

#include "render/light/pixelpoints.h"

/* Sets visibility->lights[i] for each area light i of the view that casts shadows, and the
 * visibility of those lights at sources->off_pixel. `points` belong to `visibility` and have sample
 * sets. Errors: STATUS_MEMORY. */
MUST_CHECK Status arealights_compute(const Drawing *drawing, const VisibilitySources *sources,
                                     PixelPoints *points, PixelVisibility *visibility, Err *err);

#endif
