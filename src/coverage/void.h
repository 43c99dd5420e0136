/* The largest empty ball whose centre is in the tissue. Private to the module coverage. */
#ifndef CORCAST_COVERAGE_VOID_H
#define CORCAST_COVERAGE_VOID_H

#include "coverage/sites.h"

/* A point and its distance from the nearest vessel, mm. */
typedef struct CoverageVoid {
    double distance_mm;
    Vec3 at;
} CoverageVoid;

/* A box that may hold the farthest point. */
typedef struct VoidBox {
    Vec3 centre;
    double distance_mm; /* of the centre from the nearest vessel */
} VoidBox;

typedef ARRAY(VoidBox) VoidBoxes;

typedef struct VoidSearch {
    const Domain *domain;
    const Sites *sites;
    double accepted_mm; /* accepted error, above 0 */
    CoverageVoid best;  /* the farthest point so far; the caller sets it to a point of the domain */
    double most_mm;     /* no point in the boxes that were searched is farther; 0 before */
    VoidBoxes boxes;    /* workspace; the caller releases it with ARRAY_RELEASE */
} VoidSearch;

/* Improves search->best to the farthest point of the domain in a box, and raises search->most_mm.
 * The search ends with a larger error than the accepted one where very many points are as far as
 * the farthest one, such as around a single straight vessel.
 *
 * half        half of the sides of the box, mm; 0 along z in two dimensions.
 * nearest_mm  sites_nearest of `centre`.
 * Errors      STATUS_MEMORY. */
MUST_CHECK Status void_search(VoidSearch *search, Vec3 centre, Vec3 half, double nearest_mm,
                              Err *err);

#endif
