/* Compares computed depths of an implicit surface with depths that are proven by interval
 * arithmetic.
 *
 * This is the second step of verifying a picture of an implicit surface. The first step compares
 * POV-Ray's picture with corcast's reimplementation of POV-Ray's root finder. The second step
 * compares the depths of the reimplementation (A) with the proven depths (B). */
#ifndef CORCAST_COMPARE_CHECKS_SURFACE_CHECK_H
#define CORCAST_COMPARE_CHECKS_SURFACE_CHECK_H

#include "base/base.h"
#include "image/image.h"

/* The result. A pixel is grazing if its ray is nearly tangent to the surface; its `allowed` is
 * INFINITY. Grazing pixels are only counted, because rounding decides whether they hit. */
typedef struct SurfaceCheck {
    bool agrees;      /* missing, extra and beyond are 0 */
    char reason[200]; /* a sentence that states the disagreement; "" if it agrees */
    size_t pixels;    /* number of all pixels */
    size_t grazing;   /* number of grazing pixels that show a surface in A or in B */
    /* Numbers of pixels that are not grazing: */
    size_t common;                    /* A and B show a surface */
    size_t missing, extra;            /* missing: only A shows a surface; extra: only B does */
    size_t beyond;                    /* common pixels whose depths differ by more than allowed */
    double median_mm, p99_mm, max_mm; /* |A - B| over the common pixels; NAN if there are none */
    double max_ratio; /* largest ratio of |A - B| to the allowed difference over the common pixels;
                       * 0: there are none */
    int worst_x, worst_y; /* column and row of the pixel with max_ratio, from the top left; -1: no
                           * common pixel */
} SurfaceCheck;

/* Compares the depths of A, the reimplementation, with the proven depths of B.
 *
 * a, b     1 channel, mm along the ray; a value that is not finite: no surface.
 * allowed  1 channel, mm: the largest allowed |A - B|; INFINITY: the pixel is grazing.
 * check    set on success only.
 * Errors   STATUS_INPUT if the sizes differ; STATUS_MEMORY. */
MUST_CHECK Status surface_check(const Plane *a, const Plane *b, const Plane *allowed,
                                SurfaceCheck *check, Err *err);

#endif
