/* The report for programs: JSON and JUnit XML. The page for people is in report_page.c. */
#include "verify/report.h"
#include "verify/result.h"

#include <math.h>
#include <stdlib.h>

const CompareResult *report_worst(const ReportCase *report)
{
    for (PlaneKind kind = 0; kind < PLANE_KINDS; kind++)
        if (report->planes[kind] && !report->planes[kind]->agrees)
            return report->planes[kind];
    return NULL;
}

const char *report_reason(const ReportCase *report)
{
    const CompareResult *worst = report_worst(report);
    if (worst)
        return worst->reason;
    if (report->settled && !report->settled->agrees)
        return report->settled->reason;
    if (report->exact && !report->exact->agrees)
        return report->exact->reason;
    return report->surface && !report->surface->agrees ? report->surface->reason : NULL;
}

bool report_agrees(const ReportCase *report)
{
    return report_reason(report) == NULL;
}

double report_severity(const ReportCase *report)
{
    double worst = 0;
    for (PlaneKind kind = 0; kind < PLANE_KINDS; kind++)
        for (int i = 0; report->planes[kind] && i < report->planes[kind]->n_rules; i++) {
            const Rule *rule = &report->planes[kind]->rules[i];
            if (rule->met)
                continue;
            double ratio = rule->allowed > 0 ? rule->measured / rule->allowed : rule->measured;
            worst = fmax(worst, fmin(fmax(ratio, 1), 1e12));
        }
    return report_reason(report) ? fmax(worst, 1) : 0;
}

static json_t *side_json(const ReportSide *side)
{
    return json_pack("{s:o, s:o, s:o}", "name", json_text(side->name), "version",
                     json_text(side->version), "seconds", json_number(side->seconds));
}

json_t *report_json(const ReportCase *report)
{
    const char *reason = report_reason(report);
    json_t *planes = json_object(), *commands = json_array();
    for (PlaneKind kind = 0; kind < PLANE_KINDS; kind++)
        if (report->planes[kind])
            planes = json_with(planes, plane_kind_name(kind), compare_json(report->planes[kind]));
    for (size_t i = 0; i < report->n_commands; i++)
        commands = json_with_item(commands, json_text(report->commands[i]));
    const JsonMember members[] = {
        {"verdict", json_text(reason ? "differ" : "agree")},
        {"severity", json_number(report_severity(report))},
        {"reason", json_text(reason)},
        {"name", json_text(report->name)},
        {"model", json_text(report->model)},
        {"tier", json_text(report->planes[PLANE_COLOR]->tolerance.tier)},
        {"planes", planes},
        {report->a.key, side_json(&report->a)},
        {report->b.key, side_json(&report->b)},
        {"commands", commands},
    };
    json_t *json = json_with_members(json_object(), members, sizeof members / sizeof *members);
    if (report->surface)
        json = json_with(json, "surface", surface_check_json(report->surface));
    if (report->exact)
        json = json_with(json, "exact", compare_json(report->exact));
    return report->settled ? json_with(json, "settled", settled_json(report->settled)) : json;
}

/* NULL for a character that stands for itself. */
static const char *entity_of(char plain)
{
    switch (plain) {
    case '&':
        return "&amp;";
    case '<':
        return "&lt;";
    case '>':
        return "&gt;";
    case '"':
        return "&quot;";
    case '\'':
        return "&#39;";
    default:
        return NULL;
    }
}

void text_escaped(Text *out, const char *text)
{
    if (!text)
        text_puts(out, NULL);
    while (text && *text) {
        size_t length = utf8_length(text);
        const char *entity = entity_of(*text);
        if (entity)
            text_puts(out, entity);
        else if (length == 0)
            text_puts(out, UTF8_REPLACEMENT);
        else if ((unsigned char)*text >= ' ' || *text == '\n' || *text == '\t')
            text_append(out, text, length);
        text += length ? length : 1;
    }
}

static void junit_case(const ReportCase *report, const CompareResult *plane, Text *out)
{
    text_puts(out, "    <testcase classname=\"");
    text_escaped(out, report->model);
    text_printf(out, "\" name=\"%s\">\n      <properties>\n", result_title(plane));
    for (int i = 0; i < plane->n_rules; i++) {
        const Rule *rule = &plane->rules[i];
        text_puts(out, "        <property name=\"");
        text_escaped(out, rule->name);
        text_printf(out, "\" value=\"%.6g %s (at most %.6g)\"/>\n", rule->measured, rule->unit,
                    rule->allowed);
    }
    text_puts(out, "      </properties>\n");
    if (!plane->agrees) {
        text_puts(out, "      <failure message=\"");
        text_escaped(out, plane->reason);
        text_puts(out, "\"/>\n");
    }
    text_puts(out, "    </testcase>\n");
}

static void junit_surface(const ReportCase *report, Text *out)
{
    const SurfaceCheck *surface = report->surface;
    text_puts(out, "    <testcase classname=\"");
    text_escaped(out, report->model);
    text_printf(
        out,
        "\" name=\"surface\">\n      <properties>\n"
        "        <property name=\"missing or extra pixels\" value=\"%zu (at most 0)\"/>\n"
        "        <property name=\"pixels beyond the accuracy\" value=\"%zu (at most 0)\"/>\n"
        "        <property name=\"grazing pixels\" value=\"%zu\"/>\n      </properties>\n",
        surface->missing + surface->extra, surface->beyond, surface->grazing);
    if (!surface->agrees) {
        text_puts(out, "      <failure message=\"");
        text_escaped(out, surface->reason);
        text_puts(out, "\"/>\n");
    }
    text_puts(out, "    </testcase>\n");
}

static void junit_settled(const ReportCase *report, Text *out)
{
    const Settled *settled = report->settled;
    text_puts(out, "    <testcase classname=\"");
    text_escaped(out, report->model);
    text_puts(out, "\" name=\"settled\">\n      <properties>\n");
    for (SettledCause cause = settled->from; cause <= settled->to; cause++) {
        text_puts(out, "        <property name=\"");
        text_escaped(out, settled_cause_sentence(cause));
        text_printf(out, "\" value=\"%zu pixels (at most %zu)\"/>\n", settled->count[cause],
                    settled_allowed(settled, cause));
    }
    for (int i = 0; i < settled->n_first; i++) {
        Text where = TEXT_INIT;
        settled_describe(&settled->first[i], report->a.name, report->b.name, &where);
        text_printf(out, "        <property name=\"%s\" value=\"",
                    settled_cause_name(settled->first[i].cause));
        text_escaped(out, text_chars(&where));
        text_puts(out, "\"/>\n");
        text_release(&where);
    }
    text_puts(out, "      </properties>\n");
    if (!settled->agrees) {
        text_puts(out, "      <failure message=\"");
        text_escaped(out, settled->reason);
        text_puts(out, "\"/>\n");
    }
    text_puts(out, "    </testcase>\n");
}

void report_junit(const ReportCase *report, Text *out)
{
    int tests = (report->surface != NULL) + (report->settled != NULL) + (report->exact != NULL);
    int failures = (report->surface && !report->surface->agrees) +
                   (report->settled && !report->settled->agrees) +
                   (report->exact && !report->exact->agrees);
    for (PlaneKind kind = 0; kind < PLANE_KINDS; kind++) {
        tests += report->planes[kind] != NULL;
        failures += report->planes[kind] && !report->planes[kind]->agrees;
    }
    text_puts(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n");
    text_puts(out, "  <testsuite name=\"");
    text_escaped(out, report->name);
    text_printf(out, "\" tests=\"%d\" failures=\"%d\" errors=\"0\" skipped=\"0\">\n", tests,
                failures);
    for (PlaneKind kind = 0; kind < PLANE_KINDS; kind++)
        if (report->planes[kind])
            junit_case(report, report->planes[kind], out);
    if (report->settled)
        junit_settled(report, out);
    if (report->exact)
        junit_case(report, report->exact, out);
    if (report->surface)
        junit_surface(report, out);
    text_puts(out, "  </testsuite>\n</testsuites>\n");
}

/* Writes `text` to folder/name and releases it. */
static Status write_named(const char *folder, const char *name, Text *text, Err *err)
{
    char *path = NULL;
    Status status = file_join(folder, name, &path, err);
    if (status == STATUS_OK)
        status = file_write_text(path, text, err);
    free(path);
    text_release(text);
    return status;
}

static Status write_json(const ReportCase *report, const char *folder, Err *err)
{
    Text text = TEXT_INIT;
    text_json(&text, report_json(report), 2);
    text_puts(&text, "\n");
    return write_named(folder, "report.json", &text, err);
}

static Status write_junit(const ReportCase *report, const char *folder, Err *err)
{
    Text xml = TEXT_INIT;
    report_junit(report, &xml);
    return write_named(folder, "junit.xml", &xml, err);
}

static Status write_heat(const Picture *heat, const char *folder, Err *err)
{
    char *path;
    TRY(file_join(folder, "diff.png", &path, err));
    Status status = picture_write(heat, path, ENCODING_SRGB, NULL, err);
    free(path);
    return status;
}

Status report_write_page(const ReportCase *report, const char *templates, const char *path,
                         Err *err)
{
    Picture heat;
    TRY(heat_picture(&heat, report->a.picture, report->b.picture, err));
    Status status = report_page(report, &heat, templates, path, err);
    picture_release(&heat);
    return status;
}

Status report_write(const ReportCase *report, const char *templates, const char *folder, Err *err)
{
    Picture heat = {0};
    char *path = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(heat_picture(&heat, report->a.picture, report->b.picture, err));
    TRY_GOTO(write_heat(&heat, folder, err));
    TRY_GOTO(write_json(report, folder, err));
    TRY_GOTO(write_junit(report, folder, err));
    TRY_GOTO(file_join(folder, "report.html", &path, err));
    TRY_GOTO(report_page(report, &heat, templates, path, err));
done:
    free(path);
    picture_release(&heat);
    return status;
}
