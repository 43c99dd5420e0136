/* The rows of a case's two tables. */
#include "verify/report.h"

#include <math.h>
#include <stdio.h>

void report_rule_rows(const CompareResult *plane, Text *out)
{
    for (int i = 0; i < plane->n_rules; i++) {
        const Rule *rule = &plane->rules[i];
        text_printf(out, "<tr><th>%s</th>", i == 0 ? plane_kind_name(plane->kind) : "");
        text_printf(out, "<td class=\"verdict %s\">%s</td><td>", rule->met ? "good" : "bad",
                    rule->met ? "✓ agree" : "✗ differ");
        text_escaped(out, rule->name);
        text_printf(
            out, "</td><td class=\"number\">%.6g %s</td><td class=\"number\">%.6g %s</td></tr>\n",
            rule->measured, rule->unit, rule->allowed, rule->unit);
    }
    if (plane->n_rules == 0)
        text_printf(out,
                    "<tr><th>%s</th><td class=\"verdict quiet\">not judged</td><td>the tolerance "
                    "sets no limit</td><td></td><td></td></tr>\n",
                    plane_kind_name(plane->kind));
}

/* A row of the table of measurements; rows of what could not be measured are left out. */
static void metric_row(Text *out, const char *plane, const char *name, double value,
                       const char *unit)
{
    if (isnan(value))
        return;
    text_printf(out, "<tr><th>%s</th><td>%s</td><td class=\"number\">", plane, name);
    if (isinf(value))
        text_puts(out, "∞");
    else
        text_printf(out, value == floor(value) && fabs(value) < 1e15 ? "%.0f" : "%.6g", value);
    text_printf(out, "%s%s</td></tr>\n", *unit ? " " : "", unit);
}

static void color_metrics(const CompareResult *plane, Text *out)
{
    metric_row(out, "color", "differing pixels", (double)plane->differing_pixels, "");
    metric_row(out, "", "largest difference", plane->max_abs, "levels");
    metric_row(out, "", "largest difference off the edges", plane->interior_max_abs, "levels");
    metric_row(out, "", "mean difference", plane->mean_abs, "levels");
    metric_row(out, "", "signed mean difference, worst channel", plane->bias_levels, "levels");
    metric_row(out, "", "brighter pixels over darker ones", plane->sign_sigma, "σ");
    metric_row(out, "", "root mean square", plane->rmse, "levels");
    metric_row(out, "", "outline of what is seen, outwards", plane->silhouette_px, "px");
    metric_row(out, "", "gain", plane->gain, "");
    metric_row(out, "", "offset", plane->offset_levels, "levels");
    metric_row(out, "", "mean of the segment that is off most", plane->segment_levels, "levels");
    metric_row(out, "", "outline of the segment that is off most", plane->segment_px, "px");
    metric_row(out, "", "PSNR", plane->psnr_db, "dB");
    metric_row(out, "", "SSIM of luma", plane->ssim, "");
    metric_row(out, "", "FLIP, mean", plane->flip_mean, "");
    metric_row(out, "", "FLIP, largest", plane->flip_max, "");
    metric_row(out, "", "CIEDE2000, mean", plane->de2000_mean, "");
    for (PixelClass i = 0; i < PIXEL_IDENTICAL; i++)
        if (plane->classes[i]) {
            char name[48];
            snprintf(name, sizeof name, "pixels: %s", pixel_class_name(i));
            metric_row(out, "", name, (double)plane->classes[i], "");
        }
}

static void coverage_metrics(const CompareResult *plane, Text *out)
{
    if (!plane->has_mask)
        return;
    metric_row(out, "", "missing pixels (seen in A only)", (double)plane->missing_pixels, "");
    metric_row(out, "", "extra pixels (seen in B only)", (double)plane->extra_pixels, "");
    metric_row(out, "", "pixels seen in both", (double)plane->common_pixels, "");
}

void report_metric_rows(const CompareResult *plane, Text *out)
{
    const char *unit = plane->kind == PLANE_DEPTH ? "mm" : "deg";
    const char *name = plane_kind_name(plane->kind);
    switch (plane->kind) {
    case PLANE_COLOR:
        color_metrics(plane, out);
        break;
    case PLANE_DEPTH:
    case PLANE_NORMAL:
        metric_row(out, name, "values that are not a number",
                   (double)(plane->nan_pixels_a + plane->nan_pixels_b), "");
        metric_row(out, "", "median difference", plane->median, unit);
        metric_row(out, "", "99th percentile", plane->p99, unit);
        metric_row(out, "", "largest difference", plane->max, unit);
        break;
    case PLANE_ID:
        metric_row(out, name, "pixels with different ids", (double)plane->differing_pixels, "");
        metric_row(out, "", "of the pixels at edges", 100 * plane->edge_mismatch_fraction, "%");
        break;
    case PLANE_KINDS:
        break;
    }
    coverage_metrics(plane, out);
}

void report_surface_rows(const SurfaceCheck *surface, Text *rules, Text *metrics)
{
    const struct {
        const char *name;
        size_t pixels;
    } rows[] = {{"missing or extra pixels, grazing ones aside", surface->missing + surface->extra},
                {"pixels farther off than the accuracy allows", surface->beyond}};
    for (int i = 0; i < 2; i++)
        text_printf(rules,
                    "<tr><th>%s</th><td class=\"verdict %s\">%s</td><td>%s</td>"
                    "<td class=\"number\">%zu pixels</td><td class=\"number\">0 pixels</td></tr>\n",
                    i ? "" : "surface", rows[i].pixels ? "bad" : "good",
                    rows[i].pixels ? "✗ differ" : "✓ agree", rows[i].name, rows[i].pixels);
    metric_row(metrics, "surface", "grazing pixels", (double)surface->grazing, "");
    metric_row(metrics, "", "pixels judged", (double)surface->common, "");
    metric_row(metrics, "", "median distance from the surface", surface->median_mm, "mm");
    metric_row(metrics, "", "99th percentile", surface->p99_mm, "mm");
    metric_row(metrics, "", "largest distance", surface->max_mm, "mm");
    metric_row(metrics, "", "largest over what is allowed", surface->max_ratio, "");
}

void report_settled_rows(const ReportCase *report, Text *rules, Text *metrics)
{
    const Settled *settled = report->settled;
    for (SettledCause cause = settled->from; cause <= settled->to; cause++) {
        size_t allowed = settled_allowed(settled, cause);
        bool met = settled->count[cause] <= allowed;
        text_printf(
            rules,
            "<tr><th>%s</th><td class=\"verdict %s\">%s</td><td>%s; %s is right there</td>"
            "<td class=\"number\">%zu pixels</td><td class=\"number\">%zu pixels</td></tr>\n",
            cause == settled->from ? "settled" : "", met ? "good" : "bad",
            met ? "✓ agree" : "✗ differ", settled_cause_sentence(cause), report->b.name,
            settled->count[cause], allowed);
    }
    for (int i = 0; i < settled->n_first; i++) {
        Text where = TEXT_INIT;
        settled_describe(&settled->first[i], report->a.name, report->b.name, &where);
        text_printf(metrics, "<tr><th>%s</th><td>%s</td><td>%s</td></tr>\n", i ? "" : "settled",
                    where.chars ? where.chars : "", settled_cause_name(settled->first[i].cause));
        text_release(&where);
    }
}
