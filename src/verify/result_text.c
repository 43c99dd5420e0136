/* A comparison in words: for people at a terminal, and as JUnit XML for build servers. */
#include "verify/report.h"
#include "verify/result.h"

#include <math.h>

/* A measure, unless it has no meaning here. */
static void put_measure(Text *out, const char *name, double value, const char *unit)
{
    if (!isnan(value))
        text_printf(out, "  %-42s %.6g%s%s\n", name, value, *unit ? " " : "", unit);
}

static void put_rules(const CompareResult *result, Text *out)
{
    for (int i = 0; i < result->n_rules; i++) {
        const Rule *rule = &result->rules[i];
        text_printf(out, "  %-6s %-52s %.6g of %.6g %s\n", rule->met ? "met" : "broken", rule->name,
                    rule->measured, rule->allowed, rule->unit);
    }
}

static void put_classes(const CompareResult *result, Text *out)
{
    for (PixelClass i = 0; i < PIXEL_CLASSES; i++)
        if (result->classes[i])
            text_printf(out, "  pixels, %-34s %zu\n", pixel_class_name(i), result->classes[i]);
}

static void put_segments(const CompareResult *result, Text *out)
{
    for (int i = 0; i < result->n_worst_segments; i++) {
        const LedgerEntry *entry = &result->worst_segments[i];
        text_printf(out,
                    "  segment %u: %zu pixels differ, mean %+.4g levels, outline %+.4g px, gain "
                    "%.6g; (%d, %d) to (%d, %d)\n",
                    entry->id, entry->differing, ledger_entry_levels(entry), entry->moved_px,
                    entry->gain, entry->left, entry->top, entry->right, entry->bottom);
    }
}

static void put_color(const CompareResult *result, Text *out)
{
    put_measure(out, "largest difference", result->max_abs, "levels");
    put_measure(out, "largest difference off the edges", result->interior_max_abs, "levels");
    put_measure(out, "mean difference", result->mean_abs, "levels");
    put_measure(out, "signed mean difference, worst channel", result->bias_levels, "levels");
    put_measure(out, "brighter pixels over darker ones", result->sign_sigma, "sigma");
    put_measure(out, "root mean square", result->rmse, "levels");
    put_measure(out,
                result->has_ids ? "outline of what is seen, outwards"
                                : "outline of what is not background",
                result->silhouette_px, "px");
    put_measure(out, "gain", result->gain, "");
    put_measure(out, "offset", result->offset_levels, "levels");
    put_measure(out, "mean of the segment that is off most", result->segment_levels, "levels");
    put_measure(out, "outline of the segment that is off most", result->segment_px, "px");
    put_classes(result, out);
    put_segments(result, out);
    put_measure(out, "PSNR (reported)", result->psnr_db, "dB");
    put_measure(out, "SSIM of luma (reported)", result->ssim, "");
    put_measure(out, "FLIP, mean (reported)", result->flip_mean, "");
    put_measure(out, "FLIP, largest (reported)", result->flip_max, "");
    put_measure(out, "HDR-FLIP, mean (reported)", result->hdr_flip_mean, "");
    put_measure(out, "CIEDE2000, mean (reported)", result->de2000_mean, "");
    put_measure(out, "CIEDE2000, largest (reported)", result->de2000_max, "");
    put_measure(out, "pixels that pixelmatch finds", result->pixelmatch_pixels, "");
}

void compare_text(const CompareResult *result, Text *out)
{
    if (result->agrees)
        text_printf(out, "agree (tier %s): %zu of %zu pixels differ\n", result->tolerance.tier,
                    result->differing_pixels, result->pixels);
    else
        text_printf(out, "differ (tier %s): %s%s%s\n", result->tolerance.tier, result->reason,
                    *result->cause ? "; " : "", result->cause);
    put_rules(result, out);
    switch (result->kind) {
    case PLANE_COLOR:
        put_color(result, out);
        break;
    case PLANE_DEPTH:
    case PLANE_NORMAL: {
        const char *unit = result->kind == PLANE_DEPTH ? "mm" : "deg";
        put_measure(out, "median difference", result->median, unit);
        put_measure(out, "99th percentile", result->p99, unit);
        put_measure(out, "largest difference", result->max, unit);
        break;
    }
    case PLANE_ID:
        put_classes(result, out);
        break;
    case PLANE_KINDS:
        break;
    }
}

static void put_case(const CompareResult *result, const Rule *rule, const char *name,
                     double seconds, Text *out)
{
    char sentence[sizeof result->reason];
    text_puts(out, "    <testcase classname=\"");
    text_escaped(out, name);
    text_printf(out, ".%s\" name=\"", plane_kind_name(result->kind));
    text_escaped(out, rule->name);
    text_printf(out,
                "\" time=\"%.6f\">\n      <properties>\n"
                "        <property name=\"tier\" value=\"%s\"/>\n"
                "        <property name=\"measured\" value=\"%.9g\"/>\n"
                "        <property name=\"allowed\" value=\"%.9g\"/>\n"
                "        <property name=\"unit\" value=\"%s\"/>\n"
                "      </properties>\n",
                seconds, result->tolerance.tier, rule->measured, rule->allowed, rule->unit);
    if (!rule->met) {
        rule_sentence(result, rule, sentence, sizeof sentence);
        text_puts(out, "      <failure message=\"");
        text_escaped(out, sentence);
        text_puts(out, "\"/>\n");
    }
    text_puts(out, "    </testcase>\n");
}

void compare_junit(const CompareResult *result, const char *name, double seconds, Text *out)
{
    int failures = 0;
    for (int i = 0; i < result->n_rules; i++)
        failures += !result->rules[i].met;
    text_puts(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
                   "  <testsuite name=\"");
    text_escaped(out, name);
    text_printf(out, "\" tests=\"%d\" failures=\"%d\" errors=\"0\" skipped=\"0\" time=\"%.6f\">\n",
                result->n_rules, failures, seconds);
    for (int i = 0; i < result->n_rules; i++)
        put_case(result, &result->rules[i], name, seconds / result->n_rules, out);
    text_puts(out, "  </testsuite>\n</testsuites>\n");
}
