/* The color of one camera ray. */
#ifndef CORCAST_RENDER_LIGHT_RAYCOLOR_H
#define CORCAST_RENDER_LIGHT_RAYCOLOR_H

#include "render/cast/caster.h"
#include "render/job.h"

/* Returns true if a picture needs ray_color: it has ambient occlusion, area lights with shadows, or
 * a ground plane, which the kernels of tiles do not support. */
bool raycolor_is_needed(const View *view, const RenderParams *params);

/* Returns the linear color of the camera ray through the sample (i, j) of the drawing.
 *
 * surfel   the ray's first hit of a vessel; NULL: none. The vessel is drawn if it is nearer than
 *          the ground plane; otherwise the ground is drawn, or the background if the ray misses
 *          both.
 * worker   index of the calling thread [caster.h].
 *
 * The drawing's caster may be NULL if neither shadows nor occlusion are wanted. */
Rgb ray_color(const Drawing *drawing, int worker, Ray ray, double i, double j,
              const Surfel *surfel);

/* Stores the planes that `frame` has of a pixel of the drawing's band: color, depth, normal and id
 * of the ray through the pixel's centre. `surfel` and `worker` are those of ray_color.
 *
 * column, row   of the pixel; row 0 is the first of the band. */
void raycolor_store(const Drawing *drawing, int worker, int column, int row, const Surfel *surfel,
                    Frame *frame);

#endif
