/* Computes cuts: the lengths by which vessels are shortened at a junction, to make space for
 * joints. Private to the module stage. */
#ifndef CORCAST_STAGE_CUTS_H
#define CORCAST_STAGE_CUTS_H

#include "base/base.h"
#include "geom/geom.h"
#include <stdint.h>

/* The end of one vessel at the junction. */
typedef struct VesselEnd {
    Vec3 axis;     /* unit, from the junction into the vessel */
    double radius; /* mm, > 0 */
} VesselEnd;

/* Computes the cuts of the n >= 1 vessel ends at one junction. They are the smallest lengths cut[i]
 * >= 0 with
 *
 *     cut_i >= cut_j cos(i, j) + radius_j sin(i, j)  for all j,
 *
 * where cos(i, j) is the cosine of the angle between the axes of ends i and j. A shortened vessel
 * ends in a disc. With these cuts, each disc is on one side of the plane of every other disc
 * [docs/METHODS.md section 7]. Two ends whose axes are parallel to within 1e-6 impose no condition
 * on each other.
 *
 * cut      receives n lengths, mm.
 * steps    in: the maximum number of comparisons of two ends, > 0. Out: the number of comparisons
 *          that are left. 0: the maximum was reached, and the cuts are undefined.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status cuts_compute(const VesselEnd *ends, size_t n, double *cut, uint64_t *steps,
                               Err *err);

#endif
