/* Tests whether two noisy renderings, for example by a path tracer, have the same mean. Estimates
 * the variance of the noise from repeated renderings. */
#ifndef CORCAST_COMPARE_MEASURES_NOISE_H
#define CORCAST_COMPARE_MEASURES_NOISE_H

#include "compare/result.h"

/* The result of the test. `sigmas` is (mean of B - mean of A) / standard error of this difference.
 * It is computed per channel and for all channels together; the value with the largest magnitude is
 * stored. */
typedef struct NoiseResult {
    bool agrees;        /* |sigmas| <= limit and |tile_sigmas| <= tile_limit */
    double rate;        /* false alarm rate of the whole test, as passed to compare_noise */
    double sigmas;      /* sigmas of the whole picture; positive: B is brighter; may be infinite */
    double limit;       /* largest |sigmas| that chance explains at this rate */
    double gain;        /* weighted mean of B / weighted mean of A, in the channel of `sigmas` */
    double tile_sigmas; /* sigmas of the tile of 32 x 32 pixels with the largest |sigmas| */
    double tile_limit;  /* largest |tile_sigmas| that chance explains at this rate */
    PixelPlace tile;    /* top left pixel of this tile; id_a and id_b are 0 */
} NoiseResult;

/* Compares two planes of linear colors. The noise of both must have the same variance.
 *
 * variance  per value: variance of the noise in one rendering; same size and channels as a and b.
 * rate      maximum false alarm rate, in (0, 1): the fraction of pairs of pictures with equal means
 *           for which the test reports a difference.
 * result    set on success only.
 * Errors    STATUS_INPUT if sizes or channels differ, a value is not finite, or a variance is below
 *           0. */
MUST_CHECK Status compare_noise(const Plane *a, const Plane *b, const Plane *variance, double rate,
                                NoiseResult *result, Err *err);

/* Computes the variance of each value over n >= 2 renderings of one scene.
 *
 * variance  the caller releases it; set on success only.
 * Errors    STATUS_INPUT if sizes or channels differ; STATUS_MEMORY. */
MUST_CHECK Status noise_of_renderings(const Plane *renderings, size_t n, Plane *variance, Err *err);

#endif
