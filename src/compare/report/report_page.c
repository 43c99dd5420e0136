/* Writes the HTML page of a report, which shows a comparison of two pictures. The templates have
 * markup, style and the viewer. This file fills them in, from the inside out: rows, the section of
 * the case, the page. Pictures are data: URIs, because the script of a page that was opened from
 * disk cannot read the pixels of other files. */
#include "compare/measures/planes.h"
#include "compare/report/check.h"
#include "compare/report/page.h"
#include "compare/report/pictures.h"
#include "tmpl/tmpl.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>

static const char *class_of(bool agrees)
{
    return agrees ? "good" : "bad";
}

static const char *verdict_of(bool agrees)
{
    return agrees ? "agree" : "differ";
}

/* ------------------------------------------------------------------------------------- verdict */

/* Appends the numbers of settled pixels per cause. */
static void put_settled(const ReportCase *report, Text *sentence)
{
    const Settled *settled = report->settled;
    for (SettledCause cause = settled->from; cause <= settled->to; cause++)
        if (settled->count[cause])
            text_printf(sentence, " Differences decided in favour of %s: %s, %zu.", report->b.name,
                        settled_cause_sentence(cause), settled->count[cause]);
}

static void put_agreement(const ReportCase *report, int compared, Text *sentence)
{
    const CompareResult *color = report->planes[PLANE_COLOR];
    if (color->values[MEASURE_DIFFERING_PIXELS] == 0)
        text_printf(sentence, "All %zu pixels have the same color in both pictures. ",
                    result_count(color, MEASURE_PIXELS));
    else
        text_printf(sentence, "%zu of %zu pixels differ in color, by at most %.3g of 255 levels. ",
                    result_count(color, MEASURE_DIFFERING_PIXELS),
                    result_count(color, MEASURE_PIXELS), color->values[MEASURE_MAX_ABS]);
    text_printf(sentence, compared == 1 ? "The %d plane compared is" : "The %d planes compared are",
                compared);
    text_puts(sentence, " within tolerance.");
    if (report->settled)
        put_settled(report, sentence);
    if (report->witness)
        text_printf(sentence, " %s.", report->witness->sentence);
    if (report->surface)
        text_puts(sentence, " The surface found by POV-Ray agrees with the exact surface to "
                            "POV-Ray's accuracy, and so do its colors.");
}

/* Appends the sentence under the title: why the pictures agree, or the first difference. */
static void put_sentence(const ReportCase *report, Text *sentence)
{
    const char *reason = report_reason(report);
    const CompareResult *color = report->planes[PLANE_COLOR];
    int compared = 0, differing = 0;
    for (PlaneKind kind = 0; kind < PLANE_KINDS; kind++) {
        compared += report->planes[kind] != NULL;
        differing += report->planes[kind] && !report->planes[kind]->agrees;
    }
    if (!reason) {
        put_agreement(report, compared, sentence);
        return;
    }
    bool alone = compared == 1 || !differing;
    char whole[RESULT_SENTENCE];
    if (!color->agrees && reason == color->reason) {
        result_sentence(color, whole, sizeof whole);
        reason = whole;
    }
    if (!alone)
        text_printf(sentence, "%d of %d planes differ%s. First, ", differing, compared,
                    differing == 1 ? "s" : "");
    text_printf(sentence, "%c%s.", alone ? toupper((unsigned char)*reason) : *reason, reason + 1);
}

/* Returns the options of the case's command, which distinguish it from other cases of one tree. */
static const char *options_of(const ReportCase *report)
{
    const char *command = report->n_commands ? report->commands[0] : "";
    for (int words = 0; words < 2 && strchr(command, ' '); words++) /* corcast verify */
        command = strchr(command, ' ') + 1;
    return command;
}

/* --------------------------------------------------------------------------------------- parts */

/* Appends the legend of the heat map: a color and its range of levels, per step. */
static Status put_legend(const char *templates, Text *out, Err *err)
{
    for (int i = 0; i < HEAT_STEPS; i++) {
        const HeatStep *step = &heat_steps[i];
        int to = i + 1 < HEAT_STEPS ? heat_steps[i + 1].from_level - 1 : 255;
        Markup parts = {0};
        text_printf(markup_text(&parts, "color"), "#%02x%02x%02x", step->red, step->green,
                    step->blue);
        text_printf(markup_text(&parts, "levels"), to > step->from_level ? "%d–%d" : "%d",
                    step->from_level, to);
        TRY(markup_put(&parts, templates, "legend.html", out, err));
    }
    return STATUS_OK;
}

/* The large pictures of a case, each encoded by a thread. */
enum { SHOWN = 4 };
typedef struct Shown {
    const Picture *pictures[SHOWN];
    Text *parts[SHOWN];
} Shown;

static Status put_shown(size_t i, int worker, void *context, Err *err)
{
    (void)worker;
    Shown *shown = context;
    return picture_put_uri(shown->pictures[i], shown->parts[i], err);
}

static Status picture_parts(const ReportCase *report, const Picture *heat, Markup *parts, Err *err)
{
    Picture classes;
    Shown shown = {.pictures = {report->a.shown.picture, report->b.shown.picture, heat, &classes},
                   .parts = {markup_raw(parts, "image_a"), markup_raw(parts, "image_b"),
                             markup_raw(parts, "image_heat"), markup_raw(parts, "classes")}};
    TRY(class_picture(&classes, &report->a.shown, &report->b.shown,
                      &report->planes[PLANE_COLOR]->tolerance, err));
    Status status = threads_try(SHOWN, 0, put_shown, &shown, err);
    picture_release(&classes);
    return status;
}

static Status plane_parts(const ReportCase *report, Markup *parts, Err *err)
{
    static const char *const names[REPORT_PLANES] = {[REPORT_DEPTH_A] = "depth_a",
                                                     [REPORT_DEPTH_B] = "depth_b",
                                                     [REPORT_NORMAL_A] = "normal_a",
                                                     [REPORT_NORMAL_B] = "normal_b",
                                                     [REPORT_ANGLES] = "angles"};
    Text *planes[REPORT_PLANES];
    double range_mm[2];
    for (int i = 0; i < REPORT_PLANES; i++)
        planes[i] = markup_raw(parts, names[i]);
    TRY(report_planes(&report->a.shown, &report->b.shown, planes, range_mm, err));
    text_printf(markup_text(parts, "depth_range"), "%.9g %.9g", range_mm[0], range_mm[1]);
    return STATUS_OK;
}

/* "data:," is an empty document: the viewer then knows no ids. */
static Status ids_part(Text *part, const IdPlane *ids, Err *err)
{
    if (!ids) {
        text_puts(part, "data:,");
        return STATUS_OK;
    }
    Picture picture;
    TRY(picture_from_ids(&picture, ids, err));
    Status status = picture_put_uri(&picture, part, err);
    picture_release(&picture);
    return status;
}

static void side_words(const ReportSide *side, Text *alt, Text *sides)
{
    bool timed = !isnan(side->seconds);
    text_printf(alt, "%s %s", timed ? "The scene as rendered by" : "The picture", side->name);
    if (timed)
        text_printf(sides, "%s %s rendered the picture in %.2f s", side->name, side->version,
                    side->seconds);
    if (timed && side->tiles > 1)
        text_printf(sides, ", in %zu tiles", side->tiles);
    text_puts(sides, timed ? ". " : "");
}

/* When, by what and where the case was made. */
static void put_origin(Text *out)
{
#ifdef __clang__
    static const char compiler[] = __VERSION__;
#else
    static const char compiler[] = "gcc " __VERSION__;
#endif
    char date[DATE_TEXT_SIZE];
    struct utsname machine = {0};
    uname(&machine);
    text_printf(out, "Compared on %s by corcast %s, compiled by %s, on %s %s.", clock_date(date),
                CORCAST_VERSION, compiler, machine.sysname, machine.machine);
}

static void put_segments(const CompareResult *color, Text *out)
{
    for (int i = 0; i < color->n_worst_segments; i++)
        text_printf(out, "%ssegment %u with %zu", i ? ", " : "", color->worst_segments[i].id,
                    color->worst_segments[i].differing);
    text_puts(out, color->n_worst_segments ? " pixels."
                   : color->has_ids        ? "No segment differs."
                                           : "Not compared by segment: there are no id planes.");
}

static void fill_words(const ReportCase *report, Markup *parts)
{
    const CompareResult *color = report->planes[PLANE_COLOR];
    bool agrees = report_agrees(report);
    text_puts(markup_text(parts, "name"), report->name);
    text_puts(markup_text(parts, "parted"), *report->model ? ", " : "");
    text_puts(markup_text(parts, "model"), report->model);
    text_puts(markup_text(parts, "class"), class_of(agrees));
    text_puts(markup_text(parts, "verdict"), verdict_of(agrees));
    if (report->sentence)
        text_puts(markup_text(parts, "sentence"), report->sentence);
    else
        put_sentence(report, markup_text(parts, "sentence"));
    text_puts(markup_text(parts, "accept"), report->accept ? report->accept : "");
    text_puts(markup_text(parts, "options"), options_of(report));
    text_printf(markup_text(parts, "size"), "%d × %d", report->a.shown.picture->width,
                report->a.shown.picture->height);
    text_puts(markup_text(parts, "tier"), color->tolerance.tier);
    text_puts(markup_text(parts, "name_a"), report->a.name);
    text_puts(markup_text(parts, "name_b"), report->b.name);
    Text *sides = markup_text(parts, "sides");
    side_words(&report->a, markup_text(parts, "alt_a"), sides);
    side_words(&report->b, markup_text(parts, "alt_b"), sides);
    put_origin(sides);
    Text *commands = markup_text(parts, "commands");
    for (size_t i = 0; i < report->n_commands; i++)
        text_printf(commands, "%s\n", report->commands[i]);
    put_segments(color, markup_text(parts, "segment_lines"));
    text_json(markup_text(parts, "segments"), worst_segments_json(color), 0);
}

static Status put_case(const ReportCase *report, const Picture *heat, const char *templates,
                       Text *out, Err *err)
{
    Markup parts = {0};
    Status status = STATUS_OK;
    fill_words(report, &parts);
    Text *rules = markup_raw(&parts, "rules"), *measures = markup_raw(&parts, "measures");
    TRY_GOTO(report_tables(report, templates, rules, measures, err));
    TRY_GOTO(put_legend(templates, markup_raw(&parts, "legend"), err));
    TRY_GOTO(picture_parts(report, heat, &parts, err));
    TRY_GOTO(ids_part(markup_raw(&parts, "ids_a"), report->a.shown.ids, err));
    TRY_GOTO(ids_part(markup_raw(&parts, "ids_b"), report->b.shown.ids, err));
    TRY_GOTO(plane_parts(report, &parts, err));
    status = markup_put(&parts, templates, "case.html", out, err);
done:
    markup_release(&parts);
    return status;
}

/* ---------------------------------------------------------------------------- row of the case */

/* Fills a cell: the number to sort by, -1 if it is NAN, and the number as it is shown. */
static void put_cell(Markup *parts, const char *sorted, const char *shown, double value)
{
    Text *text = markup_text(parts, shown);
    text_printf(markup_text(parts, sorted), "%.9g", isnan(value) ? -1 : value);
    if (!isnan(value))
        text_rounded(text, value, "");
}

static Status put_row(const ReportCase *report, const char *templates, Text *row, Err *err)
{
    const CompareResult *color = report->planes[PLANE_COLOR];
    bool agrees = report_agrees(report);
    Markup parts = {0};
    Picture thumbnail;
    Status status = STATUS_OK;
    TRY(report_thumbnail(&thumbnail, report->b.shown.picture, err));
    TRY_GOTO(picture_put_uri(&thumbnail, markup_raw(&parts, "thumbnail"), err));
    text_puts(markup_text(&parts, "name"), report->name);
    text_puts(markup_text(&parts, "options"), options_of(report));
    text_puts(markup_text(&parts, "model"), report->model);
    text_puts(markup_text(&parts, "class"), class_of(agrees));
    text_puts(markup_text(&parts, "verdict"), agrees ? "✓ agree" : "✗ differ");
    text_printf(markup_text(&parts, "severity"), "%.9g", report_severity(report));
    put_cell(&parts, "differing_value", "differing", color->values[MEASURE_DIFFERING_PIXELS]);
    put_cell(&parts, "largest_value", "largest", color->values[MEASURE_MAX_ABS]);
    put_cell(&parts, "flip_value", "flip", color->values[MEASURE_FLIP_MEAN]);
    put_cell(&parts, "ssim_value", "ssim", color->values[MEASURE_SSIM]);
    status = markup_put(&parts, templates, "row.html", row, err);
done:
    picture_release(&thumbnail);
    markup_release(&parts);
    return status;
}

Status report_parts(const ReportCase *report, const Picture *heat, const char *templates, Text *row,
                    Text *section, Err *err)
{
    TRY(put_row(report, templates, row, err));
    return put_case(report, heat, templates, section, err);
}

/* ---------------------------------------------------------------------------------------- page */

Status report_write_frame(const ReportFrame *frame, const char *templates, const char *path,
                          Err *err)
{
    Markup parts = {0};
    Text page = TEXT_INIT;
    text_puts(markup_text(&parts, "title"), frame->title);
    text_puts(markup_text(&parts, "class"), class_of(frame->agrees));
    text_puts(markup_text(&parts, "verdict"), verdict_of(frame->agrees));
    text_puts(markup_text(&parts, "heading"), frame->heading);
    text_puts(markup_text(&parts, "sentence"), frame->sentence);
    text_puts(markup_text(&parts, "table_hidden"), frame->n_cases < 2 ? " hidden" : "");
    text_add(markup_raw(&parts, "rows"), frame->rows);
    text_add(markup_raw(&parts, "cases"), frame->cases);
    text_add(markup_raw(&parts, "others"), frame->others);
    text_add(markup_raw(&parts, "power"), frame->power);
    Status status = STATUS_OK;
    TRY_GOTO(markup_put(&parts, templates, "report.html", &page, err));
    status = file_write_text(path, &page, err);
done:
    text_release(&page);
    return status;
}

Status report_page(const ReportCase *report, const Picture *heat, const char *templates,
                   const char *path, Err *err)
{
    Text row = TEXT_INIT, section = TEXT_INIT, title = TEXT_INIT, heading = TEXT_INIT;
    bool agrees = report_agrees(report);
    Status status = STATUS_OK;
    TRY_GOTO(report_parts(report, heat, templates, &row, &section, err));
    text_printf(&title, "%s: the pictures %s", report->name, verdict_of(agrees));
    if (*report->model)
        text_printf(&heading, "%s and %s", report->b.name, report->a.name);
    else
        text_puts(&heading, report->name);
    const ReportFrame frame = {.title = text_chars(&title),
                               .heading = text_chars(&heading),
                               .sentence = "",
                               .rows = &row,
                               .cases = &section,
                               .power = &TEXT_INIT,
                               .others = &TEXT_INIT,
                               .n_cases = 1,
                               .agrees = agrees};
    status = report_write_frame(&frame, templates, path, err);
done:
    text_release(&row);
    text_release(&section);
    text_release(&title);
    text_release(&heading);
    return status;
}
