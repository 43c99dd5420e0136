/* Ambient occlusion of one point, by rays: the ambient visibility with RENDER_TRACE. */
#ifndef CORCAST_RENDER_LIGHT_RAYOCCLUSION_H
#define CORCAST_RENDER_LIGHT_RAYOCCLUSION_H

#include "render/cast/caster.h"

/* Returns the ambient visibility of a point, 0..1: the fraction of rays from the point that hit
 * neither a vessel nor the ground. The directions are distributed as the cosine to the normal.
 * O(rays) shadow rays. Source: METHODS section 3.1.
 *
 * worker   index of the calling thread [caster.h].
 * point    mm, world coordinates.
 * normal   unit.
 * rays     number of rays, 1 or more.
 * turn     fraction of a full turn by which the directions are turned about the normal. */
double rayocclusion_ambient(Caster *caster, int worker, const Ground *ground, Vec3 point,
                            Vec3 normal, int rays, double turn);

/* Returns the turn, 0..1, for the sample at (i, j) of the image, in pixels. Neighbours differ as
 * much as possible. Source: J. Jimenez: Next generation post processing in Call of Duty: Advanced
 * Warfare, SIGGRAPH 2014. */
double rayocclusion_turn(double i, double j);

#endif
