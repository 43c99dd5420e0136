/* The one shading model: POV-Ray's finish under its lights, METHODS section 3. */
#ifndef CORCAST_RENDER_SHADE_H
#define CORCAST_RENDER_SHADE_H

#include "geom/geom.h"
#include "scene/scene.h"

/* A surface is lit where the cosine between its normal and the direction to the light is at least
 * this [docs/METHODS.md section 3]. */
#define MIN_LIT_COSINE 1e-10

/* Tells whether anything stands between `point` and one of a light's points, in direction `towards`
 * (unit) at `distance` mm. */
typedef bool ShadowTest(void *context, Vec3 point, Vec3 towards, double distance);

/* What is seen at a point. */
typedef struct ShadingInput {
    const Finish *finish;
    Rgb pigment;
    Vec3 point;
    Vec3 normal;        /* unit, facing the viewer */
    Vec3 direction;     /* unit, of the ray that sees it */
    double open;        /* the part of the ambient light that reaches it */
    const float *parts; /* of each light the part that reaches it; below 0, or NULL: not known */
} ShadingInput;

/* The linear colour of a point: ambient light, and for each light of the view that the surface
 * faces the diffuse and specular light of its finish, times the part of the light's points for
 * which `shadow` is false, or that the point shares. `shadow` is asked only for lights that cast
 * shadows; NULL: nothing does.
 */
Rgb shade(const View *view, const ShadingInput *at, ShadowTest *shadow, void *context);

#endif
