/* Which objects POV-Ray 3.7 looks into along a ray, and in which order [docs/POVRAY.md section 13]:
 * its tests of an object's bounding box, in single precision, repeated operation by operation. */
#ifndef CORCAST_RENDER_POVRAY_BOUND_H
#define CORCAST_RENDER_POVRAY_BOUND_H

#include "base/base.h"
#include "geom/geom.h"

/* A ray as these tests hold it: POV-Ray rounds its start and the inverse of its direction. */
typedef struct BoundRay {
    float origin[3], inverse[3]; /* an infinity where the direction is 0 */
} BoundRay;

BoundRay bound_ray(Ray ray);

/* Whether POV-Ray looks into an object whose bounding box this is; it does so by rising *order,
 * about how far along the ray the box begins. A ray parallel to a side whose rounded start lies in
 * its plane sees the object where that is a side in y or z, and not where it is one in x. */
bool povray_looks_into(const BoundRay *ray, Box box, double *order);

#endif
