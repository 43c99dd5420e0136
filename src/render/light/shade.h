/* The one shading model: POV-Ray's finish under its lights, METHODS section 3. */
#ifndef CORCAST_RENDER_SHADE_H
#define CORCAST_RENDER_SHADE_H

#include "geom/geom.h"
#include "scene/scene.h"

/* A surface is lit where the cosine between its normal and the direction to the light is at least
 * this [docs/METHODS.md section 3]. */
#define LEAST_LIT_COSINE 1e-10

/* Tells whether anything stands between `point` and a light in direction `towards` (unit) at
 * `distance` mm. */
typedef bool ShadowTest(void *context, Vec3 point, Vec3 towards, double distance);

/* What is seen at a point. */
typedef struct ShadePoint {
    const Finish *finish;
    Rgb pigment;
    Vec3 point;
    Vec3 normal;    /* unit, facing the viewer */
    Vec3 direction; /* unit, of the ray that sees it */
    double open;    /* the part of the ambient light that reaches it */
} ShadePoint;

/* The colour of a point in the lights of the view. `shadow` may be NULL: no shadows. */
Rgb shade(const View *view, const ShadePoint *at, ShadowTest *shadow, void *context);

#endif
