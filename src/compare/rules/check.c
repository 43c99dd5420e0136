/* Each kind of check lists its rules and measures once, here; text, JUnit XML and page only print
 * the lists. A measure that is NAN has no meaning for the images compared, and is left out. */
#include "compare/rules/check.h"

#include "compare/measures/result.h"
#include <assert.h>
#include <math.h>
#include <stdio.h>

static void add(Check *check, const char *table, const char *name, double value, const char *unit)
{
    if (isnan(value))
        return;
    assert(check->n_measures < MEASURES_MAX);
    check->measures[check->n_measures++] =
        (Measure){.table = table, .name = name, .value = value, .unit = unit};
}

static void add_coverage(Check *check, const char *table, const CompareResult *plane)
{
    if (!plane->has_mask)
        return;
    add(check, table, "pixels seen in both", (double)plane->common_pixels, "");
    add(check, table, "missing pixels (seen in A only)", (double)plane->missing_pixels, "");
    add(check, table, "extra pixels (seen in B only)", (double)plane->extra_pixels, "");
}

static void add_classes(Check *check, const CompareResult *plane)
{
    const char *table = "Pixels by the cause of their difference";
    for (PixelClass i = 0; i < PIXEL_CLASSES; i++)
        if (plane->classes[i])
            add(check, table, i == PIXEL_WRONG_SEGMENT ? "wrong segment" : pixel_class_name(i),
                (double)plane->classes[i], "");
}

/* What the colours of a picture and of an isosurface where it is have in common. */
static void add_color_differences(Check *check, const char *sizes, const char *signs,
                                  const CompareResult *plane)
{
    add(check, sizes, "differing pixels", (double)plane->differing_pixels, "");
    add(check, sizes, "largest difference", plane->max_abs, "levels");
    add(check, sizes, "largest difference off the edges", plane->interior_max_abs, "levels");
    add(check, sizes, "mean difference", plane->mean_abs, "levels");
    add(check, sizes, "root mean square", plane->rmse, "levels");
    add(check, sizes, "PSNR", plane->psnr_db, "dB");
    add(check, signs, "signed mean, worst channel", plane->bias_levels, "levels");
    add(check, signs, "brighter pixels over darker ones", plane->sign_sigma, "sigma");
    add(check, signs, "gain", plane->gain, "");
    add(check, signs, "offset", plane->offset_levels, "levels");
    add(check, signs, "mean of the segment that differs most", plane->segment_levels, "levels");
}

static void add_color(Check *check, const CompareResult *plane)
{
    const char *outlines = "Colour: outlines and coverage";
    const char *perception = "Colour: as people see it (reported, never judged)";
    add_color_differences(check, "Colour: sizes of differences", "Colour: which way B is off",
                          plane);
    add(check, outlines,
        plane->has_ids ? "outline of what is seen, outwards"
                       : "outline of what is not background, outwards",
        plane->silhouette_px, "px");
    add(check, outlines, "outline of the segment that moved most", plane->segment_px, "px");
    add_coverage(check, outlines, plane);
    add_classes(check, plane);
    add(check, perception, "SSIM of luma", plane->ssim, "");
    add(check, perception, "FLIP, mean", plane->flip_mean, "");
    add(check, perception, "FLIP, largest", plane->flip_max, "");
    add(check, perception, "HDR-FLIP, mean", plane->hdr_flip_mean, "");
    add(check, perception, "CIEDE2000, mean", plane->de2000_mean, "");
    add(check, perception, "CIEDE2000, largest", plane->de2000_max, "");
    add(check, perception, "pixels that pixelmatch finds", plane->pixelmatch_pixels, "");
}

static void add_geometry(Check *check, const CompareResult *plane)
{
    bool depth = plane->kind == PLANE_DEPTH;
    const char *table = depth ? "Depth" : "Normals", *unit = depth ? "mm" : "deg";
    add(check, table, "median difference", plane->median, unit);
    add(check, table, "99th percentile", plane->p99, unit);
    add(check, table, "largest difference", plane->max, unit);
    add(check, table, "values that are not a number",
        (double)(plane->nan_pixels_a + plane->nan_pixels_b), "");
    add_coverage(check, table, plane);
}

static void add_ids(Check *check, const CompareResult *plane)
{
    const char *table = "Segments";
    add(check, table, "pixels with different ids", (double)plane->differing_pixels, "");
    add(check, table, "of the pixels at edges", 100 * plane->edge_mismatch_fraction, "%");
    add_coverage(check, table, plane);
    add_classes(check, plane);
}

static Check start_plane(const CompareResult *plane)
{
    Check check = {.title = result_title(plane),
                   .agrees = plane->agrees,
                   .reason = plane->reason,
                   .n_rules = plane->n_rules};
    for (int i = 0; i < plane->n_rules; i++)
        check.rules[i] = plane->rules[i];
    return check;
}

Check check_plane(const CompareResult *plane)
{
    static void (*const adders[PLANE_KINDS])(Check *, const CompareResult *) = {
        [PLANE_COLOR] = add_color,
        [PLANE_DEPTH] = add_geometry,
        [PLANE_NORMAL] = add_geometry,
        [PLANE_ID] = add_ids};
    Check check = start_plane(plane);
    adders[plane->kind](&check, plane);
    return check;
}

/* The check of a second pair of pictures: its rules, and the sizes of its differences. */
static Check check_pictures(const CompareResult *pictures, const char *table)
{
    Check check = start_plane(pictures);
    add_color_differences(&check, table, table, pictures);
    return check;
}

static void add_pixel_rule(Check *check, const char *name, size_t measured, size_t allowed)
{
    Rule *rule = &check->rules[check->n_rules++];
    *rule = (Rule){.unit = "pixels",
                   .measured = (double)measured,
                   .allowed = (double)allowed,
                   .met = measured <= allowed,
                   .at = {.x = -1, .y = -1}};
    snprintf(rule->name, sizeof rule->name, "%s", name);
}

static Check check_surface(const SurfaceCheck *surface)
{
    const char *table = "Surface, as POV-Ray's root finder sees it";
    Check check = {.title = "surface", .agrees = surface->agrees, .reason = surface->reason};
    add_pixel_rule(&check, "missing or extra pixels, grazing ones aside",
                   surface->missing + surface->extra, 0);
    add_pixel_rule(&check, "pixels farther off than the accuracy allows", surface->beyond, 0);
    add(&check, table, "pixels judged", (double)surface->common, "");
    add(&check, table, "grazing pixels", (double)surface->grazing, "");
    add(&check, table, "median distance from the surface", surface->median_mm, "mm");
    add(&check, table, "99th percentile", surface->p99_mm, "mm");
    add(&check, table, "largest distance", surface->max_mm, "mm");
    add(&check, table, "largest distance over what is allowed", surface->max_ratio, "");
    return check;
}

static Check check_settled(const Settled *settled)
{
    Check check = {.title = "settled",
                   .agrees = settled->agrees,
                   .reason = settled->reason,
                   .settled = settled};
    for (SettledCause cause = settled->from; cause <= settled->to; cause++)
        add_pixel_rule(&check, settled_cause_sentence(cause), settled->count[cause],
                       settled_allowed(settled, cause));
    return check;
}

/* Of the two sides the rules of their own checks are stricter. */
static Check check_pair(const Witness *witness, WitnessPair pair)
{
    const CompareResult *planes[] = {witness->pairs[pair].ids, witness->pairs[pair].depth};
    Check check = {.title = witness->pairs[pair].title,
                   .agrees = witness->pairs[pair].agrees,
                   .reason = witness->sentence};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < planes[i]->n_rules; k++)
            check.rules[check.n_rules++] = planes[i]->rules[k];
    add(&check, check.title, "pixels with different ids", (double)planes[0]->differing_pixels, "");
    add(&check, check.title, "largest difference of depths", planes[1]->max, "mm");
    add_coverage(&check, check.title, planes[1]);
    return check;
}

int report_checks(const ReportCase *report, Check checks[CHECKS_MAX])
{
    int n = 0;
    for (PlaneKind kind = 0; kind < PLANE_KINDS; kind++)
        if (report->planes[kind])
            checks[n++] = check_plane(report->planes[kind]);
    if (report->alpha)
        checks[n++] = check_pictures(report->alpha, "Alpha");
    if (report->settled)
        checks[n++] = check_settled(report->settled);
    if (report->exact)
        checks[n++] = check_pictures(report->exact, "Colours of the surface where it is");
    if (report->surface)
        checks[n++] = check_surface(report->surface);
    for (int pair = 0; report->witness && pair < WITNESS_PAIRS; pair++)
        checks[n++] = check_pair(report->witness, (WitnessPair)pair);
    return n;
}

const char *report_reason(const ReportCase *report)
{
    Check checks[CHECKS_MAX];
    int n = report_checks(report, checks);
    for (int i = 0; i < n; i++)
        if (!checks[i].agrees)
            return checks[i].reason;
    return NULL;
}

bool report_agrees(const ReportCase *report)
{
    return report_reason(report) == NULL;
}

double report_severity(const ReportCase *report)
{
    Check checks[CHECKS_MAX];
    int n = report_checks(report, checks);
    double worst = 0;
    for (int i = 0; i < n; i++)
        for (int k = 0; k < checks[i].n_rules; k++) {
            const Rule *rule = &checks[i].rules[k];
            double ratio = rule->allowed > 0 ? rule->measured / rule->allowed : rule->measured;
            if (!rule->met)
                worst = fmax(worst, fmin(fmax(ratio, 1), 1e12));
        }
    return worst;
}
