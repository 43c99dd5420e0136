/* The second step of verifying an implicit surface. The first step compares POV-Ray's picture with
 * a repetition of its root finder. This one compares the repetition with where the surface is. */
#ifndef CORCAST_COMPARE_CHECKS_SURFACE_CHECK_H
#define CORCAST_COMPARE_CHECKS_SURFACE_CHECK_H

#include "base/base.h"
#include "image/image.h"

/* "Grazing" pixels are those whose ray grazes a surface; they are counted and not judged. */
typedef struct SurfaceCheck {
    bool agrees;      /* missing, extra and beyond are 0 */
    char reason[200]; /* a sentence; "" if it agrees */
    size_t pixels;
    size_t common;                    /* pixels seen in both, not grazing */
    size_t grazing;                   /* pixels seen in either */
    size_t missing, extra;            /* pixels seen in A only, in B only, not grazing */
    size_t beyond;                    /* common pixels that are farther apart than allowed */
    double median_mm, p99_mm, max_mm; /* |A - B| over common pixels; NAN if there are none */
    double max_ratio;                 /* largest error over what is allowed */
    int worst_x, worst_y;             /* where that is, from the top left; -1: nowhere */
} SurfaceCheck;

/* Compares the depths of A, the repetition, with those of B, the surface.
 *
 * a, b      1 channel, mm along the ray; INFINITY where nothing is seen.
 * allowed   1 channel: how far A may be from B, in mm; INFINITY: the ray grazes a surface.
 * Errors    STATUS_INPUT if sizes differ; STATUS_MEMORY. */
MUST_CHECK Status surface_check(const Plane *a, const Plane *b, const Plane *allowed,
                                SurfaceCheck *check, Err *err);

#endif
