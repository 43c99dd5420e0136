/* Lists the measures in a table: for each number that a comparison yields, the planes it is for,
 * its key in JSON, its row in tables of reports, and the rule that judges it. The order of the rows
 * is the order of the keys in JSON, on which programs may rely. Tables of reports are sorted by
 * rank. Limits are judged in the order of the enum Limit: values that are not numbers, missing or
 * extra pixels, wrong segments, then sizes of differences.
 */
#include "compare/measure.h"

#include "compare/measures/perception.h"

enum {
    COLOR = 1 << PLANE_COLOR,
    DEPTH = 1 << PLANE_DEPTH,
    NORMAL = 1 << PLANE_NORMAL,
    IDS = 1 << PLANE_ID,
    GEOMETRY = DEPTH | NORMAL,
    ALL = COLOR | GEOMETRY | IDS
};

#define SHOWN(in, order, name, of) .table = TABLE_##in, .rank = (order), .label = name, .unit = of
/* JUDGED is a rule about the measure itself, JUDGED_PPM about parts per million of a count.
 * JUDGED_BEYOND also appends the value of a setting to the rule's name. */
#define JUDGED(by, text, of, place, what)                                                          \
    .rule = {.limit = LIMIT_##by, .name = text, .unit = of, .at = PLACE_##place, .at_what = what}
#define JUDGED_PPM(by, of, text, place, what)                                                      \
    .rule = {LIMIT_##by, MEASURE_##of, text, .unit = "ppm", .at = PLACE_##place, .at_what = what}
#define JUDGED_BEYOND(by, of, text, setting, n, after)                                             \
    .rule = {LIMIT_##by, MEASURE_##of, text, LIMIT_##setting, n, after, "ppm", PLACE_WORST, NULL}

static const char worst_is[] = "the worst pixel is", first_is[] = "the first is",
                  middle_is[] = "its middle is", region_starts[] = "the largest region starts";

const Measure measures[] = {
    {ALL, MEASURE_PIXELS, .key = "pixels"},
    {ALL, MEASURE_WIDTH, .key = "width"},
    {ALL, MEASURE_HEIGHT, .key = "height"},
    {ALL, MEASURE_BITS, .key = "bits"},
    {ALL, MEASURE_DIFFERING_PIXELS, .key = "differing_pixels"},
    {COLOR, MEASURE_DIFFERING_PIXELS, SHOWN(SIZES, 0, "differing pixels", "")},
    {ALL, MEASURE_MISSING_PIXELS, .key = "missing_pixels",
     SHOWN(OUTLINES, 2, "missing pixels (seen in A only)", "")},
    {ALL, MEASURE_EXTRA_PIXELS, .key = "extra_pixels",
     SHOWN(OUTLINES, 2, "extra pixels (seen in B only)", "")},
    {ALL, MEASURE_COMMON_PIXELS, .key = "common_pixels",
     SHOWN(OUTLINES, 1, "pixels seen in both", "")},
    {GEOMETRY, MEASURE_UNCOMMON_PIXELS,
     JUDGED_PPM(COVERAGE_PPM, PIXELS, "pixels seen in only one image", REGION, region_starts)},
    {ALL, MEASURE_LARGEST_REGION, .key = "largest_region",
     JUDGED(REGION_PIXELS, "largest missing or extra region", "pixels", REGION, "it starts")},
    {ALL, MEASURE_NAN_PIXELS, .key = "nan_pixels"},
    {COLOR, MEASURE_NOT_FINITE, JUDGED(NAN, "colors that are not finite", "pixels", NAN, first_is)},
    {ALL, MEASURE_MAX_ABS, .key = "max_abs", SHOWN(SIZES, 0, "largest difference", "levels")},
    {ALL, MEASURE_MAX_CODE, .key = "max_code"},
    {ALL, MEASURE_MEAN_ABS, .key = "mean_abs", SHOWN(SIZES, 1, "mean difference", "levels")},
    {ALL, MEASURE_RMSE, .key = "rmse", SHOWN(SIZES, 1, "root mean square", "levels")},
    {ALL, MEASURE_PSNR_DB, .key = "psnr_db", SHOWN(SIZES, 1, "PSNR", "dB")},
    {ALL, MEASURE_FLIP_MEAN, .key = "flip_mean", SHOWN(PERCEPTION, 1, "FLIP, mean", ""),
     .find = flip_find},
    {ALL, MEASURE_SSIM, .key = "ssim", SHOWN(PERCEPTION, 0, "SSIM of luma", ""), .find = ssim_find},
    {COLOR, MEASURE_BEYOND_PIXELS,
     JUDGED_BEYOND(COLOR_PPM, JUDGED_PIXELS, "pixels off by more than", COLOR_LEVELS, 3,
                   " levels")},
    {ALL, MEASURE_INTERIOR_MAX_ABS, .key = "interior_max_abs",
     SHOWN(SIZES, 0, "largest difference away from edges", "levels"),
     JUDGED(INTERIOR_LEVELS, "largest difference away from edges", "levels", WORST, NULL)},
    {COLOR, MEASURE_INTERIOR_BEYOND,
     JUDGED_BEYOND(INTERIOR_PPM, INTERIOR_PIXELS, "interior pixels off by more than", COLOR_LEVELS,
                   3, " levels")},
    {COLOR, MEASURE_BAND_BEYOND,
     JUDGED_BEYOND(BAND_PPM, BAND_PIXELS, "edge pixels off by more than", COLOR_LEVELS, 3,
                   " levels")},
    {ALL, MEASURE_EDGE_MISMATCH, .key = "edge_mismatch_fraction"},
    {ALL, .part = PART_WORST, .key = "worst"},
    {ALL, .part = PART_RULES, .key = "rules"},
    {COLOR, .part = PART_CLASSES, .key = "classes", SHOWN(CLASSES, 0, "", "")},
    {COLOR, MEASURE_BIAS_LEVELS, .key = "bias_levels",
     SHOWN(SIGNS, 0, "signed mean, worst channel", "levels"),
     JUDGED(BIAS_LEVELS, "mean difference", "levels", WORST, NULL)},
    {COLOR, MEASURE_SIGN_SIGMA, .key = "sign_sigma",
     SHOWN(SIGNS, 0, "excess of brighter pixels over darker ones", "sigma"),
     JUDGED(SIGN_SIGMA, "excess of brighter or of darker pixels", "sigma", WORST, NULL)},
    {COLOR, MEASURE_SILHOUETTE_PX, .when = WHEN_IDS, .key = "silhouette_px",
     SHOWN(OUTLINES, 0, "silhouette, outward shift", "px"),
     JUDGED(SILHOUETTE_PX, "shift of the silhouette", "px", REGION, region_starts)},
    {COLOR, MEASURE_SILHOUETTE_PX, .when = WHEN_NO_IDS, .key = "silhouette_px",
     SHOWN(OUTLINES, 0, "outline against the background, outward shift", "px"),
     JUDGED(SILHOUETTE_PX, "shift of the outline against the background", "px", REGION,
            region_starts)},
    {COLOR, MEASURE_GAIN, .key = "gain", SHOWN(SIGNS, 0, "gain", "")},
    {COLOR, MEASURE_GAIN_EXCESS, JUDGED(GAIN, "distance of the gain from 1", "", WORST, worst_is)},
    {COLOR, MEASURE_OFFSET_LEVELS, .key = "offset_levels", SHOWN(SIGNS, 0, "offset", "levels")},
    {COLOR, MEASURE_OFFSET_EXCESS,
     JUDGED(OFFSET_LEVELS, "distance of the offset from 0", "levels", WORST, worst_is)},
    {COLOR, MEASURE_SEGMENTS, .key = "segments"},
    {COLOR, MEASURE_SEGMENTS_MISSING, .key = "segments_missing"},
    {COLOR, MEASURE_SEGMENTS_MISSING, .when = WHEN_MASK,
     JUDGED(SEGMENTS_MISSING, "segments seen in only one image", "segments", SEGMENT_MISSING,
            first_is)},
    {COLOR, MEASURE_SEGMENT_LEVELS, .key = "segment_levels",
     SHOWN(SIGNS, 0, "mean of the segment that differs most", "levels"),
     JUDGED(SEGMENT_LEVELS, "mean difference of a segment", "levels", SEGMENT_LEVELS, middle_is)},
    {COLOR, MEASURE_SEGMENT_PX, .key = "segment_px",
     SHOWN(OUTLINES, 0, "outward shift of the outline that moved most", "px"),
     JUDGED(SEGMENT_PX, "shift of the outline of a segment", "px", SEGMENT_PX, middle_is)},
    {COLOR, .part = PART_SEGMENTS, .key = "worst_segments"},
    {COLOR, MEASURE_FLIP_MAX, .key = "flip_max", SHOWN(PERCEPTION, 1, "FLIP, largest", ""),
     .find = flip_find},
    {COLOR, MEASURE_FLIP_P95, .key = "flip_p95", SHOWN(PERCEPTION, 1, "FLIP, 95th percentile", ""),
     .find = flip_find},
    {COLOR, MEASURE_FLIP_WEIGHTED_MEAN, .key = "flip_weighted_mean",
     SHOWN(PERCEPTION, 1, "FLIP, mean weighted by error", ""), .find = flip_find},
    {COLOR, MEASURE_FLIP_WEIGHTED_MEDIAN, .key = "flip_weighted_median",
     SHOWN(PERCEPTION, 1, "FLIP, median weighted by error", ""), .find = flip_find},
    {COLOR, MEASURE_FLIP_WEIGHTED_P95, .key = "flip_weighted_p95",
     SHOWN(PERCEPTION, 1, "FLIP, 95th percentile weighted by error", ""), .find = flip_find},
    {COLOR, MEASURE_HDR_FLIP_MEAN, .key = "hdr_flip_mean",
     SHOWN(PERCEPTION, 1, "HDR-FLIP, mean", "")},
    {COLOR, MEASURE_DE2000_MEAN, .key = "de2000_mean", SHOWN(PERCEPTION, 1, "CIEDE2000, mean", ""),
     .find = de2000_find},
    {COLOR, MEASURE_DE2000_MAX, .key = "de2000_max", SHOWN(PERCEPTION, 1, "CIEDE2000, largest", ""),
     .find = de2000_find},
    {COLOR, MEASURE_PIXELMATCH_PIXELS, .key = "pixelmatch_pixels",
     SHOWN(PERCEPTION, 1, "pixels that pixelmatch reports", ""),
     JUDGED_BEYOND(PIXELMATCH_PPM, PIXELS, "pixels that pixelmatch reports at threshold",
                   PIXELMATCH, 6, "")},
    {DEPTH, MEASURE_BEYOND_PIXELS,
     JUDGED_BEYOND(DEPTH_PPM, JUDGED_PIXELS, "pixels off by more than", DEPTH_MAX_MM, 4, " mm")},
    {DEPTH, MEASURE_MEDIAN, .key = "median_abs_mm", SHOWN(SIZES, 0, "median difference", "mm")},
    {DEPTH, MEASURE_P99, .key = "p99_abs_mm", SHOWN(SIZES, 0, "99th percentile", "mm"),
     JUDGED(DEPTH_P99_MM, "99th percentile of differences", "mm", WORST, NULL)},
    {DEPTH, MEASURE_MAX, .key = "max_abs_mm", SHOWN(SIZES, 0, "largest difference", "mm")},
    {DEPTH, MEASURE_P99_PART, .key = "p99_part",
     JUDGED(DEPTH_P99_PART, "99th percentile of differences", "of the depth", WORST, NULL)},
    {NORMAL, MEASURE_BEYOND_PIXELS,
     JUDGED_BEYOND(NORMAL_PPM, JUDGED_PIXELS, "pixels off by more than", NORMAL_MAX_DEG, 4,
                   " deg")},
    {NORMAL, MEASURE_MEDIAN, .key = "median_deg", SHOWN(SIZES, 0, "median difference", "deg"),
     JUDGED(NORMAL_MEDIAN_DEG, "median of differences", "deg", WORST, NULL)},
    {NORMAL, MEASURE_P99, .key = "p99_deg", SHOWN(SIZES, 0, "99th percentile", "deg")},
    {NORMAL, MEASURE_MAX, .key = "max_deg", SHOWN(SIZES, 0, "largest difference", "deg")},
    {GEOMETRY, MEASURE_NAN_PIXELS, SHOWN(SIZES, 0, "values that are not a number", ""),
     JUDGED(NAN, "values that are not a number", "pixels", NAN, first_is)},
    {IDS, MEASURE_DIFFERING_PIXELS, .key = "mismatches",
     SHOWN(SIZES, 0, "pixels with different ids", "")},
    {IDS, MEASURE_MISMATCH_FRACTION, .key = "mismatch_fraction"},
    {IDS, MEASURE_EDGE_MISMATCH_PERCENT, SHOWN(SIZES, 0, "edge pixels with different ids", "%")},
    {IDS, MEASURE_BEYOND_PIXELS,
     JUDGED_PPM(ID_PPM, JUDGED_PIXELS, "pixels with different ids", WORST, first_is)},
    {IDS, MEASURE_INTERIOR_BEYOND,
     JUDGED_PPM(ID_INTERIOR_PPM, INTERIOR_PIXELS, "interior pixels with different ids", WORST,
                first_is)},
    {IDS, MEASURE_BAND_BEYOND,
     JUDGED_PPM(ID_BAND_PPM, BAND_PIXELS, "edge pixels with different ids", WORST, first_is)},
    {IDS, .part = PART_CLASSES, .key = "classes", SHOWN(CLASSES, 0, "", "")},
};
const size_t n_measures = sizeof measures / sizeof *measures;

bool measure_is_for(const Measure *measure, const CompareResult *result)
{
    const bool fits[] = {[WHEN_ALWAYS] = true,
                         [WHEN_IDS] = result->has_ids,
                         [WHEN_NO_IDS] = !result->has_ids,
                         [WHEN_MASK] = result->has_mask};
    return measure->planes & 1u << result->kind && fits[measure->when];
}

const char *measure_heading(PlaneKind kind, MeasureTable table)
{
    static const char *const of_color[MEASURE_TABLES] = {
        [TABLE_SIZES] = "Color: sizes of differences",
        [TABLE_SIGNS] = "Color: direction of the difference (B - A)",
        [TABLE_OUTLINES] = "Color: outlines and coverage",
        [TABLE_CLASSES] = "Pixels by the cause of their difference",
        [TABLE_PERCEPTION] = "Color: perceptual measures (reported, not judged)"};
    static const char *const of_others[PLANE_KINDS] = {
        [PLANE_DEPTH] = "Depth", [PLANE_NORMAL] = "Normals", [PLANE_ID] = "Segments"};
    return table == TABLE_CLASSES || kind == PLANE_COLOR ? of_color[table] : of_others[kind];
}
