/* What comparisons of all kinds begin with, and what they ask of single pixels. Private to the
 * module compare. */
#ifndef CORCAST_COMPARE_PIXELS_H
#define CORCAST_COMPARE_PIXELS_H

#include "compare/result.h"

/* Returns a result with nothing measured: counts of pixels are 0, other measures NAN, places
 * nowhere. `ids` is the id plane of one of the images, or NULL. */
CompareResult result_start(PlaneKind kind, int width, int height, const IdPlane *ids,
                           const Tolerance *tolerance);

/* Errors: STATUS_INPUT unless both sides are equal. */
MUST_CHECK Status check_sizes(int width_a, int height_a, int width_b, int height_b, Err *err);

/* Returns true if both pictures have the same size, channels and bits. */
bool pictures_alike(const Picture *a, const Picture *b);

/* Returns the place of a pixel, counted row by row; without ids. */
PixelPlace place_of(size_t pixel, int width);

/* Returns the largest difference over the channels of a pixel, in codes. */
int largest_difference(const Picture *a, const Picture *b, size_t pixel);
/* Returns how many codes of such a picture the tolerance lets a pixel be off. */
int allowed_codes(const Tolerance *tolerance, const Picture *picture);
/* Returns true if depths or normals of a pixel differ by more than `mm` or `deg`. Both renderings
 * have these planes and show something there. */
bool geometry_differs(const Rendering *a, const Rendering *b, size_t pixel, double mm, double deg);

/* Returns the percentile by nearest rank: the smallest of n >= 1 values that at least `fraction` of
 * all do not exceed. Reorders the values. Cost O(n). */
double percentile(double *values, size_t n, double fraction);

/* Adds structs that consist of 64-bit integers alone, member by member. */
void add_integers(void *to, const void *from, size_t bytes);

/* Adds up numbers over the rows of a picture, which several threads compute: `n` sums, of which
 * `row` adds those of row y to `sums`. The order of adding does not depend on the threads. Errors:
 * STATUS_MEMORY. */
typedef void RowSums(const void *context, int y, double *sums);
MUST_CHECK Status rows_sum(int height, RowSums *row, const void *context, double *sums, size_t n,
                           Err *err);

/* Returns the angle between two vectors in degrees. It is exact for small angles, too. */
double angle_deg(const float *a, const float *b);

#endif
