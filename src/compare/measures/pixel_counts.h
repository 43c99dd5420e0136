/* Counts the pixels of two pictures and sums their differences, in one pass over all rows. Private
 * to the module compare.
 *
 * Zero a PixelCounter and set its members that are not marked as owned. Call count_pixels, read
 * sums[0] and `segments`, then call counting_release. */
#ifndef CORCAST_COMPARE_MEASURES_PIXEL_COUNTS_H
#define CORCAST_COMPARE_MEASURES_PIXEL_COUNTS_H

#include "compare/measures/ledger.h"

/* Sums for the least squares fit B = gain A + offset, over all channels of the pixels that show a
 * vessel in both images. a and b are codes of A and B; d = b - a. n is the number of values, aa is
 * the sum of a^2, and so on. */
typedef struct LineSums {
    uint64_t n, a, aa, dd;
    int64_t d, ad;
} LineSums;

/* Sums over pixels. All members are integers of 64 bits, so that add_integers can add them as an
 * array. */
typedef struct PixelTotals {
    uint64_t abs, squares;   /* sums of |b - a| and of (b - a)^2, all channels; codes, codes^2 */
    int64_t signed_codes[3]; /* per channel: sum of b - a, codes */
    uint64_t counts[PIXEL_COUNTS];
    uint64_t brighter, darker; /* numbers of pixels by the sign of their sum of b - a */
    uint64_t classes[PIXEL_CLASSES];
    uint64_t silhouette; /* number of pixel sides in A between a vessel and the background */
    LineSums line;
} PixelTotals;

/* Everything that is summed over a block of rows. */
typedef struct PixelSums {
    PixelTotals total;
    int max;           /* largest |b - a| of all pixels, in any channel, codes */
    int interior_max;  /* the same of pixels that are neither settled [result.h] nor at edges */
    int unsettled_max; /* the same of pixels that are not settled */
    PixelPlace worst;  /* the first pixel with the difference `max` */
} PixelSums;

/* The input, the result and the workspace of count_pixels. */
typedef struct PixelCounter {
    const Rendering *a, *b;
    const Labels *labels;
    const SegmentIndex *index; /* NULL: no ids */
    int beyond; /* a pixel is beyond the tolerance if its |b - a| is larger than this, codes */
    bool common_only; /* true: COUNT_BEYOND counts only pixels that show a vessel in both images */
    const uint8_t *settled; /* per pixel: a SettledCause; NULL: no pixel is settled */
    /* Maximum difference of depths, mm, and angle between normals, degrees, up to which the
     * geometry of a pixel is equal. */
    double geometry_mm, geometry_deg;
    uint8_t *classes;      /* receives the PixelClass of each pixel; NULL: not wanted; borrowed */
    uint8_t *coverage;     /* per pixel: a Coverage [labels.h], which images show a vessel; owned */
    PixelSums *sums;       /* per block of rows; owned */
    SegmentSums *segments; /* per thread: index->n sums; owned */
    uint8_t *scratch;      /* per thread: scratch_size bytes; owned */
    size_t scratch_size;
} PixelCounter;

/* Counts the pixels of all rows, with all processors. Then sums[0] and the first index->n of
 * `segments` are the sums over the whole picture. The caller calls counting_release even after an
 * error. Errors: STATUS_MEMORY. */
MUST_CHECK Status count_pixels(PixelCounter *counting, Err *err);
void counting_release(PixelCounter *counting);

/* Sets the measures of the least squares fit B = gain A + offset: gain, offset, their standard
 * errors and MEASURE_..._EXCESS. Leaves them unchanged if A has a single color. counting->index
 * must not be NULL.
 *
 * code_levels   levels per code: 1 for 8-bit codes, 1/257 for 16-bit codes.
 * Errors        STATUS_MEMORY. */
MUST_CHECK Status result_set_regression(const PixelCounter *counting, double code_levels,
                                        CompareResult *result, Err *err);

#endif
