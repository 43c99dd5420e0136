/* Guesses at what made B of A. Each writes a sentence if it explains the pictures, which have one
 * shape, depth and gamma; otherwise it does not change `out`. Private to the module compare. */
#ifndef CORCAST_COMPARE_CAUSE_GUESSES_H
#define CORCAST_COMPARE_CAUSE_GUESSES_H

#include "compare/result.h"

enum { CAUSE_SAMPLES = 256 };

/* Pixels that differ, evenly spread over all that do. */
typedef struct Samples {
    PixelPlace at[CAUSE_SAMPLES];
    int n;
} Samples;

/* A sentence about the causes, of `size` bytes with the 0; "" as long as there is none. */
typedef struct Sentence {
    char *text;
    size_t size;
} Sentence;

/* Moved by (dx, dy): pixel (x, y) of A is (x + dx, y + dy) of B. */
typedef struct Shift {
    int dx, dy;
    double off; /* the mean difference of the samples under it, codes summed over the channels */
} Shift;

/* The shift with the smallest mean difference of the samples that stay within the picture, three in
 * four of which have to; none where no shift makes the difference much smaller. */
Shift cause_best_shift(const Picture *a, const Picture *b, const Samples *samples);
/* Whether colours are as far from grey as others, within 3 %: `aa` is the sum of the squares of
 * what the channels of A have beside the mean of the pixel, levels, and `ab` that of the products
 * with B's. True where A has too little colour to tell. */
bool cause_is_same_saturation(double aa, double ab);
/* Moved by whole pixels: the shift leaves less than a fiftieth of the differences where both
 * pictures have pixels, and colours are as far from grey as before. O(pixels) where the samples say
 * so, else O(1). */
void cause_shift(const Picture *a, const Picture *b, const Samples *samples, const Shift *shift,
                 Sentence *out);
/* Moved by parts of pixels (`start` is near), blurred or sharpened. O(1). */
MUST_CHECK Status cause_warp(const Picture *a, const Picture *b, const Samples *samples,
                             const Shift *start, Sentence *out, Err *err);
/* Each code of A became one of B: a gain, an offset, a gamma, one encoding too many or missing. */
MUST_CHECK Status cause_tone(const Picture *a, const Picture *b, const Samples *samples,
                             Sentence *out, Err *err);
/* Only the background is of another colour. */
MUST_CHECK Status cause_background(const Picture *a, const Picture *b, const Samples *samples,
                                   Sentence *out, Err *err);
/* Where the differences are: one thing missing or extra, outlines only, highlights only, shading
 * only. */
MUST_CHECK Status cause_place(const Picture *a, const Picture *b, const Samples *samples,
                              const CompareResult *result, Sentence *out, Err *err);

#endif
