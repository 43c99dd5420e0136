/* Computes the ambient visibility of one point by tracing rays, for RENDER_TRACE. */
#ifndef CORCAST_RENDER_LIGHT_RAYOCCLUSION_H
#define CORCAST_RENDER_LIGHT_RAYOCCLUSION_H

#include "render/cast/caster.h"

/* Returns the ambient visibility of a point, 0 to 1: the fraction of rays from the point that hit
 * neither a vessel nor the ground. The rays have no maximum length. The density of their directions
 * is proportional to the cosine of the angle to the normal. Blockers very near the point are
 * ignored [caster_set_shadow_nearest, caster.h].
 *
 * worker   index of the calling thread [caster.h].
 * ground   as in caster_shadow [caster.h].
 * point    mm, world coordinates.
 * normal   unit vector.
 * rays     number of rays, 1 or more.
 * turn     angle by which the directions are rotated about the normal, as a fraction of a full
 *          turn.
 * Cost     `rays` calls of caster_shadow.
 * Source   METHODS section 3.1. */
double rayocclusion_ambient(Caster *caster, int worker, const Ground *ground, Vec3 point,
                            Vec3 normal, int rays, double turn);

/* Returns the parameter `turn` of rayocclusion_ambient, 0 to 1, for the sample at column i and row
 * j of the image, in pixels. Neighbouring pixels have turns that differ as much as possible.
 * Source: J. Jimenez: Next generation post processing in Call of Duty: Advanced Warfare, SIGGRAPH
 * 2014. */
double rayocclusion_turn(double i, double j);

#endif
