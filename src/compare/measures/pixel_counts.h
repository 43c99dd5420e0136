/* The one pass over two pictures that counts all pixels and takes all sums. Private to the module
 * compare. */
#ifndef CORCAST_COMPARE_MEASURES_PIXEL_COUNTS_H
#define CORCAST_COMPARE_MEASURES_PIXEL_COUNTS_H

#include "compare/measures/ledger.h"

/* Sums over the samples seen in both, for the straight line through them; d = b - a. */
typedef struct LineSums {
    uint64_t n, a, aa, dd;
    int64_t d, ad;
} LineSums;

/* Sums over pixels: integers of 64 bits alone, so that they are added as an array. */
typedef struct PixelTotals {
    uint64_t abs, squares; /* codes, codes^2 */
    int64_t signed_codes[3];
    uint64_t counts[PIXEL_COUNTS];
    uint64_t brighter, darker; /* pixels, by the sum of their channels */
    uint64_t classes[PIXEL_CLASSES];
    uint64_t silhouette; /* sides of A's pixels that part something from nothing */
    LineSums line;
} PixelTotals;

/* What is known about the pixels of a band of rows. */
typedef struct PixelSums {
    PixelTotals total;
    int max, interior_max, unsettled_max; /* codes; unsettled_max leaves settled pixels out */
    PixelPlace worst;
} PixelSums;

/* What is counted, and where to. */
typedef struct Counting {
    const Rendering *a, *b;
    const Labels *labels;
    const SegmentIndex *index; /* NULL without ids */
    int beyond;                /* codes a pixel may be off */
    bool common_only;
    const uint8_t *settled;           /* as in Tolerance */
    double geometry_mm, geometry_deg; /* beyond which geometry differs */
    uint8_t *classes;                 /* borrowed; takes the PixelClass of each pixel; or NULL */
    uint8_t *coverage;                /* owned; a Coverage for each pixel */
    PixelSums *sums;                  /* owned; one for each band */
    SegmentSums *segments;            /* owned; index->n for each worker */
    uint8_t *scratch;                 /* owned; scratch_size for each worker */
    size_t scratch_size;
} Counting;

/* Counts the pixels of all rows, by as many threads as there are; sums[0] and `segments` hold the
 * whole then. The caller has filled in what is not owned, and releases with counting_release, also
 * on failure. */
MUST_CHECK Status count_pixels(Counting *counting, Err *err);
void counting_release(Counting *counting);

/* Adds gain and offset of the least squares fit B = gain A + offset over the samples that were
 * counted, their standard errors, and what is left of them beyond two errors. A code is
 * `code_levels` levels. Errors: STATUS_MEMORY. */
MUST_CHECK Status regression_take(const Counting *counting, double code_levels,
                                  CompareResult *result, Err *err);

#endif
