/* The second step of verifying an implicit surface: the first holds POV-Ray's picture against a
 * repetition of its root finder, this one the repetition against where the surface is. Part of the
 * room's door. */
#ifndef CORCAST_COMPARE_CHECKS_SURFACE_CHECK_H
#define CORCAST_COMPARE_CHECKS_SURFACE_CHECK_H

#include "base/base.h"
#include "image/image.h"

typedef struct SurfaceCheck {
    bool agrees;      /* missing, extra and beyond are 0 */
    char reason[200]; /* a sentence; "" when it agrees */
    size_t pixels;
    size_t common;                    /* seen in both and not grazing */
    size_t grazing;                   /* seen in either; nothing else of these is judged */
    size_t missing, extra;            /* seen in A only, in B only, not grazing */
    size_t beyond;                    /* of the common ones, farther apart than allowed */
    double median_mm, p99_mm, max_mm; /* |A - B| over the common ones; NAN when there are none */
    double max_ratio;                 /* of the error to what is allowed */
    int worst_x, worst_y;             /* where that is, from the top left; -1 when nowhere */
} SurfaceCheck;

/* Holds A, the repetition, against B, the surface: depth planes of 1 channel, mm along the ray,
 * INFINITY where nothing is seen. `allowed`, 1 channel, is how far A may be from B, mm; INFINITY
 * where the ray grazes a surface in either and may go either way. STATUS_INPUT when sizes
 * differ. */
MUST_CHECK Status surface_check(const Plane *a, const Plane *b, const Plane *allowed,
                                SurfaceCheck *check, Err *err);

#endif
