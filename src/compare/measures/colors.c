/* Compares two images of linear colors in floats. The colors are not converted to codes, so that
 * each difference counts, however bright or small. A level is 1/255 of the sRGB curve, continued
 * above white. A pixel that is not finite in either image becomes black in copies of both, so all
 * other measures see it as equal. */
#include "compare/measures/labels.h"
#include "compare/measures/perception.h"
#include "compare/measures/planes.h"
#include "compare/pixels.h"
#include "compare/rules/judge.h"

#include <math.h>
#include <string.h>

/* The sRGB curve continued above 1 and mirrored below 0, in 8-bit levels. */
static double levels_of(float linear)
{
    double x = fabs((double)linear);
    double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * elementary_pow(x, 1 / 2.4) - 0.055;
    return 255 * copysign(encoded, (double)linear);
}

static bool is_finite(const float *values, int channels)
{
    for (int c = 0; c < channels; c++)
        if (!isfinite(values[c]))
            return false;
    return true;
}

/* Counts the pixels that are not finite and makes them black in both. */
static void blacken(Plane *a, Plane *b, CompareResult *result)
{
    size_t channels = (size_t)a->channels, n = result_count(result, MEASURE_PIXELS);
    for (size_t i = 0; i < n; i++) {
        float *in_a = a->values + i * channels, *in_b = b->values + i * channels;
        bool sound_a = is_finite(in_a, a->channels), sound_b = is_finite(in_b, a->channels);
        result->values[MEASURE_NAN_PIXELS] += !sound_a + !sound_b;
        if (sound_a && sound_b)
            continue;
        result->values[MEASURE_JUDGED_PIXELS]--;
        if (result->places[PLACE_NAN].x < 0)
            result->places[PLACE_NAN] = pixel_place(i, a->width);
        memset(in_a, 0, channels * sizeof *in_a);
        memset(in_b, 0, channels * sizeof *in_b);
    }
    result->values[MEASURE_NOT_FINITE] = result->values[MEASURE_NAN_PIXELS];
}

/* Sums over all pixels, in levels. */
typedef struct ColorSums {
    double sum, squares, bias[4], worst;
    size_t differing, beyond;
} ColorSums;

/* Adds a pixel and returns its largest difference; -1 if the pixel is equal in both. */
static double add_pixel(const float *a, const float *b, size_t channels, ColorSums *sums)
{
    double largest = -1;
    for (size_t c = 0; c < channels; c++) {
        if (a[c] == b[c])
            continue;
        double difference = levels_of(b[c]) - levels_of(a[c]);
        sums->bias[c] += difference;
        sums->sum += fabs(difference);
        sums->squares += difference * difference;
        largest = fmax(largest, fabs(difference));
    }
    return largest;
}

/* Sets the measures that follow from the sums. */
static void take_color_sums(const ColorSums *sums, int channels, CompareResult *result)
{
    double *values = result->values, judged = values[MEASURE_JUDGED_PIXELS];
    double samples = judged * channels, bias = 0;
    double rmse = samples > 0 ? sqrt(sums->squares / samples) : 0;
    for (int c = 0; c < channels && samples > 0; c++)
        if (fabs(sums->bias[c] / judged) > fabs(bias))
            bias = sums->bias[c] / judged;
    values[MEASURE_DIFFERING_PIXELS] = (double)sums->differing;
    values[MEASURE_BEYOND_PIXELS] = (double)sums->beyond;
    values[MEASURE_MAX_ABS] = values[MEASURE_UNSETTLED_MAX_ABS] = sums->worst;
    values[MEASURE_MEAN_ABS] = samples > 0 ? sums->sum / samples : 0;
    values[MEASURE_RMSE] = rmse;
    values[MEASURE_PSNR_DB] = rmse > 0 ? 20 * elementary_log10(255 / rmse) : (double)INFINITY;
    values[MEASURE_BIAS_LEVELS] = bias;
    result->classes[PIXEL_SHADING] = sums->differing;
    result->classes[PIXEL_IDENTICAL] = (size_t)judged - sums->differing;
}

static void measure(const Plane *a, const Plane *b, CompareResult *result)
{
    ColorSums sums = {0};
    size_t channels = (size_t)a->channels, n = result_count(result, MEASURE_PIXELS);
    const double limit = result->tolerance.limits[LIMIT_COLOR_LEVELS];
    for (size_t i = 0; i < n; i++) {
        double largest =
            add_pixel(a->values + i * channels, b->values + i * channels, channels, &sums);
        if (largest < 0)
            continue;
        sums.differing++;
        sums.beyond += limit > 0 ? largest > limit : 1;
        if (largest <= sums.worst && result->places[PLACE_WORST].x >= 0)
            continue;
        sums.worst = largest;
        result->places[PLACE_WORST] = pixel_place(i, a->width);
    }
    take_color_sums(&sums, a->channels, result);
}

static Status measure_perception(const Plane *a, const Plane *b, CompareResult *result, Err *err)
{
    Picture picture_a = {0}, picture_b = {0};
    FlipSummary hdr;
    Status status = STATUS_OK;
    TRY_GOTO(hdr_flip_compute(a, b, NULL, &hdr, err));
    result->values[MEASURE_HDR_FLIP_MEAN] = hdr.mean;
    TRY_GOTO(picture_from_plane(&picture_a, a, ENCODING_SRGB, 16, err));
    TRY_GOTO(picture_from_plane(&picture_b, b, ENCODING_SRGB, 16, err));
    TRY_GOTO(compare_perception(&picture_a, &picture_b, result, err));
done:
    picture_release(&picture_a);
    picture_release(&picture_b);
    return status;
}

static Status copy_plane(Plane *copy, const Plane *plane, Err *err)
{
    TRY(plane_init(copy, plane->width, plane->height, plane->channels, err));
    size_t n = (size_t)plane->width * (size_t)plane->height * (size_t)plane->channels;
    memcpy(copy->values, plane->values, n * sizeof *copy->values);
    return STATUS_OK;
}

Status compare_colors(const Rendering *of_a, const Rendering *of_b, const Tolerance *tolerance,
                      bool perception, CompareResult *result, Err *err)
{
    const Plane *a = of_a->color, *b = of_b->color;
    TRY(check_sizes(a->width, a->height, b->width, b->height, err));
    if (a->channels != b->channels || (a->channels != 1 && a->channels != 3))
        return err_set(err, STATUS_INPUT,
                       "the images differ in channels (%d and %d floats per pixel); both must have "
                       "1 or both 3",
                       a->channels, b->channels);
    TRY(labels_check_ids(a->width, a->height, of_a->ids, of_b->ids, err));
    CompareResult made = result_start(PLANE_COLOR, a->width, a->height, of_a->ids, tolerance);
    made.values[MEASURE_BITS] = 32;
    Plane copy_a = {0}, copy_b = {0};
    Status status = STATUS_OK;
    TRY_GOTO(copy_plane(&copy_a, a, err));
    TRY_GOTO(copy_plane(&copy_b, b, err));
    blacken(&copy_a, &copy_b, &made);
    measure(&copy_a, &copy_b, &made);
    if (perception)
        TRY_GOTO(measure_perception(&copy_a, &copy_b, &made, err));
    result_finish(&made, of_a->ids, of_b->ids);
    *result = made;
done:
    plane_release(&copy_a);
    plane_release(&copy_b);
    return status;
}
