/* The tables of a case on the page: a row for each rule, and a table for each heading of the
 * measures. */
#include "tmpl/tmpl.h"
#include "verify/check.h"
#include "verify/report.h"
#include "verify/rounded.h"

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

static Status put_measures(const Check *check, const char *templates, Text *out, Err *err)
{
    Text rows = TEXT_INIT;
    Status status = STATUS_OK;
    for (int i = 0; i < check->n_measures; i++) {
        const Measure *measure = &check->measures[i];
        Markup parts = {0};
        text_puts(markup_text(&parts, "name"), measure->name);
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
        TRY_GOTO(markup_put(&parts, templates, "measure.html", &rows, err));
    }
    if (settled->n_first > 0)
        TRY_GOTO(put_table("Settled pixels, the first of them", &rows, templates, out, err));
done:
    text_release(&rows);
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
        TRY(put_measures(&checks[i], templates, measures, err));
        if (checks[i].settled)
            TRY(put_settled(report, templates, measures, err));
    }
    return STATUS_OK;
}
