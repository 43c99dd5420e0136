/* The parts of FLIP; private to the room compare. */
#ifndef CORCAST_COMPARE_MEASURES_FLIP_H
#define CORCAST_COMPARE_MEASURES_FLIP_H

#include "compare/measures/perception.h"

/* ceil(3 sqrt(0.04 / (2 pi^2)) ppd) */
enum { FLIP_RADIUS = 10, FLIP_TAPS = 2 * FLIP_RADIUS + 1 };
/* Beyond the first the weights of F_Y and F_CX are less than 1e-11 of the largest; the features'
 * filters end at the second, ceil(3 * 0.5 * 0.082 ppd). */
enum { FLIP_RADIUS_LUMA = 7, FLIP_RADIUS_FEATURE = 9 };

/* The seven one-dimensional filters; each also names the plane that it gives horizontally. */
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

/* Two images to compare: of each pixel its linear colour in [0, 1]. */
typedef struct FlipPair {
    int width, height;
    /* Writes the colours of `n` pixels of row y from x on, planes of red, green and blue with
     * `stride` floats between them, of side 0 or 1 under exposure `exposure`. */
    void (*colors)(const struct FlipPair *pair, int side, int exposure, int x, int y, int n,
                   float *out, size_t stride);
    /* Whether both sides are equal in these pixels. */
    bool (*equal)(const struct FlipPair *pair, int x, int y, int n);
    int exposures;       /* the error is the largest over these */
    const void *context; /* borrowed */
} FlipPair;

/* The error of each pixel in *map (owned; 1 channel), unless that is NULL, and what it sums up
 * to. */
MUST_CHECK Status flip_run(const FlipPair *pair, Plane *map, FlipSummary *summary, Err *err);

#endif
