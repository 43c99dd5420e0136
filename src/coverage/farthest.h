/* Finds the point of the tissue that is farthest from any vessel: the centre of the largest ball
 * without a vessel inside. Private to the module coverage. */
#ifndef CORCAST_COVERAGE_FARTHEST_H
#define CORCAST_COVERAGE_FARTHEST_H

#include "coverage/sites.h"

/* A point and its distance from the nearest vessel, mm. */
typedef struct FarthestPoint {
    double distance_mm;
    Vec3 at;
} FarthestPoint;

/* A box that may hold the farthest point. All boxes of a step of the search have the same size. */
typedef struct FarthestBox {
    Vec3 centre;
    double distance_mm; /* distance of the centre from the nearest vessel, or an upper bound of it
                         * if the bound suffices to discard the box */
} FarthestBox;

typedef ARRAY(FarthestBox) FarthestBoxes;

/* A search over several boxes. Pointers are borrowed. */
typedef struct FarthestSearch {
    const Domain *domain;
    const Sites *sites;
    double accepted_mm; /* accepted error, above 0: a box is discarded if none of its points can be
                         * farther than best.distance_mm + accepted_mm */
    FarthestPoint best; /* the farthest point so far; the caller sets it to a point of the tissue */
    double undecided_mm; /* upper bound of the distance in boxes whose search ended undecided; the
                          * caller sets it to 0 before the first search */
    FarthestBoxes boxes; /* workspace; the caller releases it with ARRAY_RELEASE */
} FarthestSearch;

/* Searches a box for the farthest point of the domain. Replaces search->best if a point is farther.
 *
 * The search ends undecided if more than 2^15 boxes are left. This happens where very many points
 * have nearly the largest distance, for example around a single straight vessel. The search then
 * raises search->undecided_mm. Afterwards, no point of the box is farther than max(best.distance_mm
 * + accepted_mm, undecided_mm).
 *
 * half        half of the sides of the box, mm; 0 along z in two dimensions.
 * nearest_mm  result of sites_nearest for `centre`.
 * Errors      STATUS_MEMORY. */
MUST_CHECK Status farthest_search(FarthestSearch *search, Vec3 centre, Vec3 half, double nearest_mm,
                                  Err *err);

#endif
