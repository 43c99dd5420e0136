/* Functions on single pixels and rows that several parts of the module share. Private to the module
 * compare. */
#ifndef CORCAST_COMPARE_PIXELS_H
#define CORCAST_COMPARE_PIXELS_H

#include "compare/result.h"

/* Returns the initial result of a comparison, before anything is measured: counts of pixels are 0,
 * other measures are NAN, and CompareResult.places has no pixels. `ids` is the id plane of either
 * image; NULL: no ids. The result borrows the strings and arrays of `tolerance`. */
CompareResult result_start(PlaneKind kind, int width, int height, const IdPlane *ids,
                           const Tolerance *tolerance);

/* Checks that two images have equal size. Errors: STATUS_INPUT. */
MUST_CHECK Status check_sizes(int width_a, int height_a, int width_b, int height_b, Err *err);
/* Returns true if both pictures have the same size, channels and bits. */
bool pictures_have_same_form(const Picture *a, const Picture *b);

/* Returns column and row of the pixel with the index `pixel`, which counts row by row. The ids of
 * the result are 0. */
PixelPlace pixel_place(size_t pixel, int width);

/* Returns the largest |difference|, in codes, over the channels of a pixel of two pictures of equal
 * form [pictures_have_same_form]. */
int largest_difference(const Picture *a, const Picture *b, size_t pixel);
/* Returns the maximum difference of a pixel that counts as equal: LIMIT_COLOR_LEVELS, which is in
 * levels of 1/255, converted to codes of the picture's bit depth and rounded down. */
int allowed_codes(const Tolerance *tolerance, const Picture *picture);
/* Returns true if the depths of a pixel differ by more than `mm` mm, or its normals by more than
 * `deg` degrees. Both renderings must have depths and normals, and show a surface at the pixel. */
bool geometry_differs(const Rendering *a, const Rendering *b, size_t pixel, double mm, double deg);
/* Returns the angle between two vectors in degrees. Small angles are accurate, too. */
double angle_deg(const float *a, const float *b);

/* Returns a percentile by nearest rank: the smallest of n >= 1 values such that at least `fraction`
 * of all values do not exceed it. Reorders the values. Cost: O(n). */
double percentile(double *values, size_t n, double fraction);

/* Makes a table of the linear colors of the sRGB codes of 8 or 16 bits, in [0, 1]. The caller frees
 * *table. Errors: STATUS_MEMORY. */
MUST_CHECK Status srgb_table(int bits, float **table, Err *err);

/* Adds the struct *from to the struct *to, member by member. Both consist of `bytes` / 8 integers
 * of 64 bits. */
void add_integers(void *to, const void *from, size_t bytes);

/* Adds the values of row `y` to the n sums; n is the argument of rows_sum. Several threads call the
 * function at the same time, for different rows and with different `sums`. */
typedef void RowSums(const void *context, int y, double *sums);
/* Adds the `n` sums over all rows of a picture to `sums`. Rows are computed by all processors and
 * added in order, so the result does not depend on the number of processors. Errors: STATUS_MEMORY.
 */
MUST_CHECK Status rows_sum(int height, RowSums *row, const void *context, double *sums, size_t n,
                           Err *err);

#endif
