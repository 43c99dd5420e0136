/* Computes FLIP, a perceptual difference of two images: 0 where a viewer sees no difference, up to
 * 1. perception.h names the papers. Both images are converted to an opponent color space with the
 * lightness Y and the color axes Cx and Cz. They are filtered like the eye, which sees 67 pixels
 * per degree (ppd). LDR-FLIP and HDR-FLIP share this code: fill in a FlipPair, and call flip_run.
 * Private to the module compare. */
#ifndef CORCAST_COMPARE_MEASURES_FLIP_H
#define CORCAST_COMPARE_MEASURES_FLIP_H

#include "compare/measures/perception.h"

/* Filters have FLIP_TAPS weights; the centre has the index FLIP_RADIUS. The published radius of the
 * widest filter is ceil(3 sqrt(0.04 / (2 pi^2)) ppd) = 10 pixels, where 0.04 is the width parameter
 * of that filter. */
enum { FLIP_RADIUS = 10, FLIP_TAPS = 2 * FLIP_RADIUS + 1 };
/* FLIP_RADIUS_LUMA is the radius of F_Y and F_CX; their weights beyond it are less than 1e-11 of
 * the largest weight. FLIP_RADIUS_FEATURE is the radius of F_GAUSS, F_EDGE and F_POINT: ceil(3 *
 * 0.5 * 0.082 ppd), three standard deviations of the published Gaussian, where a standard deviation
 * is half of 0.082 degrees. */
enum { FLIP_RADIUS_LUMA = 7, FLIP_RADIUS_FEATURE = 9 };

/* The one-dimensional filters. Each is applied along rows, and makes the plane that has the
 * filter's index. */
typedef enum FlipFilter {
    F_Y,     /* blur of Y */
    F_CX,    /* blur of Cx */
    F_CZ1,   /* blur of Cz, the first of a sum of two Gaussians */
    F_CZ2,   /* blur of Cz, the second of the sum */
    F_GAUSS, /* Gaussian blur along the other axis than F_EDGE or F_POINT */
    F_EDGE,  /* first derivative of the Gaussian: edges */
    F_POINT, /* second derivative of the Gaussian: points and lines */
    FLIP_FILTERS
} FlipFilter;

/* Weights of one filter. F_EDGE is antisymmetric, all others are symmetric. */
typedef struct FlipKernel {
    float weights[FLIP_TAPS];
} FlipKernel;

/* Sets the weights of all filters. The weights of F_Y and F_CX sum to 1. The sum
 * of the two-dimensional filters of F_CZ1 and F_CZ2 has the weight 1. The positive weights of
 * F_GAUSS, F_EDGE and F_POINT sum to 1, the negative weights of F_EDGE and F_POINT to -1; all are 0
 * beyond FLIP_RADIUS_FEATURE.
 */
void flip_kernels(FlipKernel kernels[FLIP_FILTERS]);

/* `n` pixels of one row, beginning at (x, y). */
typedef struct FlipSpan {
    int image;    /* 0: A, 1: B */
    int exposure; /* index of the exposure, below FlipPair.exposures */
    int x, y, n;
} FlipSpan;

/* The two images. Several threads call the functions at once. */
typedef struct FlipPair {
    int width, height; /* at least 1 */
    /* Writes the linear colors of a span in [0, 1], after the exposure has been applied. `out`
     * receives planes of red, green and blue, which begin `stride` floats apart. */
    void (*colors)(const struct FlipPair *pair, const FlipSpan *span, float *out, size_t stride);
    /* Returns true if both images are equal in `n` pixels from (x, y) on. */
    bool (*equal)(const struct FlipPair *pair, int x, int y, int n);
    int exposures; /* number of exposures: 1 for LDR-FLIP. The error of a pixel is the largest over
                    * all exposures. */
    const void *context; /* data of the two functions; borrowed */
} FlipPair;

/* Computes the error of each pixel, in [0, 1].
 *
 * map      receives the errors, 1 channel; release it with plane_release. The argument may be NULL.
 * summary  receives statistics of the errors.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status flip_run(const FlipPair *pair, Plane *map, FlipSummary *summary, Err *err);

#endif
