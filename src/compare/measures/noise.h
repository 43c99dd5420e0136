/* A test whether two renderings with noise have one mean. */
#ifndef CORCAST_COMPARE_MEASURES_NOISE_H
#define CORCAST_COMPARE_MEASURES_NOISE_H

#include "compare/result.h"

typedef struct NoiseResult {
    bool agrees;
    double rate;        /* of false alarms of the whole test, as the caller gave it */
    double sigmas;      /* of the whole picture: of the worst channel, or of all channels */
    double limit;       /* largest |sigmas| that chance allows */
    double gain;        /* weighted mean of B / weighted mean of A, of the channel of `sigmas` */
    double tile_sigmas; /* of the worst tile of 32 x 32 pixels */
    double tile_limit;  /* largest |tile_sigmas| that chance allows */
    PixelPlace tile;    /* first pixel of the worst tile; without ids */
} NoiseResult;

/* Compares two planes of linear colors whose noise has the same variance.
 *
 * variance   of each value, of one rendering.
 * rate       of false alarms, in (0, 1): how often pictures of one mean are called different, at
 *            most.
 * Errors     STATUS_INPUT if shapes differ, a value is not finite or a variance is below 0. */
MUST_CHECK Status compare_noise(const Plane *a, const Plane *b, const Plane *variance, double rate,
                                NoiseResult *result, Err *err);

/* Computes the variance of each value over n >= 2 renderings. The caller releases *variance.
 * Errors: STATUS_INPUT if sizes differ; STATUS_MEMORY. */
MUST_CHECK Status noise_of_renderings(const Plane *renderings, size_t n, Plane *variance, Err *err);

#endif
