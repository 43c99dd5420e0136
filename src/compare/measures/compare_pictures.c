/* Two pictures: the sums over all pixels (pixel_counts.c) become measures and a verdict. */
#include "compare/measures/regression.h"
#include "compare/measures/result.h"

#include <math.h>
#include <string.h>

static void take_color(const Sums *sums, double code_levels, int channels, CompareResult *result)
{
    double samples = (double)result->pixels * channels;
    result->max_code = sums->max;
    result->max_abs = sums->max * code_levels;
    result->unsettled_max_abs = sums->unsettled_max * code_levels;
    result->mean_abs = (double)sums->abs / samples * code_levels;
    result->rmse = sqrt((double)sums->squares / samples) * code_levels;
    result->psnr_db =
        result->rmse > 0 ? 20 * elementary_log10(255 / result->rmse) : (double)INFINITY;
    result->differing_pixels = sums->differing;
    result->beyond_pixels = sums->beyond;
    result->settled_pixels = sums->settled;
    if (sums->max > 0)
        result->worst = sums->worst;
    result->bias_levels = 0;
    for (int c = 0; c < channels; c++) {
        double bias = (double)sums->signed_codes[c] / (double)result->pixels * code_levels;
        if (fabs(bias) > fabs(result->bias_levels))
            result->bias_levels = bias;
    }
    double brighter = (double)sums->brighter, darker = (double)sums->darker;
    result->sign_sigma =
        sums->differing ? (brighter - darker) / sqrt(fmax(brighter + darker, 1)) : 0;
    memcpy(result->classes, sums->classes, sizeof result->classes);
}

static void take_mask(const Sums *sums, double code_levels, CompareResult *result)
{
    result->has_mask = true;
    result->common_pixels = sums->common;
    result->missing_pixels = sums->missing;
    result->extra_pixels = sums->extra;
    result->band_pixels = sums->band;
    result->band_beyond = sums->band_beyond;
    result->interior_beyond = sums->interior_beyond;
    result->interior_max_abs = sums->interior_max * code_levels;
    result->edge_mismatch_fraction =
        sums->band ? (double)sums->band_differs / (double)sums->band : 0;
    double moved = (double)sums->extra - (double)sums->missing;
    result->silhouette_px = sums->silhouette ? moved / (PX_PER_EDGE * (double)sums->silhouette) : 0;
}

static Status check_views(const Rendering *a, const Rendering *b, Err *err)
{
    const Picture *in_a = a->picture, *in_b = b->picture;
    TRY(check_sizes(in_a->width, in_a->height, in_b->width, in_b->height, err));
    if (in_a->channels != in_b->channels || in_a->bits != in_b->bits)
        return err_set(err, STATUS_INPUT,
                       "the images differ in depth: %d x %d and %d x %d bits a pixel; only images "
                       "of one depth can be compared",
                       in_a->channels, in_a->bits, in_b->channels, in_b->bits);
    return labels_check_ids(in_a->width, in_a->height, a->ids, b->ids, err);
}

/* What the sums say. */
static Status take_counts(const Counting *counting, CompareResult *result, Ledger *ledger, Err *err)
{
    double code_levels = counting->a->picture->bits == 8 ? 1 : 1 / 257.0;
    int channels = counting->a->picture->channels;
    take_color(counting->sums, code_levels, channels, result);
    if (counting->labels->source == LABELS_UNKNOWN)
        return STATUS_OK;
    take_mask(counting->sums, code_levels, result);
    if (counting->common_only)
        result->judged_pixels = result->common_pixels;
    if (result->missing_pixels + result->extra_pixels > 0)
        TRY(largest_region(counting->coverage, result->width, result->height,
                           &result->largest_region, &result->largest_region_at, err));
    if (!counting->index)
        return STATUS_OK;
    TRY(regression_take(counting, code_levels, result, err));
    TRY(ledger_from_sums(ledger, counting->index, counting->segments, channels, code_levels, err));
    ledger_summarise(ledger, result);
    return STATUS_OK;
}

static Counting start_counting(const Rendering *a, const Rendering *b, const Labels *labels,
                               const Tolerance *tolerance)
{
    return (Counting){.a = a,
                      .b = b,
                      .labels = labels,
                      .beyond = allowed_codes(tolerance, a->picture),
                      .common_only =
                          tolerance->color_common_only && labels->source != LABELS_UNKNOWN,
                      .settled = tolerance->settled,
                      .geometry_mm = fmin(tolerance->depth_max_mm, tolerance->depth_p99_mm),
                      .geometry_deg = fmin(tolerance->normal_max_deg, 1)};
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
    Counting counting = start_counting(a, b, &labels, tolerance);
    TRY(picture_init(&made, labels.width, labels.height, 1, 8, err));
    memset(made.codes8, PIXEL_IDENTICAL, (size_t)labels.width * (size_t)labels.height);
    counting.classes = made.codes8;
    Status status = count_pixels(&counting, err);
    counting_release(&counting);
    if (status == STATUS_OK)
        *out = made;
    else
        picture_release(&made);
    return status;
}

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
    made.bits = picture->bits;
    Labels labels = labels_of(a, b);
    SegmentIndex index = {0};
    Ledger of_segments = {0};
    Counting counting = start_counting(a, b, &labels, tolerance);
    counting.index = a->ids ? &index : NULL;
    Status status = STATUS_OK;
    if (counting.index)
        TRY_GOTO(segment_index_init(&index, a->ids, b->ids, err));
    TRY_GOTO(count_pixels(&counting, err));
    TRY_GOTO(take_counts(&counting, &made, &of_segments, err));
    if (!isnan(tolerance->pixelmatch))
        made.pixelmatch_pixels =
            (double)pixelmatch_count(as_read(a), as_read(b), tolerance->pixelmatch);
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
    FlipSummary flip;
    TRY(flip_compute(a, b, NULL, &flip, err));
    result->flip_mean = flip.mean;
    result->flip_max = flip.max;
    TRY(ssim_compute(a, b, &result->ssim, err));
    return de2000_compute(a, b, &result->de2000_mean, &result->de2000_max, err);
}
