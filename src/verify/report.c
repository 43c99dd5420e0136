/* The report for programs: JSON and JUnit XML. The page for people is in report_page.c. */
#include "verify/report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
    return json_pack("{s:s, s:s, s:f}", "name", side->name, "version", side->version, "seconds",
                     side->seconds);
}

json_t *report_json(const ReportCase *report)
{
    const char *reason = report_reason(report);
    json_t *planes = json_object(), *commands = json_array();
    for (PlaneKind kind = 0; kind < PLANE_KINDS; kind++)
        if (report->planes[kind])
            json_object_set_new(planes, plane_kind_name(kind), compare_json(report->planes[kind]));
    for (size_t i = 0; i < report->n_commands; i++)
        json_array_append_new(commands, json_string(report->commands[i]));
    return json_pack(
        "{s:s, s:f, s:s?, s:s, s:s, s:s, s:o, s:o*, s:o*, s:o, s:o, s:o}", "verdict",
        reason ? "differ" : "agree", "severity", report_severity(report), "reason", reason, "name",
        report->name, "model", report->model, "tier", report->planes[PLANE_COLOR]->tolerance.tier,
        "planes", planes, "surface", report->surface ? surface_check_json(report->surface) : NULL,
        "settled", report->settled ? settled_json(report->settled) : NULL, report->a.key,
        side_json(&report->a), report->b.key, side_json(&report->b), "commands", commands);
}

void text_escaped(Text *out, const char *text)
{
    for (; *text; text++) {
        static const struct {
            char plain;
            const char *entity;
        } entities[] = {
            {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
        const char *entity = NULL;
        for (size_t i = 0; i < sizeof entities / sizeof *entities; i++)
            if (*text == entities[i].plain)
                entity = entities[i].entity;
        if (entity)
            text_puts(out, entity);
        else if ((unsigned char)*text >= ' ' || *text == '\n' || *text == '\t')
            text_append(out, text, 1);
    }
}

static void junit_case(const ReportCase *report, const CompareResult *plane, Text *out)
{
    text_puts(out, "    <testcase classname=\"");
    text_escaped(out, report->model);
    text_printf(out, "\" name=\"%s\">\n      <properties>\n", plane_kind_name(plane->kind));
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
        text_escaped(out, where.chars ? where.chars : "");
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
    int tests = (report->surface != NULL) + (report->settled != NULL);
    int failures = (report->surface && !report->surface->agrees) +
                   (report->settled && !report->settled->agrees);
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
    if (report->surface)
        junit_surface(report, out);
    text_puts(out, "  </testsuite>\n</testsuites>\n");
}

/* Writes `size` bytes to folder/name. */
static Status write_named(const char *folder, const char *name, const char *bytes, size_t size,
                          Err *err)
{
    char *path;
    TRY(file_join(folder, name, &path, err));
    Status status = file_write(path, bytes, size, err);
    free(path);
    return status;
}

static Status write_json(const ReportCase *report, const char *folder, Err *err)
{
    json_t *json = report_json(report);
    char *text = json_dumps(json, JSON_INDENT(2) | JSON_REAL_PRECISION(12));
    json_decref(json);
    if (!text)
        return err_set(err, STATUS_MEMORY,
                       "report.json cannot be made: memory ran out, or a name in it is not UTF-8");
    size_t length = strlen(text);
    text[length] = '\n'; /* in the place of the final zero */
    Status status = write_named(folder, "report.json", text, length + 1, err);
    free(text);
    return status;
}

static Status write_junit(const ReportCase *report, const char *folder, Err *err)
{
    Text xml = TEXT_INIT;
    report_junit(report, &xml);
    Status status = text_check(&xml, err);
    if (status == STATUS_OK)
        status = write_named(folder, "junit.xml", xml.chars, xml.length, err);
    text_release(&xml);
    return status;
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
