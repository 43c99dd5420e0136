/* The second step of `verify` for an implicit surface. */
#ifndef CORCAST_APP_SURFACE_STEP_H
#define CORCAST_APP_SURFACE_STEP_H

#include "image/image.h"
#include "scene/scene.h"
#include "surface/surface.h"
#include "verify/verify.h"

/* Holds what POV-Ray's root finder sees of the scene in cells with this form of erf (`seen`)
 * against where the surface is (`exact`); both frames have depth, normals and ids. A pixel may be
 * off by the accuracy of its cell, along the ray, and by what the cells leave out, along the
 * normal. Rays within about 3 degrees of the tangent plane graze. */
MUST_CHECK Status surface_step(const Scene *scene, ErfForm erf, const Frame *seen,
                               const Frame *exact, SurfaceCheck *check, Err *err);

#endif
