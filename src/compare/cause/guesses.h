/* Tests hypotheses ("guesses") about what changed picture A into picture B.
 *
 * Each cause_* function below tests one kind of cause. If this cause explains the difference of the
 * pictures, the function writes a sentence to out->text. Otherwise out->text does not change. The
 * pictures A and B have equal size, channels, bit depth and gamma. Private to the module compare.
 */
#ifndef CORCAST_COMPARE_CAUSE_GUESSES_H
#define CORCAST_COMPARE_CAUSE_GUESSES_H

#include "compare/pixels.h"

enum { CAUSE_SAMPLES = 256 };

/* Up to CAUSE_SAMPLES of the pixels that differ: every k-th of them in scan order. */
typedef struct Samples {
    PixelPlace at[CAUSE_SAMPLES];
    int n;
} Samples;

/* Returns the index of the first code of pixel (x, y). */
static inline size_t first_code(const Picture *picture, int x, int y)
{
    return ((size_t)y * (size_t)picture->width + (size_t)x) * (size_t)picture->channels;
}

/* Returns the code of pixel (x, y) in channel c. */
static inline int code_at(const Picture *picture, int x, int y, int c)
{
    return picture_code(picture, first_code(picture, x, y) + (size_t)c);
}

/* Returns the number of pixels in question: those of the samples, or all if `samples` is NULL. */
static inline size_t n_asked(const Picture *picture, const Samples *samples)
{
    return samples ? (size_t)samples->n : (size_t)picture->width * (size_t)picture->height;
}

/* Returns the index of the first code of pixel i of those in question. */
static inline size_t asked_code(const Picture *picture, const Samples *samples, size_t i)
{
    return samples ? first_code(picture, samples->at[i].x, samples->at[i].y)
                   : i * (size_t)picture->channels;
}

/* Makes a plane of one row with the linear light of each code of such a picture. The caller
 * releases it. Errors: STATUS_MEMORY. */
MUST_CHECK Status light_of_codes(const Picture *picture, Plane *lights, Err *err);

/* A sentence about the cause. */
typedef struct Sentence {
    char *text;  /* "" until a cause is found; borrowed */
    size_t size; /* capacity of `text` in bytes */
} Sentence;

/* A translation by (dx, dy) pixels, right and down being positive: pixel (x, y) of A is pixel
 * (x + dx, y + dy) of B. dx = dy = 0: no translation. */
typedef struct Shift {
    int dx, dy;
    double off; /* mean over the samples of the difference that remains after this translation: sum
                 * over the channels of the absolute difference of codes */
} Shift;

/* Returns true if both pictures have the same saturation: the distances of their colors from grey
 * agree within 3 %. Also returns true if A has too little color to decide.
 *
 * aa   sum of the squares of (A's channel - mean of the pixel's channels), in levels.
 * ab   sum of the products of these deviations in A and in B. */
bool cause_is_same_saturation(double aa, double ab);

/* Tests whether B is A translated by fractions of a pixel, blurred or sharpened.
 *
 * start    the translation by whole pixels that leaves the smallest difference.
 * Errors   STATUS_MEMORY.
 * Cost     O(1). */
MUST_CHECK Status cause_warp(const Picture *a, const Picture *b, const Samples *samples,
                             const Shift *start, Sentence *out, Err *err);
/* Tests whether one curve maps each code of A to the code of B: a gain, an offset, a gamma, or an
 * sRGB encoding that was applied once too often or not at all.
 *
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status cause_tone(const Picture *a, const Picture *b, const Samples *samples,
                             Sentence *out, Err *err);
/* Tests whether B is A with another saturation, or with all hues turned by one angle. */
void cause_hue(const Picture *a, const Picture *b, const Samples *samples, Sentence *out);
/* Tests whether B is A rotated, enlarged or reduced, or cropped and enlarged.
 *
 * Errors   STATUS_MEMORY.
 * Cost     O(pixels). */
MUST_CHECK Status cause_affine(const Picture *a, const Picture *b, Sentence *out, Err *err);
/* Tests whether B is A compressed as JPEG with the tables of libjpeg. Errors: STATUS_MEMORY. */
MUST_CHECK Status cause_jpeg(const Picture *a, const Picture *b, Sentence *out, Err *err);
/* Tests whether B is A plus noise that is independent in each pixel. */
void cause_noise(const Picture *a, const Picture *b, Sentence *out);
/* Tests whether only the color of the background differs.
 *
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status cause_background(const Picture *a, const Picture *b, const Samples *samples,
                                   Sentence *out, Err *err);
/* Tests whether the differences are confined to one kind of pixels: one object that is missing or
 * extra, outlines, highlights, or shading.
 *
 * result   the comparison of A and B.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status cause_place(const Picture *a, const Picture *b, const Samples *samples,
                              const CompareResult *result, Sentence *out, Err *err);

#endif
