/* Writes the tables of a case on a report's page: a row per rule, and per check a foldable list of
 * its measures with a table per heading. The line that is always visible shows the first measures.
 * Lists of checks that differ are unfolded. */
#include "compare/report/check.h"
#include "compare/report/page.h"
#include "tmpl/tmpl.h"

#include <math.h>
#include <string.h>

/* Readers compare three digits at most; counts are exact. */
void text_rounded(Text *out, double value, const char *unit)
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

enum { FIRST_MEASURES = 3 }; /* measures in the line that is always visible */

static Status put_rule(const Check *check, int index, const char *templates, Text *out, Err *err)
{
    const Rule *rule = &check->rules[index];
    Markup parts = {0};
    text_puts(markup_text(&parts, "title"), index == 0 ? check->title : "");
    text_puts(markup_text(&parts, "class"), rule->met ? "good" : "bad");
    text_puts(markup_text(&parts, "verdict"), rule->met ? "✓ agree" : "✗ differ");
    text_puts(markup_text(&parts, "rule"), rule->name);
    text_rounded(markup_text(&parts, "measured"), rule->measured, rule->unit);
    text_rounded(markup_text(&parts, "allowed"), rule->allowed, rule->unit);
    return markup_put(&parts, templates, "rule.html", out, err);
}

static Status put_unjudged(const Check *check, const char *templates, Text *out, Err *err)
{
    Markup parts = {0};
    text_puts(markup_text(&parts, "title"), check->title);
    return markup_put(&parts, templates, "unjudged.html", out, err);
}

/* Puts the rows into a table with a caption, and empties them. */
static Status put_table(const char *caption, Text *rows, const char *templates, Text *out, Err *err)
{
    Markup parts = {0};
    text_puts(markup_text(&parts, "caption"), caption);
    text_add(markup_raw(&parts, "rows"), rows);
    text_clear(rows);
    return markup_put(&parts, templates, "measures.html", out, err);
}

/* Appends the measures of a check, one table per heading. */
static Status put_measures(const Check *check, const char *templates, Text *out, Err *err)
{
    Text rows = TEXT_INIT;
    Status status = STATUS_OK;
    for (int i = 0; i < check->n_measures; i++) {
        const CheckMeasure *measure = &check->measures[i];
        Markup parts = {0};
        text_puts(markup_text(&parts, "name"), measure->name);
        text_puts(markup_text(&parts, "class"), measure->value == 0 ? "zero" : "");
        text_rounded(markup_text(&parts, "value"), measure->value, measure->unit);
        TRY_GOTO(markup_put(&parts, templates, "measure.html", &rows, err));
        if (i + 1 == check->n_measures || measure[1].table != measure->table)
            TRY_GOTO(put_table(measure->table, &rows, templates, out, err));
    }
done:
    text_release(&rows);
    return status;
}

static Status put_settled(const ReportCase *report, const char *templates, Text *out, Err *err)
{
    const Settled *settled = report->settled;
    Text rows = TEXT_INIT;
    Status status = STATUS_OK;
    for (int i = 0; i < settled->n_first; i++) {
        const SettledPixel *pixel = &settled->first[i];
        Markup parts = {0};
        settled_describe(pixel, report->a.name, report->b.name, markup_text(&parts, "name"));
        text_puts(markup_text(&parts, "value"), settled_cause_name(pixel->cause));
        text_puts(markup_text(&parts, "class"), "");
        TRY_GOTO(markup_put(&parts, templates, "measure.html", &rows, err));
    }
    if (settled->n_first > 0)
        TRY_GOTO(put_table("Settled pixels, the first of them", &rows, templates, out, err));
done:
    text_release(&rows);
    return status;
}

/* Appends everything that was measured for one check. */
static Status put_measured(const ReportCase *report, const Check *check, const char *templates,
                           Text *out, Err *err)
{
    Markup parts = {0};
    Text *first = markup_text(&parts, "first"), *tables = markup_raw(&parts, "tables");
    text_puts(markup_text(&parts, "title"), check->title);
    text_puts(markup_text(&parts, "verdict"), check->agrees ? "✓ agree" : "✗ differ");
    text_puts(markup_text(&parts, "open"), check->agrees ? "" : " open");
    for (int i = 0; i < check->n_measures && i < FIRST_MEASURES; i++) {
        const CheckMeasure *measure = &check->measures[i];
        text_printf(first, "%s%s ", i ? ", " : "", measure->name);
        text_rounded(first, measure->value, measure->unit);
    }
    if (check->settled)
        text_printf(first, "the first %d pixels", report->settled->n_first);
    Status status = STATUS_OK;
    TRY_GOTO(put_measures(check, templates, tables, err));
    if (check->settled)
        TRY_GOTO(put_settled(report, templates, tables, err));
    status = markup_put(&parts, templates, "measured.html", out, err);
done:
    markup_release(&parts);
    return status;
}

Status report_tables(const ReportCase *report, const char *templates, Text *rules, Text *measures,
                     Err *err)
{
    Check checks[CHECKS_MAX];
    int n = report_checks(report, checks);
    for (int i = 0; i < n; i++) {
        if (checks[i].n_rules == 0)
            TRY(put_unjudged(&checks[i], templates, rules, err));
        for (int k = 0; k < checks[i].n_rules; k++)
            TRY(put_rule(&checks[i], k, templates, rules, err));
        if (checks[i].n_measures > 0 || checks[i].settled)
            TRY(put_measured(report, &checks[i], templates, measures, err));
    }
    return STATUS_OK;
}
