/* The colour that one ray of the camera sees. */
#ifndef CORCAST_RENDER_RAYCOLOR_H
#define CORCAST_RENDER_RAYCOLOR_H

#include "render/cast/caster.h"
#include "render/job.h"

/* What colours are made of. */
typedef struct RayColoring {
    const View *view;
    const Appearance *appearance;
    const RenderParams *params;
    Caster *caster; /* NULL: nothing is in the way of light */
} RayColoring;

/* Whether the picture needs what the kernels of tiles do not know: ambient occlusion, area lights
 * or ground. */
bool raycolor_is_needed(const View *view, const RenderParams *params);

/* The colour of what is seen along the ray of the sample (i, j): of `surfel`, what it meets first
 * of the vessels (NULL: none), of the ground where that is nearer, or of the background. */
Rgb ray_color(const RayColoring *with, int worker, Ray ray, double i, double j,
              const Surfel *surfel);

#endif
