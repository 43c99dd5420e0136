/* The parts of FLIP. Private to the module compare. */
#ifndef CORCAST_COMPARE_MEASURES_FLIP_H
#define CORCAST_COMPARE_MEASURES_FLIP_H

#include "compare/measures/perception.h"

/* ceil(3 sqrt(0.04 / (2 pi^2)) ppd) */
enum { FLIP_RADIUS = 10, FLIP_TAPS = 2 * FLIP_RADIUS + 1 };
/* The weights of F_Y and F_CX beyond FLIP_RADIUS_LUMA are less than 1e-11 of the largest weight.
 * The filters of features end at FLIP_RADIUS_FEATURE = ceil(3 * 0.5 * 0.082 ppd). */
enum { FLIP_RADIUS_LUMA = 7, FLIP_RADIUS_FEATURE = 9 };

/* The seven one-dimensional filters, and the planes that they make horizontally. */
typedef enum FlipFilter {
    F_Y,
    F_CX,
    F_CZ1,
    F_CZ2,
    F_GAUSS,
    F_EDGE,
    F_POINT,
    FLIP_FILTERS
} FlipFilter;

/* F_EDGE is antisymmetric, all others are symmetric. */
typedef struct FlipKernel {
    float weights[FLIP_TAPS];
} FlipKernel;

void flip_kernels(FlipKernel kernels[FLIP_FILTERS]);

/* Pixels of a row: `n` from (x, y) on, of side 0 or 1, under an exposure. */
typedef struct FlipSpan {
    int side, exposure, x, y, n;
} FlipSpan;

/* Two images to compare: of each pixel its linear color in [0, 1]. */
typedef struct FlipPair {
    int width, height;
    /* Writes the colors of a span: planes of red, green and blue with `stride` floats between
     * them. */
    void (*colors)(const struct FlipPair *pair, const FlipSpan *span, float *out, size_t stride);
    /* Returns true if both sides are equal in `n` pixels from (x, y) on. */
    bool (*equal)(const struct FlipPair *pair, int x, int y, int n);
    int exposures;       /* the error is the largest over these */
    const void *context; /* borrowed */
} FlipPair;

/* Computes the error of each pixel. `map` receives them, 1 channel, and the caller releases it; it
 * may be NULL. Errors: STATUS_MEMORY. */
MUST_CHECK Status flip_run(const FlipPair *pair, Plane *map, FlipSummary *summary, Err *err);

#endif
