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
 *     cut[i] >= cut[j] cos(i, j) + radius_j sin(i, j)  for all j other than i,
 *
 * where cos(i, j) is the cosine of the angle between the axes of ends i and j. A shortened vessel
 * ends in a disc. With these cuts, each disc is on one side of the plane of every other disc
 * [docs/METHODS.md section 7]. Two ends impose no condition on each other if the sine of the angle
 * between their axes is below 1e-6: their discs are then parallel, so each is on one side of the
 * other's plane for any cuts.
 *
 * cut      receives n lengths, mm.
 * steps    in: the maximum number of comparisons of two ends, > 0. Out: the number of comparisons
 *          that are left, with which the next junction may be computed. 0: the maximum was reached;
 *          the function returns STATUS_OK, but the cuts are undefined.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status cuts_compute(const VesselEnd *ends, size_t n, double *cut, uint64_t *steps,
                               Err *err);

#endif
