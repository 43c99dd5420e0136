/* Repeats the bounding box tests of POV-Ray 3.7, operation by operation, in single precision
 * [docs/POVRAY.md section 13]. They decide which objects POV-Ray intersects with a ray, and in
 * which order. The caller converts a ray once with bound_ray and then tests any number of boxes.
 * Nothing is allocated. */
#ifndef CORCAST_RENDER_CAST_POVRAY_BOUND_H
#define CORCAST_RENDER_CAST_POVRAY_BOUND_H

#include "base/base.h"
#include "geom/geom.h"

/* A ray, rounded to single precision as POV-Ray rounds it. */
typedef struct BoundRay {
    float origin[3], inverse[3]; /* origin in mm; inverse[i] = 1 / direction[i], infinite if
                                  * direction[i] is 0 */
} BoundRay;

/* Rounds a ray for these tests. */
BoundRay bound_ray(Ray ray);

/* Returns true if POV-Ray intersects the ray with an object that has this bounding box.
 *
 * If a ray is parallel to a side of the box and its rounded origin lies in the plane of that side,
 * the result depends on the axis, as in POV-Ray: true for a side across y or z, false for a side
 * across x.
 *
 * order    receives the sort key of the object: about the distance along the ray at which the box
 *          begins, mm. POV-Ray intersects objects in ascending order of this key. May be set even
 *          if the result is false. */
bool povray_looks_into(const BoundRay *ray, Box box, double *order);

#endif
