/* Tests hypotheses about the change that turned picture A into picture B.
 *
 * Each cause_* function tests one kind of change: it fits the parameters of the change to a few
 * samples, then checks the fit on the whole pictures. compare_cause calls the functions one after
 * the other until one of them finds a cause. A code is the stored integer of a channel. A level is
 * 1/255 of the range of codes. Private to the module compare.
 *
 * The cause_* functions share these parameters:
 *
 * a, b     two pictures of equal size, channels (1 or 3), bit depth and gamma.
 * samples  some of the pixels that differ [Samples].
 * out      out->text receives a sentence if the change explains the difference. Otherwise out->text
 *          is unchanged, also after an error.
 * Errors   STATUS_MEMORY. */
#ifndef CORCAST_COMPARE_CAUSE_GUESSES_H
#define CORCAST_COMPARE_CAUSE_GUESSES_H

#include "compare/pixels.h"
#include <stdlib.h>

/* Capacity of Samples. More samples make a fit more reliable; 256 take little time compared with a
 * pass over a picture. Reason of the number not recorded. */
enum { CAUSE_SAMPLES = 256 };

/* Up to CAUSE_SAMPLES of the pixels that differ: every k-th of these pixels, row by row. */
typedef struct Samples {
    PixelPlace at[CAUSE_SAMPLES];
    int n;
} Samples;

/* Returns the index of the first code of the pixel in column x and row y. */
static inline size_t first_code(const Picture *picture, int x, int y)
{
    return ((size_t)y * (size_t)picture->width + (size_t)x) * (size_t)picture->channels;
}

/* Returns the code of the pixel in column x and row y, in channel c. */
static inline int code_at(const Picture *picture, int x, int y, int c)
{
    return picture_code(picture, first_code(picture, x, y) + (size_t)c);
}

/* Returns the number of samples; if `samples` is NULL, the number of pixels of the picture. */
static inline size_t sampled_pixels(const Picture *picture, const Samples *samples)
{
    return samples ? (size_t)samples->n : (size_t)picture->width * (size_t)picture->height;
}

/* Returns the index of the first code of sample i; if `samples` is NULL, of pixel i. */
static inline size_t sampled_code(const Picture *picture, const Samples *samples, size_t i)
{
    return samples ? first_code(picture, samples->at[i].x, samples->at[i].y)
                   : i * (size_t)picture->channels;
}

/* Returns the number of codes per level: 1 for 8 bits, 257 for 16 bits. */
static inline int codes_per_level(const Picture *picture)
{
    return picture->bits == 8 ? 1 : 257;
}

/* Returns the largest code of the picture's bit depth. */
static inline int largest_code(const Picture *picture)
{
    return picture->bits == 8 ? 255 : 65535;
}

/* Returns true if the picture has a pixel in column x and row y. */
static inline bool has_pixel(const Picture *picture, int x, int y)
{
    return x >= 0 && x < picture->width && y >= 0 && y < picture->height;
}

/* Returns the sum over the channels of |code of pixel (u, v) of B - code of pixel (x, y) of A|; 0
 * if B has no pixel (u, v), so that pixels shifted out of the picture do not count. Pixel (x, y) of
 * A must exist. */
static inline int pixels_apart(const Picture *a, int x, int y, const Picture *b, int u, int v)
{
    int sum = 0;
    for (int c = 0; c < a->channels && has_pixel(b, u, v); c++)
        sum += abs(code_at(a, x, y, c) - code_at(b, u, v, c));
    return sum;
}

/* Makes a table of the linear color of each code, by the picture's bit depth and gamma: a plane of
 * one row. The caller releases it. Errors: STATUS_MEMORY. */
MUST_CHECK Status linear_of_codes(const Picture *picture, Plane *table, Err *err);

/* Finds the minimum of a function by golden section search. `f` must have one minimum in [low,
 * high]. Calls f `steps` + 2 times.
 *
 * least    receives the smallest value of f that was found.
 * Returns  the middle of the last interval, which is near the position of the minimum. */
double golden_section(double (*f)(void *context, double x), void *context, double low, double high,
                      int steps, double *least);

/* A sentence about the cause. */
typedef struct Sentence {
    char *text;  /* the caller's buffer; "" until a cause is found */
    size_t size; /* capacity of `text` in bytes */
} Sentence;

/* A translation by (dx, dy) pixels, right and down being positive: pixel (x, y) of A is pixel
 * (x + dx, y + dy) of B. dx = dy = 0: no translation. */
typedef struct Shift {
    int dx, dy;
    double off; /* mean over the samples of pixels_apart after this translation, in codes */
} Shift;

/* Returns true if both pictures have the same saturation: the distances of their colors from grey
 * agree within 3 %. Also returns true if A has too little color to decide.
 * aa   sum over channels and samples of (channel of A - mean of the pixel's channels)^2, levels^2.
 * ab   sum of the products of these deviations in A and in B, levels^2. */
bool cause_is_same_saturation(double aa, double ab);

/* Tests whether B is A translated by fractions of a pixel, blurred or sharpened.
 * start   the translation by whole pixels that leaves the smallest difference; compare_cause finds
 *         it, and reports it if it explains the difference alone.
 * Cost    O(pixels) if a change fits the samples, else O(1). */
MUST_CHECK Status cause_warp(const Picture *a, const Picture *b, const Samples *samples,
                             const Shift *start, Sentence *out, Err *err);
/* Tests whether one curve maps each code of A to the code of B: a gain, an offset, a gamma, or an
 * sRGB encoding that was applied once too often or not at all. */
MUST_CHECK Status cause_tone(const Picture *a, const Picture *b, const Samples *samples,
                             Sentence *out, Err *err);
/* Tests whether B is A with another saturation, or with all hues rotated by one angle. */
void cause_hue(const Picture *a, const Picture *b, const Samples *samples, Sentence *out);
/* Tests whether B is A rotated, enlarged or reduced, or cropped and enlarged. Cost: O(pixels). */
MUST_CHECK Status cause_affine(const Picture *a, const Picture *b, Sentence *out, Err *err);
/* Tests whether B is A compressed as JPEG with the quantisation tables of libjpeg. */
MUST_CHECK Status cause_jpeg(const Picture *a, const Picture *b, Sentence *out, Err *err);
/* Tests whether B is A plus noise that is independent in each pixel. */
void cause_noise(const Picture *a, const Picture *b, Sentence *out);
/* Tests whether only the color of the background differs. */
MUST_CHECK Status cause_background(const Picture *a, const Picture *b, const Samples *samples,
                                   Sentence *out, Err *err);
/* Tests whether the differences are confined to one kind of pixels: one object that is missing or
 * extra, outlines, highlights, or shading.
 *
 * result   the comparison of A and B. */
MUST_CHECK Status cause_place(const Picture *a, const Picture *b, const Samples *samples,
                              const CompareResult *result, Sentence *out, Err *err);

#endif
