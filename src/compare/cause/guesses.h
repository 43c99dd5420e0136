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

/* A sentence about the cause, "" as long as there is none. `size` is that of `text`. */
typedef struct Sentence {
    char *text;
    size_t size;
} Sentence;

/* Moved by (dx, dy): pixel (x, y) of A is (x + dx, y + dy) of B. */
typedef struct Shift {
    int dx, dy;
    double off; /* the mean difference of the samples under it, codes summed over the channels */
} Shift;

/* Returns the shift with the smallest mean difference of the samples that stay within the picture;
 * three of four samples must. Returns no shift if none makes the difference much smaller. */
Shift cause_best_shift(const Picture *a, const Picture *b, const Samples *samples);
/* Returns true if colours are as far from grey in both pictures, within 3 %, or if A has too little
 * colour to tell.
 *
 * aa   sum of the squares of A's channels minus the pixel's mean, in levels.
 * ab   sum of the products of these with B's. */
bool cause_is_same_saturation(double aa, double ab);

/* Moved by whole pixels: the shift leaves less than a fiftieth of the differences where both
 * pictures have pixels, and colours are as far from grey as before. Returns true if a part of the
 * picture was moved and another part was not. Cost O(1), or O(pixels) if the samples agree. */
bool cause_shift(const Picture *a, const Picture *b, const Samples *samples, const Shift *shift,
                 Sentence *out);
/* Moved by fractions of pixels (`start` is near), blurred or sharpened. Cost O(1). Errors:
 * STATUS_MEMORY, as of all guesses below. */
MUST_CHECK Status cause_warp(const Picture *a, const Picture *b, const Samples *samples,
                             const Shift *start, Sentence *out, Err *err);
/* Each code of A became one code of B: a gain, an offset, a gamma, one encoding too many or
 * missing. */
MUST_CHECK Status cause_tone(const Picture *a, const Picture *b, const Samples *samples,
                             Sentence *out, Err *err);
/* Only the background has another colour. */
MUST_CHECK Status cause_background(const Picture *a, const Picture *b, const Samples *samples,
                                   Sentence *out, Err *err);
/* Where the differences are: one thing missing or extra, outlines only, highlights only, shading
 * only. */
MUST_CHECK Status cause_place(const Picture *a, const Picture *b, const Samples *samples,
                              const CompareResult *result, Sentence *out, Err *err);

#endif
