/* How far the vessels that meet at one place are cut back to make room for their joints. */
#ifndef CORCAST_STAGE_CUTS_H
#define CORCAST_STAGE_CUTS_H

#include "base/base.h"
#include "geom/geom.h"
#include <stdint.h>

/* One vessel's end at the place. */
typedef struct VesselEnd {
    Vec3 axis;     /* unit, from the place along the vessel */
    double radius; /* > 0 */
} VesselEnd;

/* Cuts of n >= 1 ends into cut[n], in the unit of the radii: the least lengths, none below 0, with
 *   cut_i >= cut_j cos(i, j) + radius_j sin(i, j)  for all j,
 * so that the disc that ends each vessel lies on one side of the plane that ends each other
 * [docs/METHODS.md section 7]. Ends whose axes are parallel to within 1e-6 ignore each other.
 * *steps, above 0, is how many comparisons of two ends may be made, and becomes how many are left:
 * 0 when they did not do, and the cuts are then of no use. */
MUST_CHECK Status cuts_compute(const VesselEnd *ends, size_t n, double *cut, uint64_t *steps,
                               Err *err);

#endif
