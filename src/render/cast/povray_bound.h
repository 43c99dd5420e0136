/* Reproduces the bounding box tests of POV-Ray 3.7, operation by operation, in single precision
 * [docs/POVRAY.md section 13]. The tests decide which objects POV-Ray intersects with a ray, and in
 * which order. The caller converts a ray once with bound_ray and then tests any number of boxes
 * with povray_looks_into. Nothing is allocated. */
#ifndef CORCAST_RENDER_CAST_POVRAY_BOUND_H
#define CORCAST_RENDER_CAST_POVRAY_BOUND_H

#include "base/base.h"
#include "geom/geom.h"

/* A ray, rounded to single precision as POV-Ray rounds it. */
typedef struct BoundRay {
    float origin[3], inverse[3]; /* origin in mm; inverse[i] = 1 / direction[i], infinite if
                                  * direction[i] is 0 */
} BoundRay;

/* Converts a ray for povray_looks_into. */
BoundRay bound_ray(Ray ray);

/* Returns true if POV-Ray intersects the ray with an object that has this bounding box.
 *
 * If a ray is parallel to a side of the box, and its rounded origin is in the plane of this side,
 * the result depends on the axis, as in POV-Ray: true for a side perpendicular to y or z, false for
 * a side perpendicular to x.
 *
 * order    receives the sort key of the object: approximately the distance along the ray at which
 *          the ray enters the box, mm. POV-Ray intersects objects in ascending order of this key.
 *          It may be set even if the result is false. */
bool povray_looks_into(const BoundRay *ray, Box box, double *order);

#endif
