/* The rows of a case's two tables. */
#include "verify/report.h"
#include "verify/result.h"

#include <math.h>
#include <string.h>

void report_number(Text *out, double value, const char *unit)
{
    bool whole = (value == floor(value) && fabs(value) < 1e15) || fabs(value) >= 1000;
    size_t length = strlen(unit);
    if (isinf(value))
        text_puts(out, "∞");
    else if (whole)
        text_printf(out, "%.0f", value);
    else
        text_printf(out, "%.*g", fabs(value - 1) < 0.0005 ? 6 : 3, value); /* nearly 1 is not 1 */
    if (length == 0)
        return;
    if (value == 1 && unit[length - 1] == 's')
        length--;
    text_puts(out, " ");
    text_append(out, unit, length);
}

void report_rule_rows(const CompareResult *plane, Text *out)
{
    for (int i = 0; i < plane->n_rules; i++) {
        const Rule *rule = &plane->rules[i];
        text_printf(out, "<tr><th>%s</th>", i == 0 ? result_title(plane) : "");
        text_printf(out, "<td class=\"verdict %s\">%s</td><td>", rule->met ? "good" : "bad",
                    rule->met ? "✓ agree" : "✗ differ");
        text_escaped(out, rule->name);
        text_puts(out, "</td><td class=\"number\">");
        report_number(out, rule->measured, rule->unit);
        text_puts(out, "</td><td class=\"number\">");
        report_number(out, rule->allowed, rule->unit);
        text_puts(out, "</td></tr>\n");
    }
    if (plane->n_rules == 0)
        text_printf(out,
                    "<tr><th>%s</th><td class=\"verdict quiet\">not judged</td><td>the tolerance "
                    "sets no limit</td><td></td><td></td></tr>\n",
                    result_title(plane));
}

/* A row of a table of measurements; rows of what could not be measured are left out. */
static void metric_row(Text *out, const char *name, double value, const char *unit)
{
    if (isnan(value))
        return;
    text_printf(out, "<tr><td>%s</td><td class=\"number\">", name);
    report_number(out, value, unit);
    text_puts(out, "</td></tr>\n");
}

static void begin_table(Text *out, const char *caption)
{
    text_printf(out, "<table><caption>%s</caption><tbody>\n", caption);
}

static void end_table(Text *out)
{
    text_puts(out, "</tbody></table>\n");
}

static void coverage_metrics(const CompareResult *plane, Text *out)
{
    if (!plane->has_mask)
        return;
    metric_row(out, "pixels seen in both", (double)plane->common_pixels, "");
    metric_row(out, "missing pixels (seen in A only)", (double)plane->missing_pixels, "");
    metric_row(out, "extra pixels (seen in B only)", (double)plane->extra_pixels, "");
}

static void color_metrics(const CompareResult *plane, Text *out)
{
    begin_table(out, "Colour: sizes of differences");
    metric_row(out, "differing pixels", (double)plane->differing_pixels, "");
    metric_row(out, "largest", plane->max_abs, "levels");
    metric_row(out, "largest off the edges", plane->interior_max_abs, "levels");
    metric_row(out, "mean", plane->mean_abs, "levels");
    metric_row(out, "root mean square", plane->rmse, "levels");
    metric_row(out, "PSNR", plane->psnr_db, "dB");
    end_table(out);
    begin_table(out, "Colour: which way B is off");
    metric_row(out, "signed mean, worst channel", plane->bias_levels, "levels");
    metric_row(out, "brighter pixels over darker ones", plane->sign_sigma, "σ");
    metric_row(out, "gain", plane->gain, "");
    metric_row(out, "offset", plane->offset_levels, "levels");
    metric_row(out, "mean of the segment that is off most", plane->segment_levels, "levels");
    end_table(out);
    begin_table(out, "Colour: outlines and coverage");
    metric_row(out,
               plane->has_ids ? "outline of what is seen, outwards"
                              : "outline of what is not background, outwards",
               plane->silhouette_px, "px");
    metric_row(out, "outline of the segment that is off most", plane->segment_px, "px");
    coverage_metrics(plane, out);
    end_table(out);
    begin_table(out, "Colour: pixels by the cause of their difference");
    for (PixelClass i = 0; i < PIXEL_CLASSES; i++)
        if (plane->classes[i])
            metric_row(out, i == PIXEL_WRONG_SEGMENT ? "wrong segment" : pixel_class_name(i),
                       (double)plane->classes[i], "");
    end_table(out);
    begin_table(out, "Colour: as people see it (reported, never judged)");
    metric_row(out, "SSIM of luma", plane->ssim, "");
    metric_row(out, "FLIP, mean", plane->flip_mean, "");
    metric_row(out, "FLIP, largest", plane->flip_max, "");
    metric_row(out, "CIEDE2000, mean", plane->de2000_mean, "");
    metric_row(out, "CIEDE2000, largest", plane->de2000_max, "");
    end_table(out);
}

static void geometry_metrics(const CompareResult *plane, Text *out)
{
    const char *unit = plane->kind == PLANE_DEPTH ? "mm" : "deg";
    begin_table(out, plane->kind == PLANE_DEPTH ? "Depth" : "Normals");
    metric_row(out, "median difference", plane->median, unit);
    metric_row(out, "99th percentile", plane->p99, unit);
    metric_row(out, "largest difference", plane->max, unit);
    metric_row(out, "values that are not a number",
               (double)(plane->nan_pixels_a + plane->nan_pixels_b), "");
    coverage_metrics(plane, out);
    end_table(out);
}

void report_metric_tables(const CompareResult *plane, Text *out)
{
    switch (plane->kind) {
    case PLANE_COLOR:
        color_metrics(plane, out);
        break;
    case PLANE_DEPTH:
    case PLANE_NORMAL:
        geometry_metrics(plane, out);
        break;
    case PLANE_ID:
        begin_table(out, "Segments");
        metric_row(out, "pixels with different ids", (double)plane->differing_pixels, "");
        metric_row(out, "of the pixels at edges", 100 * plane->edge_mismatch_fraction, "%");
        coverage_metrics(plane, out);
        end_table(out);
        break;
    case PLANE_KINDS:
        break;
    }
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
    begin_table(metrics, "Surface, as POV-Ray's root finder sees it");
    metric_row(metrics, "pixels judged", (double)surface->common, "");
    metric_row(metrics, "grazing pixels", (double)surface->grazing, "");
    metric_row(metrics, "median distance from the surface", surface->median_mm, "mm");
    metric_row(metrics, "99th percentile", surface->p99_mm, "mm");
    metric_row(metrics, "largest distance", surface->max_mm, "mm");
    metric_row(metrics, "largest over what is allowed", surface->max_ratio, "");
    end_table(metrics);
}

void report_exact_rows(const CompareResult *exact, Text *rules, Text *metrics)
{
    report_rule_rows(exact, rules);
    begin_table(metrics, "Colours of the surface where it is");
    metric_row(metrics, "differing pixels", (double)exact->differing_pixels, "");
    metric_row(metrics, "largest difference", exact->max_abs, "levels");
    metric_row(metrics, "largest off the edges", exact->interior_max_abs, "levels");
    metric_row(metrics, "signed mean, worst channel", exact->bias_levels, "levels");
    metric_row(metrics, "gain", exact->gain, "");
    metric_row(metrics, "offset", exact->offset_levels, "levels");
    metric_row(metrics, "mean of the segment that is off most", exact->segment_levels, "levels");
    end_table(metrics);
}

void report_settled_rows(const ReportCase *report, Text *rules, Text *metrics)
{
    const Settled *settled = report->settled;
    for (SettledCause cause = settled->from; cause <= settled->to; cause++) {
        size_t allowed = settled_allowed(settled, cause);
        bool met = settled->count[cause] <= allowed;
        text_printf(rules,
                    "<tr><th>%s</th><td class=\"verdict %s\">%s</td><td>%s; %s is right there</td>"
                    "<td class=\"number\">",
                    cause == settled->from ? "settled" : "", met ? "good" : "bad",
                    met ? "✓ agree" : "✗ differ", settled_cause_sentence(cause), report->b.name);
        report_number(rules, (double)settled->count[cause], "pixels");
        text_puts(rules, "</td><td class=\"number\">");
        report_number(rules, (double)allowed, "pixels");
        text_puts(rules, "</td></tr>\n");
    }
    if (settled->n_first > 0)
        begin_table(metrics, "Settled pixels, the first of them");
    for (int i = 0; i < settled->n_first; i++) {
        text_puts(metrics, "<tr><td>");
        settled_describe(&settled->first[i], report->a.name, report->b.name, metrics);
        text_printf(metrics, "</td><td>%s</td></tr>\n",
                    settled_cause_name(settled->first[i].cause));
    }
    if (settled->n_first > 0)
        end_table(metrics);
}
