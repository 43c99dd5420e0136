/* The shading model: POV-Ray's finishes and lights [docs/METHODS.md section 3]. */
#ifndef CORCAST_RENDER_LIGHT_SHADE_H
#define CORCAST_RENDER_LIGHT_SHADE_H

#include "geom/geom.h"
#include "scene/scene.h"

/* The smallest cosine, between a surface's normal and the direction to a light, at which the light
 * reaches the surface [docs/METHODS.md section 3]. */
#define MIN_LIT_COSINE 1e-10

/* Returns true if an object lies between `point` and a light: on the ray from `point` in the
 * direction `towards` (a unit vector), nearer than `distance` mm. */
typedef bool ShadowTest(void *context, Vec3 point, Vec3 towards, double distance);

/* A point to shade. */
typedef struct ShadingInput {
    const Finish *finish;
    Rgb pigment;
    Vec3 point;
    Vec3 normal;    /* unit, facing the viewer */
    Vec3 direction; /* unit, of the camera ray that hits the point */
    double ambient; /* ambient visibility, in [0, 1] */
    /* Per light of the view: its visibility, in [0, 1], or a negative number if it is not known.
     * NULL: not known for any light. */
    const float *light_visibility;
} ShadingInput;

/* Returns the linear color of a point: the ambient light, and the diffuse and specular light of
 * each light of the view that the surface faces.
 *
 * A light whose visibility is known [ShadingInput.light_visibility] is multiplied by it. A light
 * that casts shadows and whose visibility is not known is multiplied by the fraction of its points
 * for which `shadow` returns false. `shadow` may be NULL: no object casts a shadow. */
Rgb shade(const View *view, const ShadingInput *at, ShadowTest *shadow, void *context);

#endif
