/* Linear colours in floats: every difference counts, however bright or small, so they are not
 * turned into codes; a level is 1/255 of the sRGB encoding, continued beyond white. What is not
 * finite is made black in copies of both, which the measures of perception then see as equal. */
#include "compare/measures/labels.h"
#include "compare/measures/result.h"

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
    size_t channels = (size_t)a->channels;
    for (size_t i = 0; i < result->pixels; i++) {
        float *in_a = a->values + i * channels, *in_b = b->values + i * channels;
        bool sound_a = is_finite(in_a, a->channels), sound_b = is_finite(in_b, a->channels);
        result->nan_pixels_a += !sound_a;
        result->nan_pixels_b += !sound_b;
        if (sound_a && sound_b)
            continue;
        result->judged_pixels--;
        if (result->nan_at.x < 0)
            result->nan_at = place_of(i, a->width);
        memset(in_a, 0, channels * sizeof *in_a);
        memset(in_b, 0, channels * sizeof *in_b);
    }
}

static void measure(const Plane *a, const Plane *b, CompareResult *result)
{
    double sum = 0, squares = 0, bias[4] = {0}, worst = 0;
    size_t channels = (size_t)a->channels, unsound = result->pixels - result->judged_pixels;
    double limit = result->tolerance.color_levels;
    for (size_t i = 0; i < result->pixels; i++) {
        double largest = 0;
        bool differs = false;
        for (size_t c = 0; c < channels; c++) {
            float in_a = a->values[i * channels + c], in_b = b->values[i * channels + c];
            if (in_a == in_b)
                continue;
            double difference = levels_of(in_b) - levels_of(in_a);
            differs = true;
            bias[c] += difference;
            sum += fabs(difference);
            squares += difference * difference;
            largest = fmax(largest, fabs(difference));
        }
        result->differing_pixels += differs;
        result->beyond_pixels += limit > 0 ? largest > limit : differs;
        result->classes[differs ? PIXEL_SHADING : PIXEL_IDENTICAL]++;
        if (differs && (largest > worst || result->worst.x < 0)) {
            worst = largest;
            result->worst = place_of(i, a->width);
        }
    }
    result->classes[PIXEL_IDENTICAL] -= unsound;
    double samples = (double)result->judged_pixels * (double)channels;
    result->max_abs = result->unsettled_max_abs = worst;
    result->mean_abs = samples > 0 ? sum / samples : 0;
    result->rmse = samples > 0 ? sqrt(squares / samples) : 0;
    result->psnr_db =
        result->rmse > 0 ? 20 * elementary_log10(255 / result->rmse) : (double)INFINITY;
    result->bias_levels = 0;
    for (size_t c = 0; c < channels && samples > 0; c++) {
        double mean = bias[c] / (double)result->judged_pixels;
        if (fabs(mean) > fabs(result->bias_levels))
            result->bias_levels = mean;
    }
}

static Status measure_perception(const Plane *a, const Plane *b, CompareResult *result, Err *err)
{
    Picture picture_a = {0}, picture_b = {0};
    FlipSummary hdr;
    Status status = STATUS_OK;
    TRY_GOTO(hdr_flip_compute(a, b, NULL, &hdr, err));
    result->hdr_flip_mean = hdr.mean;
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

Status compare_colors(const Plane *a, const Plane *b, const IdPlane *id_a, const IdPlane *id_b,
                      const Tolerance *tolerance, bool perception, CompareResult *result, Err *err)
{
    TRY(check_sizes(a->width, a->height, b->width, b->height, err));
    if (a->channels != b->channels || (a->channels != 1 && a->channels != 3))
        return err_set(err, STATUS_INPUT,
                       "the images differ in depth: %d and %d channels of floats; both must have 1 "
                       "or both 3",
                       a->channels, b->channels);
    TRY(labels_check_ids(a->width, a->height, id_a, id_b, err));
    CompareResult made = result_start(PLANE_COLOR, a->width, a->height, id_a, tolerance);
    made.bits = 32;
    Plane copy_a = {0}, copy_b = {0};
    Status status = STATUS_OK;
    TRY_GOTO(copy_plane(&copy_a, a, err));
    TRY_GOTO(copy_plane(&copy_b, b, err));
    blacken(&copy_a, &copy_b, &made);
    measure(&copy_a, &copy_b, &made);
    if (perception)
        TRY_GOTO(measure_perception(&copy_a, &copy_b, &made, err));
    result_finish(&made, id_a, id_b);
    *result = made;
done:
    plane_release(&copy_a);
    plane_release(&copy_b);
    return status;
}
