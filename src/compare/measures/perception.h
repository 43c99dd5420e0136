/* Measures how visible the difference of two pictures is to people: FLIP, SSIM, CIEDE2000 and
 * pixelmatch.
 *
 * Both pictures have equal size, channels and bit depth, and are taken as sRGB. Each function that
 * ends in _find sets its own measures in `values`, which is indexed by MeasureId. Its errors are
 * STATUS_MEMORY. */
#ifndef CORCAST_COMPARE_MEASURES_PERCEPTION_H
#define CORCAST_COMPARE_MEASURES_PERCEPTION_H

#include "compare/result.h"

/* Statistics of the FLIP errors of all pixels, each in [0, 1]. In weighted statistics the weight of
 * a pixel is its error, so that the many pixels without an error do not count. Medians and 95th
 * percentiles are by nearest rank and rounded to 1/65536. All are 0 for equal images. */
typedef struct FlipSummary {
    double mean, p95, max;
    double weighted_mean, weighted_median, weighted_p95;
} FlipSummary;

/* Computes LDR-FLIP [Andersson et al. 2020, Proc. ACM CGIT 3(2), 15; version 1.6] at its default of
 * 67.02 pixels per degree.
 *
 * map       receives the error of each pixel, 1 channel; the caller releases it. May be NULL.
 * Errors    STATUS_MEMORY. */
MUST_CHECK Status flip_compute(const Picture *a, const Picture *b, Plane *map, FlipSummary *summary,
                               Err *err);
/* Sets the measures MEASURE_FLIP_... by LDR-FLIP. */
MUST_CHECK Status flip_find(const Picture *a, const Picture *b, double values[MEASURES], Err *err);

/* Computes HDR-FLIP [Andersson et al. 2021, HPG short papers; version 1.6] of two planes of finite
 * linear colors: the largest LDR-FLIP over a range of exposures. The luminance of A decides the
 * range; colors are tone mapped by ACES.
 *
 * map      receives the error of each pixel, 1 channel; the caller releases it. May be NULL.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status hdr_flip_compute(const Plane *a, const Plane *b, Plane *map, FlipSummary *summary,
                                   Err *err);

/* Computes the mean SSIM of luma [Wang et al. 2004, IEEE Trans. Image Process. 13, 600], with an 11
 * x 11 Gaussian window of sigma 1.5, over all windows inside the picture. The measure is NAN if the
 * picture is smaller than the window. */
MUST_CHECK Status ssim_find(const Picture *a, const Picture *b, double values[MEASURES], Err *err);

/* Returns the color difference CIEDE2000 [Sharma, Wu, Dalal 2005, Color Res. Appl. 30, 21] of two
 * CIELAB colors. */
double de2000(const double lab_a[3], const double lab_b[3]);
/* Computes the mean and the largest CIEDE2000 of the pixels, with white point D65. */
MUST_CHECK Status de2000_find(const Picture *a, const Picture *b, double values[MEASURES],
                              Err *err);

/* Returns the number of pixels that pixelmatch 7.2.0 marks as different. Pixels that it classifies
 * as antialiasing are not counted. Both pictures have equal size and 1, 3 or 4 channels each, the
 * fourth alpha; 16-bit codes are rounded to 8 bits.
 *
 * threshold   in [0, 1]; pixelmatch's default is 0.1. */
size_t pixelmatch_count(const Picture *a, const Picture *b, double threshold);

#endif
