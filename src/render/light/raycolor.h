/* Computes the color of one camera ray, for engines that trace single rays and for features that
 * the kernels of tiles do not support. */
#ifndef CORCAST_RENDER_LIGHT_RAYCOLOR_H
#define CORCAST_RENDER_LIGHT_RAYCOLOR_H

#include "render/cast/caster.h"
#include "render/job.h"

/* Returns true if a picture needs ray_color because the kernels of tiles do not support one of its
 * features: ambient occlusion, area lights with shadows, or a ground plane. */
bool raycolor_is_needed(const View *view, const RenderParams *params);

/* Returns the linear color of `ray`, the camera ray through the sample at column i and row j of the
 * drawing. The nearer of vessel and ground plane is shaded; if the ray misses both, the result is
 * the background.
 *
 * surfel   the ray's first hit of a vessel; NULL: none.
 * worker   index of the calling thread [caster.h].
 *
 * The drawing's caster may be NULL if neither shadows nor occlusion are wanted. */
Rgb ray_color(const Drawing *drawing, int worker, Ray ray, double i, double j,
              const Surfel *surfel);

/* Stores a pixel of the drawing's band in those planes that `frame` has: color, depth, normal and
 * id of the ray through the pixel's centre. `surfel` and `worker` are as in ray_color.
 *
 * column, row   position of the pixel; row 0 is the first of the band. */
void raycolor_store(const Drawing *drawing, int worker, int column, int row, const Surfel *surfel,
                    Frame *frame);

#endif
