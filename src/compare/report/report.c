/* Writes the files of a report into a folder: report.json, junit.xml (junit.c), the heat map
 * diff.png, and the page for people, report.html (report_page.c). */
#include "compare/report/check.h"
#include "compare/report/page.h"
#include "compare/report/pictures.h"

#include <stdlib.h>

static json_t *side_json(const ReportSide *side)
{
    json_t *json = json_pack("{s:o, s:o, s:o}", "name", json_text(side->name), "version",
                             json_text(side->version), "seconds", json_number(side->seconds));
    return side->tiles ? json_with(json, "tiles", json_count(side->tiles)) : json;
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
    json_t *json = JSON_OBJECT(
        {"verdict", json_text(reason ? "differ" : "agree")},
        {"severity", json_number(report_severity(report))}, {"reason", json_text_or_null(reason)},
        {"name", json_text(report->name)}, {"model", json_text(report->model)},
        {"tier", json_text(report->planes[PLANE_COLOR]->tolerance.tier)}, {"planes", planes},
        {report->a.key, side_json(&report->a)}, {report->b.key, side_json(&report->b)},
        {"commands", commands});
    if (report->surface)
        json = json_with(json, "surface", surface_check_json(report->surface));
    if (report->alpha)
        json = json_with(json, "alpha", compare_json(report->alpha));
    if (report->exact)
        json = json_with(json, "exact", compare_json(report->exact));
    if (report->witness)
        json = json_with(json, "witness", witness_json(report->witness));
    return report->settled ? json_with(json, "settled", settled_json(report->settled)) : json;
}

/* Writes `text` to folder/name. */
static Status write_named(const char *folder, const char *name, const Text *text, Err *err)
{
    char *path = NULL;
    TRY(file_join(folder, name, &path, err));
    Status status = file_write_text(path, text, err);
    free(path);
    return status;
}

Status report_write_page(const ReportCase *report, const char *templates, const char *path,
                         Err *err)
{
    Picture heat;
    TRY(heat_picture(&heat, report->a.shown.picture, report->b.shown.picture, err));
    Status status = report_page(report, &heat, templates, path, err);
    picture_release(&heat);
    return status;
}

Status report_write(const ReportCase *report, const char *templates, const char *folder, Err *err)
{
    Picture heat = {0};
    Text json = TEXT_INIT, xml = TEXT_INIT;
    char *diff = NULL, *page = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(heat_picture(&heat, report->a.shown.picture, report->b.shown.picture, err));
    TRY_GOTO(file_join(folder, "diff.png", &diff, err));
    TRY_GOTO(picture_write(&heat, diff, ENCODING_SRGB, NULL, NULL, err));
    text_json(&json, report_json(report), 2);
    text_puts(&json, "\n");
    TRY_GOTO(write_named(folder, "report.json", &json, err));
    report_junit(report, &xml);
    TRY_GOTO(write_named(folder, "junit.xml", &xml, err));
    TRY_GOTO(file_join(folder, "report.html", &page, err));
    status = report_page(report, &heat, templates, page, err);
done:
    free(diff);
    free(page);
    text_release(&json);
    text_release(&xml);
    picture_release(&heat);
    return status;
}
