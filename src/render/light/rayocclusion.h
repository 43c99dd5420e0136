/* Ambient occlusion of one point, by rays. */
#ifndef CORCAST_RENDER_LIGHT_RAYOCCLUSION_H
#define CORCAST_RENDER_LIGHT_RAYOCCLUSION_H

#include "render/cast/caster.h"

/* Returns the ambient visibility of a point, 0..1: the part of `rays` (at least 1) rays from it
 * that hit neither a vessel nor the ground. The directions are distributed as the cosine to
 * `normal` (unit), and turned about the normal by `turn`, a part of a full turn. O(rays) shadow
 * rays. Source: METHODS section 3.1. */
double rayocclusion_ambient(Caster *caster, int worker, const Ground *ground, Vec3 point,
                            Vec3 normal, int rays, double turn);

/* Returns the turn of the sample at (i, j) of the image, 0..1. Neighbours differ as much as
 * possible. Source: J. Jimenez: Next generation post processing in Call of Duty: Advanced Warfare,
 * SIGGRAPH 2014. */
double rayocclusion_turn(double i, double j);

#endif
