/* The colour that one ray of the camera sees. */
#ifndef CORCAST_RENDER_RAYCOLOR_H
#define CORCAST_RENDER_RAYCOLOR_H

#include "render/cast/caster.h"
#include "render/job.h"

/* Whether a picture needs ray_color: it has ambient occlusion, area lights with shadows, or ground,
 * of which the kernels of tiles know nothing. */
bool raycolor_is_needed(const View *view, const RenderParams *params);

/* The linear colour seen along the ray of the sample (i, j) of the drawing: of a vessel if
 * `surfel`, the first point of a vessel that the ray meets (NULL: none), is nearer than the ground;
 * else of the ground, or of the background. The drawing's caster may be NULL if neither shadows nor
 * occlusion are wanted; `worker` is the calling thread's number [caster.h]. */
Rgb ray_color(const Drawing *drawing, int worker, Ray ray, double i, double j,
              const Surfel *surfel);

#endif
