/* Writes the files about a comparison: page, report folder, JUnit XML, ledger and pictures. */
#include "job/verify/compare_parts.h"

#include "options/output.h"
#include "options/templates.h"
#include <math.h>
#include <stdlib.h>

/* Appends the content of a file about a comparison. `name` is that of the compared picture. */
typedef void PutText(const Comparison *comparison, const char *name, Text *out);

/* Writes what `put` appends to a file; nothing if `path` is NULL. */
static Status write_text(const char *path, PutText *put, const Comparison *comparison,
                         const char *name, Err *err)
{
    Text text = TEXT_INIT;
    if (!path)
        return STATUS_OK;
    put(comparison, name, &text);
    Status status = file_write_text(path, &text, err);
    text_release(&text);
    return status;
}

static void put_junit(const Comparison *comparison, const char *name, Text *out)
{
    if (comparison->kind == COMPARED_SUITES)
        suite_junit(&comparison->suite, name, comparison->seconds, out);
    else
        compare_junit(&comparison->result, name, comparison->seconds, out);
}

static void put_ledger(const Comparison *comparison, const char *name, Text *out)
{
    (void)name;
    ledger_csv(&comparison->ledger, out);
}

/* ---- page and report ------------------------------------------------------------------------- */

static ReportSide side_of(const Comparison *comparison, int i)
{
    const ComparedSide *side = &comparison->sides[i];
    return (ReportSide){
        .name = side->name,
        .key = i ? "b" : "a",
        .version = "",
        .seconds = (double)NAN,
        .shown = {.picture = side_shown(side), .ids = side->ids.ids ? &side->ids : NULL}};
}

/* Writes the page alone, or the folder that `report` merges with others, or both. */
static Status write_page(const CompareOptions *options, const Parsed *parsed,
                         const Comparison *comparison, Err *err)
{
    const ComparedSide *sides = comparison->sides;
    char *folder = NULL, *line = NULL;
    Text title = TEXT_INIT;
    Status status;
    const char *names[] = {file_name(sides[0].name), file_name(sides[1].name)};
    const bool is_told = strcmp(names[0], names[1]) != 0;
    text_printf(&title, "%s and %s", is_told ? names[0] : sides[0].name,
                is_told ? names[1] : sides[1].name);
    TRY_GOTO(text_check(&title, err));
    TRY_GOTO(command_line_text(parsed, &line, err));
    TRY_GOTO(templates_path("report", &folder, err));
    const char *const commands[] = {line};
    const ReportCase report = {.name = text_chars(&title),
                               .model = "",
                               .a = side_of(comparison, 0),
                               .b = side_of(comparison, 1),
                               .commands = commands,
                               .n_commands = 1,
                               .planes = {[PLANE_COLOR] = &comparison->result}};
    if (options->page)
        TRY_GOTO(report_write_page(&report, folder, options->page, err));
    if (options->report)
        TRY_GOTO(file_make_folder(options->report, err));
    if (options->report)
        status = report_write(&report, folder, options->report, err);
done:
    text_release(&title);
    free(line);
    free(folder);
    return status;
}

/* ---- pictures -------------------------------------------------------------------------------- */

/* Writes the picture that `make` makes of A and B; nothing if `path` is NULL. */
static Status write_picture(Status (*make)(Picture *, const Picture *, const Picture *, Err *),
                            const char *path, const Picture *a, const Picture *b, Err *err)
{
    Picture picture;
    if (!path)
        return STATUS_OK;
    TRY(make(&picture, a, b, err));
    Status status = picture_write(&picture, path, ENCODING_SRGB, NULL, NULL, err);
    picture_release(&picture);
    return status;
}

static Status write_flicker(const char *path, const Picture *a, const Picture *b, Err *err)
{
    Text png = TEXT_INIT;
    Status status = STATUS_OK;
    if (!path)
        return STATUS_OK;
    TRY_GOTO(flicker_png(a, b, &png, err));
    status = file_write_text(path, &png, err);
done:
    text_release(&png);
    return status;
}

static Status write_pair(const CompareOptions *options, const Parsed *parsed,
                         const Comparison *comparison, Err *err)
{
    const Picture *a = side_shown(&comparison->sides[0]), *b = side_shown(&comparison->sides[1]);
    char *name = NULL;
    Status status;
    if (options->page || options->report)
        TRY(write_page(options, parsed, comparison, err));
    TRY(write_text(options->ledger, put_ledger, comparison, NULL, err));
    TRY(write_picture(heat_picture, options->heat, a, b, err));
    TRY(write_picture(difference_picture, options->difference, a, b, err));
    TRY(write_flicker(options->flicker, a, b, err));
    TRY(shown_name(comparison->sides[0].name, &name, err));
    status = write_text(options->junit, put_junit, comparison, name, err);
    free(name);
    return status;
}

/* Writes the page of a suite, or the folder with page, JSON and JUnit XML, or both. */
static Status write_suite(const CompareOptions *options, const Parsed *parsed,
                          const Comparison *comparison, Err *err)
{
    char *templates = NULL, *paths[3] = {NULL, NULL, NULL};
    static const char *const names[3] = {"report.html", "report.json", "junit.xml"};
    const Suite *suite = &comparison->suite;
    Status status;
    TRY(write_text(options->junit, put_junit, comparison, parsed->operands[0], err));
    TRY_GOTO(templates_path("report", &templates, err));
    if (options->page)
        TRY_GOTO(suite_write_page(suite, &comparison->folders, templates, options->page, err));
    if (!options->report)
        goto done;
    TRY_GOTO(file_make_folder(options->report, err));
    for (int i = 0; i < 3; i++)
        TRY_GOTO(file_join(options->report, names[i], &paths[i], err));
    TRY_GOTO(suite_write_page(suite, &comparison->folders, templates, paths[0], err));
    TRY_GOTO(json_write(suite_json(suite), paths[1], err));
    status = write_text(paths[2], put_junit, comparison, parsed->operands[0], err);
done:
    for (int i = 0; i < 3; i++)
        free(paths[i]);
    free(templates);
    return status;
}

Status compare_write(const CompareOptions *options, const Parsed *parsed,
                     const Comparison *comparison, Err *err)
{
    if (comparison->kind == COMPARED_PAIR)
        return write_pair(options, parsed, comparison, err);
    if (comparison->kind == COMPARED_SUITES)
        return write_suite(options, parsed, comparison, err);
    if (comparison->distances.values)
        return compare_write_distances(options->heat, comparison, err);
    return STATUS_OK;
}
