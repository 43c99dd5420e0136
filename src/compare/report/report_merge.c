/* Merges the report pages of several cases into one page, the worst case first. Each page has its
 * table row and its section between marks, and report.json has the verdict, so nothing is drawn or
 * measured again. */
#include "compare/report/page.h"
#include "tmpl/tmpl.h"

#include <stdlib.h>
#include <string.h>

/* A part of a page; not zero-terminated. */
typedef struct PagePart {
    const char *start; /* borrowed */
    size_t size;
} PagePart;

typedef struct MergedCase {
    const char *folder;    /* borrowed */
    char *page;            /* owned */
    PagePart row, section; /* of page */
    double severity;       /* 0: agrees */
    size_t number;         /* in the order given, from 1 */
} MergedCase;

/* A page contains its pictures, so it may be large; report.json contains numbers only. */
static const FileForm page_file = {.name = "a report", .most_bytes = 4e9, .is_text = true};
static const FileForm json_file = {.name = "JSON", .most_bytes = 1e9, .is_text = true};

static Status read_json(json_t **out, const char *path, Err *err)
{
    char *text;
    size_t size;
    json_error_t error;
    TRY(file_read(path, &json_file, &text, &size, err));
    bool no_memory;
    json_t *json = json_read(text, size, 0, &error, &no_memory);
    free(text);
    if (no_memory)
        return mem_out_of("to read", path, err);
    if (!json)
        return err_set(err, STATUS_INPUT, "%s:%d: is not valid JSON: %s", path, error.line,
                       error.text);
    *out = json;
    return STATUS_OK;
}

/* Finds the part of a page between two marks. */
static Status find_part(const char *page, const char *path, const char *const marks_of[2],
                        PagePart *part, Err *err)
{
    const char *from = strstr(page, marks_of[0]);
    const char *to = from ? strstr(from, marks_of[1]) : NULL;
    if (!to)
        return err_set(err, STATUS_INPUT, "%s: is not a report written by this version of corcast",
                       path);
    part->start = from + strlen(marks_of[0]);
    part->size = (size_t)(to - part->start);
    return STATUS_OK;
}

static Status read_case(MergedCase *merged, const char *folder, Err *err)
{
    static const char *const row_marks[] = {REPORT_ROW_BEGIN, REPORT_ROW_END};
    static const char *const case_marks[] = {REPORT_CASE_BEGIN, REPORT_CASE_END};
    char *page = NULL, *numbers = NULL;
    json_t *json = NULL;
    size_t size;
    Status status = STATUS_OK;
    TRY_GOTO(file_join(folder, "report.html", &page, err));
    TRY_GOTO(file_join(folder, "report.json", &numbers, err));
    TRY_GOTO(file_read(page, &page_file, &merged->page, &size, err));
    TRY_GOTO(find_part(merged->page, page, row_marks, &merged->row, err));
    TRY_GOTO(find_part(merged->page, page, case_marks, &merged->section, err));
    TRY_GOTO(read_json(&json, numbers, err));
    json_t *severity = json_object_get(json, "severity");
    if (!json_is_number(severity))
        status = err_set(err, STATUS_INPUT, "%s: has no number \"severity\"", numbers);
    else
        merged->severity = json_number_value(severity);
done:
    json_decref(json);
    free(page);
    free(numbers);
    return status;
}

static int worst_first(const void *left, const void *right)
{
    const MergedCase *a = left, *b = right;
    if (a->severity != b->severity)
        return a->severity < b->severity ? 1 : -1;
    return (a->number > b->number) - (a->number < b->number);
}

/* The marks in a part for the name of its case, a link to it, and its folder. */
enum { MARK_CASE, MARK_LINK, MARK_FOLDER, MARKS };
static const char *const marks[MARKS] = {[MARK_CASE] = "\"" REPORT_FIRST_CASE "\"",
                                         [MARK_LINK] = "\"#" REPORT_FIRST_CASE "\"",
                                         [MARK_FOLDER] = REPORT_FOLDER};

/* Appends the replacement of a mark: the name of the case by its number, or its folder. */
static void append_mark(Text *out, int mark, size_t number, const char *folder)
{
    if (mark != MARK_FOLDER) {
        text_printf(out, "\"%scase-%zu\"", mark == MARK_LINK ? "#" : "", number);
    } else if (folder) {
        text_puts(out, " in ");
        text_escaped(out, folder);
    }
}

void report_put_part(Text *out, const char *part, size_t size, size_t number, const char *folder)
{
    while (size > 0) {
        const char *first = NULL;
        int mark = 0;
        for (int k = 0; k < MARKS; k++) {
            const char *found = memmem(part, size, marks[k], strlen(marks[k]));
            if (found && (!first || found < first)) {
                first = found;
                mark = k;
            }
        }
        size_t before = first ? (size_t)(first - part) : size;
        text_append(out, part, before);
        if (!first)
            return;
        append_mark(out, mark, number, folder);
        size_t skip = before + strlen(marks[mark]);
        part += skip;
        size -= skip;
    }
}

/* --------------------------------------------------------------------------------------- power */

/* A string of an object, "" where there is none. Borrowed. */
static const char *text_of(json_t *row, const char *key)
{
    const char *text = json_string_value(json_object_get(row, key));
    return text ? text : "";
}

/* Returns the sign for whether a rule detected a fault; "" if the rule was not applied. */
static const char *mark(json_t *row, const char *rule)
{
    json_t *value = json_object_get(row, rule);
    return !value ? "" : json_is_true(value) ? "✓" : "–";
}

static Status put_fault(json_t *row, const char *templates, Text *out, Err *err)
{
    static const char *const rules[] = {"A", "B", "pixelmatch", "flip", "psnr", "blender", "ssim"};
    Markup parts = {0};
    text_puts(markup_text(&parts, "fault"), text_of(row, "fault"));
    text_puts(markup_text(&parts, "model"), text_of(row, "model"));
    for (size_t k = 0; k < sizeof rules / sizeof *rules; k++)
        text_puts(markup_text(&parts, rules[k]), mark(row, rules[k]));
    return markup_put(&parts, templates, "power_fault.html", out, err);
}

static Status put_limit(json_t *row, const char *templates, Text *out, Err *err)
{
    static const char *const texts[] = {"parameter", "model", "unit"};
    static const char *const limits[] = {"A", "B", "pixelmatch", "blender"};
    Markup parts = {0};
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++)
        text_puts(markup_text(&parts, texts[k]), text_of(row, texts[k]));
    for (size_t k = 0; k < sizeof limits / sizeof *limits; k++) {
        json_t *limit = json_object_get(row, limits[k]);
        if (json_is_number(limit))
            text_printf(markup_text(&parts, limits[k]), "%.2g", json_number_value(limit));
        else
            text_puts(markup_text(&parts, limits[k]), "never");
    }
    return markup_put(&parts, templates, "power_limit.html", out, err);
}

static Status put_rows(json_t *rows, Status (*put)(json_t *, const char *, Text *, Err *),
                       const char *templates, Text *out, Err *err)
{
    json_t *row;
    size_t i;
    json_array_foreach(rows, i, row)
    {
        TRY(put(row, templates, out, err));
    }
    return STATUS_OK;
}

/* Appends the tables of the faults that `make power` planted: which rules detected them, and the
 * smallest fault that each rule detects. */
static Status put_power(const char *path, const char *templates, Text *out, Err *err)
{
    json_t *json = NULL;
    Markup parts = {0};
    Status status = STATUS_OK;
    TRY(read_json(&json, path, err));
    text_printf(markup_text(&parts, "alarms"), "%zu",
                json_array_size(json_object_get(json, "alarms")));
    text_printf(markup_text(&parts, "scenes"), "%lld",
                json_integer_value(json_object_get(json, "clean_scenes")) +
                    json_integer_value(json_object_get(json, "povray_scenes")));
    TRY_GOTO(put_rows(json_object_get(json, "faults"), put_fault, templates,
                      markup_raw(&parts, "faults"), err));
    TRY_GOTO(put_rows(json_object_get(json, "limits"), put_limit, templates,
                      markup_raw(&parts, "limits"), err));
    status = markup_put(&parts, templates, "power.html", out, err);
done:
    markup_release(&parts);
    json_decref(json);
    return status;
}

/* ---------------------------------------------------------------------------------------- page */

static Status write_page(const MergedCase *cases, size_t n, const Text *power,
                         const char *templates, const char *path, Err *err)
{
    Text rows = TEXT_INIT, sections = TEXT_INIT, heading = TEXT_INIT;
    size_t differing = 0;
    for (size_t i = 0; i < n; i++) {
        const MergedCase *one = &cases[i];
        report_put_part(&rows, one->row.start, one->row.size, one->number, one->folder);
        report_put_part(&sections, one->section.start, one->section.size, one->number, one->folder);
        differing += cases[i].severity > 0;
    }
    if (differing)
        text_printf(&heading, "%zu of %zu cases", differing, n);
    else
        text_printf(&heading, "All %zu cases", n);
    const ReportFrame frame = {.title =
                                   differing ? "corcast: cases differ" : "corcast: all cases agree",
                               .heading = text_chars(&heading),
                               .sentence = "Each case compares picture B with its reference A.",
                               .rows = &rows,
                               .cases = &sections,
                               .power = power,
                               .others = &TEXT_INIT,
                               .n_cases = n,
                               .agrees = differing == 0};
    Status status = report_write_frame(&frame, templates, path, err);
    text_release(&rows);
    text_release(&sections);
    text_release(&heading);
    return status;
}

Status report_merge(const ReportMerge *merge, const char *path, bool *all_agree, Err *err)
{
    MergedCase *cases;
    Text of_power = TEXT_INIT;
    bool agree = true;
    Status status = STATUS_OK;
    TRY(mem_calloc(&cases, merge->n, sizeof *cases, "cases", err));
    for (size_t i = 0; i < merge->n; i++) {
        cases[i].folder = merge->folders[i];
        cases[i].number = i + 1;
        TRY_GOTO(read_case(&cases[i], merge->folders[i], err));
        agree = agree && cases[i].severity == 0;
    }
    if (merge->power)
        TRY_GOTO(put_power(merge->power, merge->templates, &of_power, err));
    qsort(cases, merge->n, sizeof *cases, worst_first);
    TRY_GOTO(write_page(cases, merge->n, &of_power, merge->templates, path, err));
    *all_agree = agree;
done:
    for (size_t i = 0; i < merge->n; i++)
        free(cases[i].page);
    free(cases);
    text_release(&of_power);
    return status;
}
