/* Compares two pictures, or two planes of one kind. Each function with a Tolerance measures the
 * differences and judges them. It sets all members of *result, on success only. *result borrows the
 * strings and arrays of the tolerance. */
#ifndef CORCAST_COMPARE_MEASURES_PLANES_H
#define CORCAST_COMPARE_MEASURES_PLANES_H

#include "compare/result.h"

/* Compares the pictures of two renderings. If both renderings have ids, depths and normals, they
 * are used to classify the pixels. Does not compute the perceptual measures.
 *
 * ledger  receives an entry per segment, or none without ids; release it with ledger_release. NULL:
 *         not wanted.
 * Errors  STATUS_INPUT if sizes, channels or bits differ; STATUS_MEMORY. */
MUST_CHECK Status compare_pictures(const Rendering *a, const Rendering *b,
                                   const Tolerance *tolerance, CompareResult *result,
                                   Ledger *ledger, Err *err);

/* Makes a picture of the classes of all pixels: grey, 8 bits, each code a PixelClass.
 *
 * out      the caller releases it; set on success only.
 * Errors   those of compare_pictures. */
MUST_CHECK Status class_picture(Picture *out, const Rendering *a, const Rendering *b,
                                const Tolerance *tolerance, Err *err);

/* Adds the perceptual measures of two pictures to their result. The pictures have equal size,
 * channels and bits, and are taken as sRGB. Errors: STATUS_MEMORY. */
MUST_CHECK Status compare_perception(const Picture *a, const Picture *b, CompareResult *result,
                                     Err *err);

/* Compares the planes `color` of two renderings: linear floats, 1 or 3 channels. Differences are in
 * levels of the sRGB curve, continued above white and mirrored below black. Pixels with a value
 * that is not finite are only counted. Ids only serve to name segments in the result.
 *
 * perception  true: also computes HDR-FLIP of the colors, and the other perceptual measures of the
 *             colors clipped to white.
 * Errors      STATUS_INPUT if sizes or channels differ; STATUS_MEMORY. */
MUST_CHECK Status compare_colors(const Rendering *a, const Rendering *b, const Tolerance *tolerance,
                                 bool perception, CompareResult *result, Err *err);

/* Compares the planes `depth` (1 channel, INFINITY where no surface is visible) or `normal` (3
 * channels, 0 0 0 where no surface is visible) of two renderings. Pixels with NaN, or with a depth
 * of minus infinity, are only counted. Ids only serve to name segments in the result.
 *
 * kind    PLANE_DEPTH or PLANE_NORMAL.
 * Errors  STATUS_INPUT if sizes or channels differ; STATUS_MEMORY. */
MUST_CHECK Status compare_planes(PlaneKind kind, const Rendering *a, const Rendering *b,
                                 const Tolerance *tolerance, CompareResult *result, Err *err);

/* Compares two id planes. Errors: STATUS_INPUT if sizes differ; STATUS_MEMORY. */
MUST_CHECK Status compare_ids(const IdPlane *a, const IdPlane *b, const Tolerance *tolerance,
                              CompareResult *result, Err *err);

/* ---- alpha ----------------------------------------------------------------------------------- */

/* Copies the alpha channel of an image that was read with ALPHA_KEPT.
 *
 * alpha    receives a grey picture of 16 bits, which the caller releases; unchanged if the image
 *          has no alpha channel.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status alpha_of_image(Picture *alpha, const Image *image, Err *err);

/* Compares the alpha channels of two transparent pictures by the tolerance of their colors. If the
 * colors agree and alpha does not, sets agrees, reason and cause of *result.
 *
 * a, b     made by alpha_of_image. A picture without codes stands for an opaque image. If either
 *          has none, alpha is not compared, because transparent colors were composited over a
 *          background.
 * result   the comparison of the colors.
 * Errors   STATUS_INPUT if the sizes differ; STATUS_MEMORY. */
MUST_CHECK Status result_judge_alpha(const Picture *a, const Picture *b, CompareResult *result,
                                     Err *err);

#endif
