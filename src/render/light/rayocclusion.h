/* Ambient occlusion: how much of the sky a point sees. */
#ifndef CORCAST_RENDER_RAYOCCLUSION_H
#define CORCAST_RENDER_RAYOCCLUSION_H

#include "render/cast/caster.h"

/* The part, from 0 to 1, of `rays` (at least 1) rays from the point that meet neither a vessel nor
 * the ground. Their directions are distributed as the cosine to `normal` (unit), and turned about
 * it by `turn`, a part of a full turn. O(rays) questions to the caster. METHODS section 3.1. */
double rayocclusion_ambient(Caster *caster, int worker, const Ground *ground, Vec3 point,
                            Vec3 normal, int rays, double turn);

/* The turn of the sample at (i, j) of the picture, from 0 to 1: neighbours differ as much as they
 * can. J. Jimenez: Next generation post processing in Call of Duty: Advanced Warfare, SIGGRAPH
 * 2014. */
double rayocclusion_turn(double i, double j);

#endif
