/* The colour that one ray of the camera sees. */
#ifndef CORCAST_RENDER_SIGHT_H
#define CORCAST_RENDER_SIGHT_H

#include "render/cast/caster.h"
#include "render/job.h"

/* What colours are made of. */
typedef struct Sight {
    const View *view;
    const Appearance *appearance;
    const RenderParams *params;
    Caster *caster; /* NULL: nothing is in the way of light */
} Sight;

/* Whether the picture needs what the kernels of tiles do not know: ambient occlusion, area lights
 * or ground. */
bool sight_is_needed(const View *view, const RenderParams *params);

/* The colour of what is seen along the ray of the sample (i, j): of `surfel`, what it meets first
 * of the vessels (NULL: none), of the ground where that is nearer, or of the background. */
Rgb sight_color(const Sight *sight, int worker, Ray ray, double i, double j, const Surfel *surfel);

#endif
