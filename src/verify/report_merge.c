/* One page from the pages of several cases: each holds its row of the table and its section between
 * marks, and report.json its verdict, so that nothing is drawn or measured again. */
#include "verify/report.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

typedef struct MergedCase {
    char *page;                /* owned */
    const char *row, *section; /* within page */
    size_t row_size, section_size;
    double severity; /* 0: agrees */
    size_t number;   /* in the order given, from 1 */
} MergedCase;

/* A page holds its pictures. */
static const FileForm page_file = {.name = "a report", .most_bytes = 4e9, .is_text = true};
static const FileForm json_file = {.name = "JSON", .most_bytes = 1e9, .is_text = true};

static Status read_json(json_t **out, const char *path, Err *err)
{
    char *text;
    size_t size;
    json_error_t error;
    TRY(file_read(path, &json_file, &text, &size, err));
    errno = 0;
    json_t *json = json_loadb(text, size, 0, &error);
    bool no_memory = !json && errno == ENOMEM;
    free(text);
    if (no_memory)
        return mem_out_of("to read", path, err);
    if (!json)
        return err_set(err, STATUS_INPUT, "%s:%d: is no JSON: %s", path, error.line, error.text);
    *out = json;
    return STATUS_OK;
}

/* What stands between two marks of a page. */
static Status find_part(const MergedCase *merged, const char *path, const char *begin,
                        const char *end, const char **part, size_t *size, Err *err)
{
    const char *from = strstr(merged->page, begin);
    const char *to = from ? strstr(from, end) : NULL;
    if (!to)
        return err_set(err, STATUS_INPUT, "%s: is not a report of this version of corcast", path);
    *part = from + strlen(begin);
    *size = (size_t)(to - *part);
    return STATUS_OK;
}

static Status read_case(MergedCase *merged, const char *folder, Err *err)
{
    char *page = NULL, *numbers = NULL;
    json_t *json = NULL;
    size_t size;
    Status status = STATUS_OK;
    TRY_GOTO(file_join(folder, "report.html", &page, err));
    TRY_GOTO(file_join(folder, "report.json", &numbers, err));
    TRY_GOTO(file_read(page, &page_file, &merged->page, &size, err));
    TRY_GOTO(find_part(merged, page, REPORT_ROW_BEGIN, REPORT_ROW_END, &merged->row,
                       &merged->row_size, err));
    TRY_GOTO(find_part(merged, page, REPORT_CASE_BEGIN, REPORT_CASE_END, &merged->section,
                       &merged->section_size, err));
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

/* Appends a part, with the number of its case in place of 1. */
static void append_numbered(Text *out, const char *part, size_t size, size_t number)
{
    const size_t length = strlen(REPORT_FIRST_CASE);
    while (size > 0) {
        const char *found = memmem(part, size, "\"" REPORT_FIRST_CASE "\"", length + 2);
        const char *link = memmem(part, size, "\"#" REPORT_FIRST_CASE "\"", length + 3);
        if (!found || (link && link < found))
            found = link;
        size_t before = found ? (size_t)(found - part) : size;
        text_append(out, part, before);
        if (!found)
            return;
        size_t skip = length + (found == link ? 3 : 2);
        text_printf(out, found == link ? "\"#case-%zu\"" : "\"case-%zu\"", number);
        part = found + skip;
        size -= before + skip;
    }
}

/* ------------------------------------------------------------------------------------------
 * power */

/* A string of an object, "" where there is none. Borrowed. */
static const char *text_of(json_t *row, const char *key)
{
    const char *text = json_string_value(json_object_get(row, key));
    return text ? text : "";
}

static const char *mark(json_t *row, const char *rule)
{
    json_t *value = json_object_get(row, rule);
    return !value ? "" : json_is_true(value) ? "✓" : "–";
}

static void put_faults(json_t *json, Text *out)
{
    static const char *const rules[] = {"A", "B", "pixelmatch", "flip", "psnr", "blender", "ssim"};
    enum { RULES = sizeof rules / sizeof *rules };
    json_t *row;
    size_t i;
    text_puts(out, "<div class=\"scroll\"><table class=\"kills\"><thead><tr><th>Fault</th>"
                   "<th>Model</th>");
    for (size_t k = 0; k < RULES; k++)
        text_printf(out, "<th>%s%s</th>", k < 2 ? "tier " : "", rules[k]);
    text_puts(out, "</tr></thead><tbody>\n");
    json_array_foreach(json_object_get(json, "faults"), i, row)
    {
        text_puts(out, "<tr><th>");
        text_escaped(out, text_of(row, "fault"));
        text_puts(out, "</th><td>");
        text_escaped(out, text_of(row, "model"));
        text_puts(out, "</td>");
        for (size_t k = 0; k < RULES; k++)
            text_printf(out, "<td>%s</td>", mark(row, rules[k]));
        text_puts(out, "</tr>\n");
    }
    text_puts(out, "</tbody></table></div>\n");
}

static void put_limits(json_t *json, Text *out)
{
    static const char *const texts[] = {"parameter", "model", "unit"};
    static const char *const limits[] = {"A", "B", "pixelmatch", "blender"};
    json_t *row;
    size_t i;
    text_puts(out, "<h3>The smallest fault found</h3>\n<div class=\"scroll\"><table><thead><tr>"
                   "<th>Parameter</th><th>Model</th><th>Unit</th><th class=\"number\">tier A</th>"
                   "<th class=\"number\">tier B</th><th class=\"number\">pixelmatch</th>"
                   "<th class=\"number\">Blender</th></tr></thead><tbody>\n");
    json_array_foreach(json_object_get(json, "limits"), i, row)
    {
        text_puts(out, "<tr>");
        for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
            text_puts(out, "<td>");
            text_escaped(out, text_of(row, texts[k]));
            text_puts(out, "</td>");
        }
        for (size_t k = 0; k < sizeof limits / sizeof *limits; k++) {
            json_t *limit = json_object_get(row, limits[k]);
            if (json_is_number(limit))
                text_printf(out, "<td class=\"number\">%.2g</td>", json_number_value(limit));
            else
                text_puts(out, "<td class=\"number\">never</td>");
        }
        text_puts(out, "</tr>\n");
    }
    text_puts(out, "</tbody></table></div>\n");
}

/* The kill matrix of `make power` and its smallest faults. */
static Status power_section(const char *path, Text *out, Err *err)
{
    json_t *json = NULL;
    TRY(read_json(&json, path, err));
    text_puts(out, "<section>\n<h2>What the judge finds</h2>\n<p>Faults planted in one side, and "
                   "the rules that find them: the tiers, and pixelmatch at 0.1, FLIP mean above "
                   "0.01, PSNR below 40, Blender's 1 % of pixels off by 0.016, SSIM below 0.99. ");
    text_printf(out, "%zu false alarms about %lld clean scenes.</p>\n",
                json_array_size(json_object_get(json, "alarms")),
                json_integer_value(json_object_get(json, "clean_scenes")) +
                    json_integer_value(json_object_get(json, "povray_scenes")));
    put_faults(json, out);
    put_limits(json, out);
    text_puts(out, "</section>\n");
    json_decref(json);
    return text_check(out, err);
}

/* -------------------------------------------------------------------------------------------
 * page */

static Status write_page(const MergedCase *cases, size_t n, const Text *power,
                         const char *templates, const char *path, Err *err)
{
    Text rows = TEXT_INIT, sections = TEXT_INIT, heading = TEXT_INIT, page = TEXT_INIT;
    size_t differing = 0;
    Status status = STATUS_OK;
    for (size_t i = 0; i < n; i++) {
        append_numbered(&rows, cases[i].row, cases[i].row_size, cases[i].number);
        append_numbered(&sections, cases[i].section, cases[i].section_size, cases[i].number);
        differing += cases[i].severity > 0;
    }
    if (differing)
        text_printf(&heading, "%zu of %zu cases <span class=\"bad\">differ</span>", differing, n);
    else
        text_printf(&heading, "All %zu cases <span class=\"good\">agree</span>", n);
    const ReportFrame frame = {
        .title = differing ? "corcast: cases differ" : "corcast: all cases agree",
        .heading = text_chars(&heading),
        .sentence = "Each case is one scene, drawn by POV-Ray (A) and by corcast (B).",
        .rows = text_chars(&rows),
        .cases = text_chars(&sections),
        .power = text_chars(power),
        .n_cases = n,
        .agrees = differing == 0};
    TRY_GOTO(report_frame(&frame, templates, &page, err));
    status = file_write_text(path, &page, err);
done:
    text_release(&rows);
    text_release(&sections);
    text_release(&heading);
    text_release(&page);
    return status;
}

Status report_merge(const char *const *folders, size_t n, const char *power, const char *templates,
                    const char *path, bool *all_agree, Err *err)
{
    MergedCase *cases;
    Text of_power = TEXT_INIT;
    TRY(mem_calloc(&cases, n, sizeof *cases, "cases", err));
    Status status = STATUS_OK;
    bool agree = true;
    for (size_t i = 0; i < n; i++) {
        cases[i].number = i + 1;
        TRY_GOTO(read_case(&cases[i], folders[i], err));
        agree = agree && cases[i].severity == 0;
    }
    if (power)
        TRY_GOTO(power_section(power, &of_power, err));
    qsort(cases, n, sizeof *cases, worst_first);
    TRY_GOTO(write_page(cases, n, &of_power, templates, path, err));
    *all_agree = agree;
done:
    for (size_t i = 0; i < n; i++)
        free(cases[i].page);
    free(cases);
    text_release(&of_power);
    return status;
}
