/* The shading model: computes the color of a point with POV-Ray's finishes and lights
 * [docs/METHODS.md section 3]. */
#ifndef CORCAST_RENDER_LIGHT_SHADE_H
#define CORCAST_RENDER_LIGHT_SHADE_H

#include "geom/geom.h"
#include "scene/scene.h"

/* Minimum cosine of the angle between a surface's normal and the direction to a light at which the
 * light reaches the surface [docs/METHODS.md section 3]. */
#define MIN_LIT_COSINE 1e-10

/* Returns true if an object is between `point` and a light: on the ray from `point` in the
 * direction `towards` (a unit vector), at a distance below `distance` mm. */
typedef bool ShadowTest(void *context, Vec3 point, Vec3 towards, double distance);

/* A point to shade. */
typedef struct ShadingInput {
    const Finish *finish;
    Rgb pigment;    /* linear color of the surface */
    Vec3 point;     /* mm, world coordinates */
    Vec3 normal;    /* unit, facing the viewer */
    Vec3 direction; /* unit, of the camera ray that hits the point */
    double ambient; /* ambient visibility, in [0, 1] */
    /* Per light of the view: its visibility, 0 to 1; negative: not known. NULL: not known for any
     * light. */
    const float *light_visibility;
} ShadingInput;

/* Returns the linear color of a point: the sum of the ambient light, and of the diffuse and
 * specular light of each light of the view that the surface faces.
 *
 * The contribution of a light is multiplied by its visibility. If the visibility is not known
 * [ShadingInput.light_visibility] and the light casts shadows, the visibility is the fraction of
 * the light's points for which `shadow` returns false. If `shadow` is NULL, no object casts a
 * shadow. */
Rgb shade(const View *view, const ShadingInput *at, ShadowTest *shadow, void *context);

#endif
