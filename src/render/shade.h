/* The one shading model: POV-Ray's finish under its lights, METHODS section 3. */
#ifndef CORCAST_RENDER_SHADE_H
#define CORCAST_RENDER_SHADE_H

#include "geom/geom.h"
#include "scene/scene.h"

/* Tells whether anything stands between `point` and a light in direction `towards` (unit) at
 * `distance` mm. */
typedef bool ShadowTest(void *context, Vec3 point, Vec3 towards, double distance);

/* The colour seen along `direction` (unit) at a point whose normal (unit) faces the viewer.
 * `shadow` may be NULL: no shadows. */
Rgb shade(const Scene *scene, Rgb pigment, Vec3 point, Vec3 normal, Vec3 direction,
          ShadowTest *shadow, void *context);

#endif
