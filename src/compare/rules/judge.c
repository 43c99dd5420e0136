/* Rules in the order of what they say about a picture: values that are no numbers, things missing
 * or extra, wrong segments, then sizes of differences. The first broken one gives the reason. */
#include "compare/measures/result.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What a rule measures, and the pixel to look at when it is broken. */
typedef struct Finding {
    const char *unit;
    double measured;
    PixelPlace at;
    const char *at_what;
} Finding;

static void add_rule(CompareResult *result, Finding finding, double allowed, const char *name)
{
    if (isinf(allowed) || isnan(finding.measured))
        return;
    assert(result->n_rules < RULES_MAX);
    Rule *rule = &result->rules[result->n_rules++];
    *rule = (Rule){.unit = finding.unit,
                   .measured = finding.measured,
                   .allowed = allowed,
                   .met = !(finding.measured > allowed),
                   .at = finding.at};
    snprintf(rule->name, sizeof rule->name, "%s", name);
    snprintf(rule->at_what, sizeof rule->at_what, "%s", finding.at_what);
}

static double ppm(size_t count, size_t of)
{
    return of ? 1e6 * (double)count / (double)of : 0;
}

static void add_count_rule(CompareResult *result, Finding finding, size_t allowed, const char *name)
{
    if (allowed != SIZE_MAX)
        add_rule(result, finding, (double)allowed, name);
}

static void add_coverage_rules(CompareResult *result)
{
    if (!result->has_mask)
        return;
    const Tolerance *tolerance = &result->tolerance;
    Finding region = {"pixels", (double)result->largest_region, result->largest_region_at,
                      "it starts"};
    Finding coverage = {"ppm", ppm(result->missing_pixels + result->extra_pixels, result->pixels),
                        result->largest_region_at, "the largest region starts"};
    Finding missing = {"segments", (double)result->segments_missing, result->segment_missing_at,
                       "the first is"};
    Finding silhouette = {"px", fabs(result->silhouette_px), result->largest_region_at,
                          "the largest region starts"};
    add_count_rule(result, region, tolerance->region_pixels, "largest missing or extra region");
    if (result->kind == PLANE_DEPTH || result->kind == PLANE_NORMAL)
        add_rule(result, coverage, tolerance->coverage_ppm, "pixels seen in only one image");
    if (result->kind != PLANE_COLOR)
        return;
    if (result->has_ids)
        add_count_rule(result, missing, tolerance->segments_missing,
                       "segments seen in only one image");
    add_rule(result, silhouette, tolerance->silhouette_px,
             result->has_ids ? "shift of the outline of what is seen"
                             : "shift of the outline of what is not background");
}

/* What is left of a distance when it is as near as two of its standard errors let it be. */
static double beyond_error(double distance, double error)
{
    return fmax(0, fabs(distance) - 2 * error);
}

/* Faults of one segment, and of all colours alike, that limits of single pixels let pass. */
static void add_segment_rules(CompareResult *result)
{
    if (!result->has_ids)
        return;
    const Tolerance *tolerance = &result->tolerance;
    Finding levels = {"levels", result->segment_levels, result->segment_levels_at, "its middle is"};
    Finding moved = {"px", result->segment_px, result->segment_px_at, "its middle is"};
    Finding gain = {"", beyond_error(result->gain - 1, result->gain_error), result->worst,
                    "the worst pixel is"};
    Finding offset = {"levels", beyond_error(result->offset_levels, result->offset_error),
                      result->worst, "the worst pixel is"};
    add_rule(result, moved, tolerance->segment_px, "shift of the outline of a segment");
    add_rule(result, levels, tolerance->segment_levels, "mean difference of a segment");
    add_rule(result, gain, tolerance->gain, "distance of the gain from 1");
    add_rule(result, offset, tolerance->offset_levels, "distance of the offset from 0");
}

/* Limit of the pixels that are off, in ppm: the tolerance's, or one pixel where the only one that
 * is off may be spared. */
static double allowed_beyond_ppm(const CompareResult *result)
{
    const Tolerance *tolerance = &result->tolerance;
    bool spares = result->beyond_pixels <= 1 && result->judged_pixels >= SPARE_OF &&
                  result->unsettled_max_abs <= tolerance->spare_levels;
    return spares ? fmax(tolerance->color_ppm, ppm(1, result->judged_pixels))
                  : tolerance->color_ppm;
}

static void add_color_rules(CompareResult *result)
{
    const Tolerance *tolerance = &result->tolerance;
    char name[sizeof result->rules->name], worst[sizeof result->rules->at_what];
    size_t interior = result->pixels - result->band_pixels;
    double levels = result->bits == 8 ? floor(tolerance->color_levels) : tolerance->color_levels;
    Finding beyond = {"ppm", ppm(result->beyond_pixels, result->judged_pixels), result->worst,
                      worst};
    Finding inside = {"ppm", ppm(result->interior_beyond, interior), result->worst, worst};
    Finding furthest = {"levels", result->interior_max_abs, result->worst, worst};
    Finding band = {"ppm", ppm(result->band_beyond, result->band_pixels), result->worst, worst};
    Finding bias = {"levels", fabs(result->bias_levels), result->worst, worst};
    Finding signs = {"sigma", fabs(result->sign_sigma), result->worst, worst};
    Finding matched = {"ppm", 1e6 * result->pixelmatch_pixels / (double)result->pixels,
                       result->worst, worst};
    snprintf(worst, sizeof worst, "the worst, %.4g levels, is", result->max_abs);
    snprintf(name, sizeof name, "pixels off by more than %.3g levels", levels);
    add_rule(result, beyond, allowed_beyond_ppm(result), name);
    if (result->has_mask) {
        add_rule(result, furthest, tolerance->interior_levels, "largest difference off the edges");
        snprintf(name, sizeof name, "pixels off the edges, off by more than %.3g levels", levels);
        add_rule(result, inside, tolerance->interior_ppm, name);
        snprintf(name, sizeof name, "pixels at edges, off by more than %.3g levels", levels);
        add_rule(result, band, tolerance->band_ppm, name);
    }
    add_segment_rules(result);
    add_rule(result, bias, tolerance->bias_levels, "mean difference");
    add_rule(result, signs, tolerance->sign_sigma, "excess of brighter or of darker pixels");
    if (!isnan(result->pixelmatch_pixels)) {
        snprintf(name, sizeof name, "pixels that pixelmatch finds at %g", tolerance->pixelmatch);
        add_rule(result, matched, tolerance->pixelmatch_ppm, name);
    }
}

static void add_geometry_rules(CompareResult *result)
{
    const Tolerance *tolerance = &result->tolerance;
    char name[sizeof result->rules->name], worst[sizeof result->rules->at_what];
    bool depth = result->kind == PLANE_DEPTH;
    const char *unit = depth ? "mm" : "deg";
    Finding beyond = {"ppm", ppm(result->beyond_pixels, result->judged_pixels), result->worst,
                      worst};
    Finding p99 = {unit, result->p99, result->worst, worst};
    Finding part = {"of the depth", result->p99_part, result->worst, worst};
    Finding median = {unit, result->median, result->worst, worst};
    snprintf(worst, sizeof worst, "the worst, %.4g %s, is", result->max, unit);
    snprintf(name, sizeof name, "pixels off by more than %.4g %s",
             depth ? tolerance->depth_max_mm : tolerance->normal_max_deg, unit);
    add_rule(result, beyond, depth ? tolerance->depth_ppm : tolerance->normal_ppm, name);
    if (depth) {
        add_rule(result, p99, tolerance->depth_p99_mm, "99th percentile of differences");
        add_rule(result, part, tolerance->depth_p99_part, "99th percentile of differences");
    } else {
        add_rule(result, median, tolerance->normal_median_deg, "median of differences");
    }
}

static void add_id_rules(CompareResult *result)
{
    const Tolerance *tolerance = &result->tolerance;
    size_t interior = result->pixels - result->band_pixels;
    Finding all = {"ppm", ppm(result->beyond_pixels, result->judged_pixels), result->worst,
                   "the first is"};
    Finding inside = {"ppm", ppm(result->interior_beyond, interior), result->worst, "the first is"};
    Finding band = {"ppm", ppm(result->band_beyond, result->band_pixels), result->worst,
                    "the first is"};
    add_rule(result, all, tolerance->id_ppm, "pixels with different ids");
    add_rule(result, inside, tolerance->id_interior_ppm, "pixels off the edges, with other ids");
    add_rule(result, band, tolerance->id_band_ppm, "pixels at edges, with other ids");
}

/* "segment 17" or "nothing" */
static const char *describe_id(uint32_t id, char out[24])
{
    if (id)
        snprintf(out, 24, "segment %u", id);
    else
        snprintf(out, 24, "nothing");
    return out;
}

/* "at (312, 140), segment 17 in A and nothing in B" */
static void describe_place(const CompareResult *result, const PixelPlace *place, char *out,
                           size_t size)
{
    char a[24], b[24];
    describe_id(place->id_a, a);
    describe_id(place->id_b, b);
    if (!result->has_ids)
        snprintf(out, size, "at (%d, %d)", place->x, place->y);
    else if (place->id_a != place->id_b)
        snprintf(out, size, "at (%d, %d), %s in A and %s in B", place->x, place->y, a, b);
    else
        snprintf(out, size, "at (%d, %d), %s", place->x, place->y,
                 place->id_a ? a : "the background");
}

/* To three digits, as people read it, or to as many as tell it from what is allowed. */
static void describe_measured(const Rule *rule, char *out, size_t size)
{
    double value = rule->measured;
    bool whole = (value == floor(value) || fabs(value) >= 1000) && fabs(value) < 1e15;
    snprintf(out, size, whole ? "%.0f" : "%.3g", value);
    if (strtod(out, NULL) <= rule->allowed)
        snprintf(out, size, "%.6g", value);
}

void rule_sentence(const CompareResult *result, const Rule *rule, char *out, size_t size)
{
    char place[120], measured[32];
    describe_measured(rule, measured, sizeof measured);
    int length = snprintf(out, size, "%s: %s: %s%s%s, at most %.6g allowed", result_title(result),
                          rule->name, measured, *rule->unit ? " " : "", rule->unit, rule->allowed);
    if (rule->at.x < 0)
        return;
    describe_place(result, &rule->at, place, sizeof place);
    snprintf(out + length, size - (size_t)length, "; %s %s", rule->at_what, place);
}

static void judge(CompareResult *result)
{
    Finding nan = {"pixels", (double)(result->nan_pixels_a + result->nan_pixels_b), result->nan_at,
                   "the first is"};
    if (result->kind == PLANE_DEPTH || result->kind == PLANE_NORMAL)
        add_rule(result, nan, 0, "values that are not a number");
    else if (result->kind == PLANE_COLOR && result->bits == 32)
        add_rule(result, nan, 0, "colours that are not finite");
    add_coverage_rules(result);
    if (result->kind == PLANE_COLOR)
        add_color_rules(result);
    else if (result->kind == PLANE_ID)
        add_id_rules(result);
    else
        add_geometry_rules(result);
    result->agrees = true;
    for (int i = 0; i < result->n_rules && result->agrees; i++) {
        if (result->rules[i].met)
            continue;
        result->agrees = false;
        rule_sentence(result, &result->rules[i], result->reason, sizeof result->reason);
    }
}

static void name_ids(PixelPlace *place, const IdPlane *a, const IdPlane *b)
{
    if (!a || place->x < 0)
        return;
    size_t pixel = (size_t)place->y * (size_t)a->width + (size_t)place->x;
    place->id_a = a->ids[pixel];
    place->id_b = b->ids[pixel];
}

void result_finish(CompareResult *result, const IdPlane *a, const IdPlane *b)
{
    name_ids(&result->worst, a, b);
    name_ids(&result->largest_region_at, a, b);
    name_ids(&result->nan_at, a, b);
    judge(result);
}
