/* Comparisons of two pictures, or of two planes of one kind. Each fills in a whole CompareResult
 * and judges it by the tolerance. */
#ifndef CORCAST_COMPARE_MEASURES_PLANES_H
#define CORCAST_COMPARE_MEASURES_PLANES_H

#include "compare/result.h"

/* Compares two pictures. Does not measure perception.
 *
 * ledger   receives a row for each segment; release it with ledger_release. Empty without ids. May
 *          be NULL.
 * Errors   STATUS_INPUT if sizes, channels or bits differ; STATUS_MEMORY. */
MUST_CHECK Status compare_pictures(const Rendering *a, const Rendering *b,
                                   const Tolerance *tolerance, CompareResult *result,
                                   Ledger *ledger, Err *err);

/* Finds the class of every pixel. *out is a grey picture of 8 bits whose codes are PixelClass; the
 * caller releases it. Errors as compare_pictures. */
MUST_CHECK Status class_picture(Picture *out, const Rendering *a, const Rendering *b,
                                const Tolerance *tolerance, Err *err);

/* Adds the perceptual measures of two pictures of one shape to their result. They are taken as
 * sRGB. Errors: STATUS_MEMORY. */
MUST_CHECK Status compare_perception(const Picture *a, const Picture *b, CompareResult *result,
                                     Err *err);

/* Compares the planes `color` of two renderings. Levels are those of the sRGB encoding, continued
 * above white and mirrored below black. Pixels with a value that is not finite are counted, and
 * enter no other measure. `ids` only name segments.
 *
 * perception   adds HDR-FLIP of the colors, and the other perceptual measures of the colors
 *              clipped to white.
 * Errors       STATUS_INPUT if shapes differ; STATUS_MEMORY. */
MUST_CHECK Status compare_colors(const Rendering *a, const Rendering *b, const Tolerance *tolerance,
                                 bool perception, CompareResult *result, Err *err);

/* Compares the planes `depth` (1 channel, INFINITY where nothing is seen) or `normal` (3 channels,
 * 0 0 0 where nothing is seen) of two renderings. NaN, and for a depth minus infinity, is counted
 * and enters no other measure. `ids` only name segments.
 *
 * kind         PLANE_DEPTH or PLANE_NORMAL.
 * Errors       STATUS_INPUT if shapes differ; STATUS_MEMORY. */
MUST_CHECK Status compare_planes(PlaneKind kind, const Rendering *a, const Rendering *b,
                                 const Tolerance *tolerance, CompareResult *result, Err *err);

/* Compares two id planes. Errors: STATUS_INPUT if sizes differ; STATUS_MEMORY. */
MUST_CHECK Status compare_ids(const IdPlane *a, const IdPlane *b, const Tolerance *tolerance,
                              CompareResult *result, Err *err);

/* ---- alpha ----------------------------------------------------------------------------------- */

/* Takes alpha of an image that was read with ALPHA_KEPT. *alpha becomes a grey picture of 16
 * bits, which the caller releases; it is not changed if the image is opaque. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status alpha_take(Picture *alpha, const Image *image, Err *err);

/* Judges alpha of two transparent pictures by the tolerance of their colors. If the colors agree
 * and alpha does not, the result differs, with a reason and a cause.
 *
 * a, b     as alpha_take made them. If either is empty, alpha is not judged: an opaque picture is
 *          compared with one that was composited over a background.
 * Errors   STATUS_INPUT if sizes differ; STATUS_MEMORY. */
MUST_CHECK Status alpha_judge(const Picture *a, const Picture *b, CompareResult *result, Err *err);

#endif
