/* Computes the lengths by which the ends of vessels that meet at a junction are shortened, to make
 * space for joints. Private to the module stage. */
#ifndef CORCAST_STAGE_CUTS_H
#define CORCAST_STAGE_CUTS_H

#include "base/base.h"
#include "geom/geom.h"
#include <stdint.h>

/* An end of a vessel at the junction. */
typedef struct VesselEnd {
    Vec3 axis;     /* unit, from the junction into the vessel */
    double radius; /* > 0 */
} VesselEnd;

/* Computes the cuts of n >= 1 ends: the smallest lengths cut[i] >= 0 with
 *
 *     cut_i >= cut_j cos(i, j) + radius_j sin(i, j)  for all j.
 *
 * The disc at which each vessel then ends lies on one side of the plane in which each other vessel
 * ends [docs/METHODS.md section 7]. Ends whose axes are parallel to within 1e-6 ignore each other.
 *
 * cut      in the unit of the radii.
 * steps    the allowed number of comparisons of two ends, > 0. Receives the number that is left; 0
 *          if it was not sufficient, and the cuts are then undefined.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status cuts_compute(const VesselEnd *ends, size_t n, double *cut, uint64_t *steps,
                               Err *err);

#endif
