/* Computes the measures of two pictures from the sums over all pixels (pixel_counts.c), and judges
 * them. */
#include "compare/measure.h"
#include "compare/measures/perception.h"
#include "compare/measures/pixel_counts.h"
#include "compare/measures/planes.h"
#include "compare/pixels.h"
#include "compare/rules/judge.h"

#include <math.h>
#include <string.h>

/* Computes the measures of color from the sums. */
static void take_color(const PixelSums *sums, double code_levels, int channels,
                       CompareResult *result)
{
    double *values = result->values, pixels = values[MEASURE_PIXELS], bias_levels = 0;
    double samples = pixels * channels,
           rmse = sqrt((double)sums->total.squares / samples) * code_levels;
    for (int c = 0; c < channels; c++) {
        double bias = (double)sums->total.signed_codes[c] / pixels * code_levels;
        if (fabs(bias) > fabs(bias_levels))
            bias_levels = bias;
    }
    double brighter = (double)sums->total.brighter, darker = (double)sums->total.darker;
    values[MEASURE_MAX_CODE] = sums->max;
    values[MEASURE_MAX_ABS] = sums->max * code_levels;
    values[MEASURE_UNSETTLED_MAX_ABS] = sums->unsettled_max * code_levels;
    values[MEASURE_MEAN_ABS] = (double)sums->total.abs / samples * code_levels;
    values[MEASURE_RMSE] = rmse;
    values[MEASURE_PSNR_DB] = rmse > 0 ? 20 * elementary_log10(255 / rmse) : (double)INFINITY;
    values[MEASURE_BIAS_LEVELS] = bias_levels;
    values[MEASURE_SIGN_SIGMA] = sums->total.counts[COUNT_DIFFERING]
                                     ? (brighter - darker) / sqrt(fmax(brighter + darker, 1))
                                     : 0;
    if (sums->max > 0)
        result->places[PLACE_WORST] = sums->worst;
    for (int i = 0; i < PIXEL_CLASSES; i++)
        result->classes[i] = sums->total.classes[i];
}

static Status check_views(const Rendering *a, const Rendering *b, Err *err)
{
    const Picture *in_a = a->picture, *in_b = b->picture;
    TRY(check_sizes(in_a->width, in_a->height, in_b->width, in_b->height, err));
    if (in_a->channels != in_b->channels || in_a->bits != in_b->bits)
        return err_set(err, STATUS_INPUT,
                       "the images differ in channels x bits per pixel (%d x %d and %d x %d); both "
                       "must have the same",
                       in_a->channels, in_a->bits, in_b->channels, in_b->bits);
    return labels_check_ids(in_a->width, in_a->height, a->ids, b->ids, err);
}

/* Sets all measures that follow from the sums. */
static Status take_counts(const PixelCounter *counting, CompareResult *result, Ledger *ledger,
                          Err *err)
{
    double code_levels = counting->a->picture->bits == 8 ? 1 : 1 / 257.0;
    int channels = counting->a->picture->channels;
    const PixelSums *sums = counting->sums;
    double *values = result->values;
    bool labelled = counting->labels->source != LABELS_UNKNOWN;
    take_color(sums, code_levels, channels, result);
    result_set_counts(sums->total.counts, labelled, result);
    if (!labelled)
        return STATUS_OK;
    double moved = values[MEASURE_EXTRA_PIXELS] - values[MEASURE_MISSING_PIXELS];
    values[MEASURE_INTERIOR_MAX_ABS] = sums->interior_max * code_levels;
    values[MEASURE_SILHOUETTE_PX] =
        sums->total.silhouette ? moved / (PX_PER_SIDE * (double)sums->total.silhouette) : 0;
    if (counting->common_only)
        values[MEASURE_JUDGED_PIXELS] = values[MEASURE_COMMON_PIXELS];
    TRY(result_set_region(counting->coverage, counting->labels, result, err));
    if (!counting->index)
        return STATUS_OK;
    TRY(result_set_regression(counting, code_levels, result, err));
    TRY(ledger_from_sums(ledger, counting->index, counting->segments, channels, code_levels, err));
    result_set_segments(ledger, result);
    return STATUS_OK;
}

static PixelCounter start_counting(const Rendering *a, const Rendering *b, const Labels *labels,
                                   const Tolerance *tolerance)
{
    return (PixelCounter){.a = a,
                          .b = b,
                          .labels = labels,
                          .beyond = allowed_codes(tolerance, a->picture),
                          .common_only = tolerance->limits[LIMIT_COLOR_COMMON_ONLY] > 0 &&
                                         labels->source != LABELS_UNKNOWN,
                          .settled = tolerance->settled,
                          .geometry_mm = fmin(tolerance->limits[LIMIT_DEPTH_MAX_MM],
                                              tolerance->limits[LIMIT_DEPTH_P99_MM]),
                          .geometry_deg = fmin(tolerance->limits[LIMIT_NORMAL_MAX_DEG], 1)};
}

static Labels labels_of(const Rendering *a, const Rendering *b)
{
    return a->ids ? labels_from_ids(a->ids, b->ids)
                  : labels_from_background(a->picture, b->picture);
}

Status class_picture(Picture *out, const Rendering *a, const Rendering *b,
                     const Tolerance *tolerance, Err *err)
{
    Picture made;
    TRY(check_views(a, b, err));
    Labels labels = labels_of(a, b);
    PixelCounter counting = start_counting(a, b, &labels, tolerance);
    TRY(picture_init(&made, labels.width, labels.height, 1, 8, err));
    memset(made.codes8, PIXEL_IDENTICAL, (size_t)labels.width * (size_t)labels.height);
    counting.classes = made.codes8;
    Status status = STATUS_OK;
    TRY_GOTO(count_pixels(&counting, err));
    *out = made;
    made = (Picture){0};
done:
    counting_release(&counting);
    picture_release(&made);
    return status;
}

/* Returns the picture before it was composited over a background. */
static const Picture *as_read(const Rendering *rendering)
{
    const Picture *transparent = rendering->transparent;
    return transparent && transparent->width > 0 ? transparent : rendering->picture;
}

Status compare_pictures(const Rendering *a, const Rendering *b, const Tolerance *tolerance,
                        CompareResult *result, Ledger *ledger, Err *err)
{
    TRY(check_views(a, b, err));
    const Picture *picture = a->picture;
    CompareResult made =
        result_start(PLANE_COLOR, picture->width, picture->height, a->ids, tolerance);
    made.values[MEASURE_BITS] = picture->bits;
    Labels labels = labels_of(a, b);
    SegmentIndex index = {0};
    Ledger of_segments = {0};
    PixelCounter counting = start_counting(a, b, &labels, tolerance);
    counting.index = a->ids ? &index : NULL;
    Status status = STATUS_OK;
    if (counting.index)
        TRY_GOTO(segment_index_init(&index, a->ids, b->ids, err));
    TRY_GOTO(count_pixels(&counting, err));
    TRY_GOTO(take_counts(&counting, &made, &of_segments, err));
    if (!isnan(tolerance->limits[LIMIT_PIXELMATCH]))
        made.values[MEASURE_PIXELMATCH_PIXELS] =
            (double)pixelmatch_count(as_read(a), as_read(b), tolerance->limits[LIMIT_PIXELMATCH]);
    result_finish(&made, a->ids, b->ids);
    *result = made;
    if (ledger) {
        *ledger = of_segments;
        of_segments = (Ledger){0};
    }
done:
    ledger_release(&of_segments);
    segment_index_release(&index);
    counting_release(&counting);
    return status;
}

Status compare_perception(const Picture *a, const Picture *b, CompareResult *result, Err *err)
{
    for (size_t i = 0; i < n_measures; i++) {
        bool is_found = measures[i].find == NULL;
        for (size_t k = 0; k < i && !is_found; k++)
            is_found = measures[k].find == measures[i].find;
        if (!is_found)
            TRY(measures[i].find(a, b, result->values, err));
    }
    return STATUS_OK;
}
