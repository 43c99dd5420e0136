/* Rules in the order of what they say about a picture: values that are no numbers, things missing
 * or extra, wrong segments, then sizes of differences. The first broken one gives the reason. */
#include "verify/labels.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

Tolerance tolerance_identity(double depth_step_mm)
{
    return (Tolerance){.tier = "A",
                       .color_levels = 0,
                       .color_ppm = 5,
                       .id_ppm = 5,
                       .depth_max_mm = depth_step_mm,
                       .depth_ppm = 5,
                       .depth_p99_mm = (double)INFINITY,
                       .normal_max_deg = 0.03,
                       .normal_ppm = 5,
                       .coverage_ppm = 5,
                       .region_pixels = SIZE_MAX};
}

Tolerance tolerance_surface(void)
{
    return (Tolerance){.tier = "surface",
                       .color_levels = 2,
                       .color_ppm = 5000,
                       .color_common_only = true,
                       .id_ppm = (double)INFINITY,
                       .depth_max_mm = (double)INFINITY,
                       .depth_ppm = (double)INFINITY,
                       .depth_p99_mm = 0.01,
                       .normal_max_deg = (double)INFINITY,
                       .normal_ppm = (double)INFINITY,
                       .coverage_ppm = (double)INFINITY,
                       .region_pixels = 2};
}

/* What a rule measures, and the pixel to look at when it is broken. */
typedef struct Finding {
    const char *unit;
    double measured;
    PixelPlace at;
    const char *at_what;
} Finding;

static void add_rule(CompareResult *result, Finding finding, double allowed, const char *name)
{
    if (isinf(allowed))
        return;
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

static void add_coverage_rules(CompareResult *result)
{
    if (!result->has_mask)
        return;
    Finding region = {"pixels", (double)result->largest_region, result->largest_region_at,
                      "it starts"};
    if (result->tolerance.region_pixels != SIZE_MAX)
        add_rule(result, region, (double)result->tolerance.region_pixels,
                 "largest missing or extra region");
    Finding coverage = {"ppm", ppm(result->missing_pixels + result->extra_pixels, result->pixels),
                        result->largest_region_at, "the largest region starts"};
    if (result->kind == PLANE_DEPTH || result->kind == PLANE_NORMAL)
        add_rule(result, coverage, result->tolerance.coverage_ppm, "pixels seen in only one image");
}

static void add_difference_rules(CompareResult *result)
{
    const Tolerance *tolerance = &result->tolerance;
    char name[sizeof result->rules->name], worst[sizeof result->rules->at_what];
    Finding beyond = {"ppm", ppm(result->beyond_pixels, result->judged_pixels), result->worst,
                      worst};
    Finding p99 = {"mm", result->p99, result->worst, worst};
    switch (result->kind) {
    case PLANE_COLOR:
        snprintf(name, sizeof name, "pixels off by more than %g levels", tolerance->color_levels);
        snprintf(worst, sizeof worst, "the worst, %.4g levels, is", result->max_abs);
        add_rule(result, beyond, tolerance->color_ppm, name);
        break;
    case PLANE_DEPTH:
        snprintf(name, sizeof name, "pixels off by more than %.4g mm", tolerance->depth_max_mm);
        snprintf(worst, sizeof worst, "the worst, %.4g mm, is", result->max);
        add_rule(result, beyond, tolerance->depth_ppm, name);
        add_rule(result, p99, tolerance->depth_p99_mm, "99th percentile of differences");
        break;
    case PLANE_NORMAL:
        snprintf(name, sizeof name, "pixels off by more than %g deg", tolerance->normal_max_deg);
        snprintf(worst, sizeof worst, "the worst, %.4g deg, is", result->max);
        add_rule(result, beyond, tolerance->normal_ppm, name);
        break;
    case PLANE_ID:
        snprintf(worst, sizeof worst, "the first is");
        add_rule(result, beyond, tolerance->id_ppm, "pixels with different ids");
        break;
    case PLANE_KINDS:
        break;
    }
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

static void explain(CompareResult *result, const Rule *rule)
{
    char place[120];
    describe_place(result, &rule->at, place, sizeof place);
    snprintf(result->reason, sizeof result->reason, "%s: %s: %.6g %s, at most %.6g allowed; %s %s",
             plane_kind_name(result->kind), rule->name, rule->measured, rule->unit, rule->allowed,
             rule->at_what, place);
}

void compare_judge(CompareResult *result)
{
    Finding nan = {"pixels", (double)(result->nan_pixels_a + result->nan_pixels_b), result->nan_at,
                   "the first is"};
    if (result->kind == PLANE_DEPTH || result->kind == PLANE_NORMAL)
        add_rule(result, nan, 0, "values that are not a number");
    add_coverage_rules(result);
    add_difference_rules(result);
    result->agrees = true;
    for (int i = 0; i < result->n_rules && result->agrees; i++) {
        if (result->rules[i].met)
            continue;
        result->agrees = false;
        explain(result, &result->rules[i]);
    }
}
