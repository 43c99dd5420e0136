/* The page for people. The template has the words that never change, the look and the viewer; what
 * repeats or depends on the case is made here as fragments of HTML. Pictures go in as data: URIs,
 * because a page opened from disk may not read the pixels of a file beside it. */
#include "verify/report.h"

#include "tmpl/tmpl.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>

typedef enum Fragment {
    PART_ID,
    PART_SEGMENTS,
    PART_EDGE,
    PART_VERDICT_TITLE,
    PART_VERDICT_SENTENCE,
    PART_SUBJECT,
    PART_RULES,
    PART_METRICS,
    PART_SEGMENT_LINES,
    PART_LEGEND,
    PART_SIDES,
    PART_TOLERANCE,
    PART_COMMANDS,
    PART_NAME_A,
    PART_NAME_B,
    PART_ALT_A,
    PART_ALT_B,
    PART_IMAGE_A,
    PART_IMAGE_B,
    PART_HEAT,
    PART_IDS_A,
    PART_IDS_B,
    PART_RANGE,
    PART_CLASSES,
    PART_DEPTH_A, /* the planes in the order of ReportPlane */
    PART_DEPTH_B,
    PART_NORMAL_A,
    PART_NORMAL_B,
    PART_ANGLES,
    PARTS
} Fragment;

static const char *const part_names[PARTS] = {
    "id",      "segments",  "verdict_edge", "verdict_title", "verdict_sentence",
    "subject", "rule_rows", "metric_rows",  "segment_lines", "legend",
    "sides",   "tolerance", "commands",     "name_a",        "name_b",
    "alt_a",   "alt_b",     "image_a",      "image_b",       "image_heat",
    "ids_a",   "ids_b",     "depth_range",  "classes",       "depth_a",
    "depth_b", "normal_a",  "normal_b",     "angles"};

/* ------------------------------------------------------------------------------------- verdict */

/* Who is right where the sides differ, cause by cause. */
static void settled_sentence(const ReportCase *report, Text *sentence)
{
    const Settled *settled = report->settled;
    for (SettledCause cause = settled->from; cause <= settled->to; cause++)
        if (settled->count[cause]) {
            text_printf(sentence, " Settled: %s, ", settled_cause_sentence(cause));
            report_number(sentence, (double)settled->count[cause], "");
            text_puts(sentence, "; ");
            text_escaped(sentence, report->b.name);
            text_puts(sentence, " is right there.");
        }
}

/* What tells the case from others of the same tree and model: the options of its command. */
static void put_options(const ReportCase *report, Text *out)
{
    if (report->n_commands == 0)
        return;
    const char *command = report->commands[0];
    for (int words = 0; words < 2 && strchr(command, ' '); words++) /* corcast verify */
        command = strchr(command, ' ') + 1;
    text_puts(out, "<code>");
    text_escaped(out, command);
    text_puts(out, "</code> ");
}

static void verdict_parts(const ReportCase *report, Text parts[PARTS])
{
    const char *reason = report_reason(report);
    const CompareResult *color = report->planes[PLANE_COLOR];
    int compared = 0, differing = 0;
    for (PlaneKind kind = 0; kind < PLANE_KINDS; kind++) {
        compared += report->planes[kind] != NULL;
        differing += report->planes[kind] && !report->planes[kind]->agrees;
    }
    text_puts(&parts[PART_ID], REPORT_FIRST_CASE);
    text_puts(&parts[PART_EDGE], reason ? "bad-edge" : "good-edge");
    text_escaped(&parts[PART_VERDICT_TITLE], report->name);
    text_puts(&parts[PART_VERDICT_TITLE], *report->model ? ", " : "");
    text_escaped(&parts[PART_VERDICT_TITLE], report->model);
    text_puts(&parts[PART_VERDICT_TITLE], reason ? ": <span class=\"bad\">differ</span>"
                                                 : ": <span class=\"good\">agree</span>");
    Text *sentence = &parts[PART_VERDICT_SENTENCE];
    const char *cause = color->agrees ? "" : color->cause;
    if (reason) {
        if (differing)
            text_printf(sentence, "%d of %d planes differ%s. First, ", differing, compared,
                        differing == 1 ? "s" : "");
        text_escaped(sentence, reason);
        text_puts(sentence, ".");
        text_puts(sentence, *cause ? " The pictures: " : "");
        text_escaped(sentence, cause);
        text_puts(sentence, *cause ? "." : "");
    } else {
        if (color->differing_pixels == 0)
            text_printf(sentence, "All %zu pixels have the same colour in both pictures. ",
                        color->pixels);
        else
            text_printf(sentence,
                        "%zu of %zu pixels differ in colour, the worst by %.3g of 255 levels. ",
                        color->differing_pixels, color->pixels, color->max_abs);
        text_printf(sentence,
                    compared == 1 ? "The %d plane compared is" : "The %d planes compared are",
                    compared);
        text_puts(sentence, " within tolerance.");
        if (report->settled)
            settled_sentence(report, sentence);
        if (report->surface)
            text_puts(sentence,
                      " What POV-Ray's root finder sees is the surface to its accuracy, and "
                      "the surface has POV-Ray's colours.");
    }
    Text *subject = &parts[PART_SUBJECT];
    put_options(report, subject);
    text_printf(subject, "%d × %d pixels, tolerance tier ", color->width, color->height);
    text_escaped(subject, color->tolerance.tier);
}

/* --------------------------------------------------------------------------------------- parts */

static void table_parts(const ReportCase *report, Text parts[PARTS])
{
    for (PlaneKind kind = 0; kind < PLANE_KINDS; kind++)
        if (report->planes[kind]) {
            report_rule_rows(report->planes[kind], &parts[PART_RULES]);
            report_metric_tables(report->planes[kind], &parts[PART_METRICS]);
        }
    if (report->settled)
        report_settled_rows(report, &parts[PART_RULES], &parts[PART_METRICS]);
    if (report->exact)
        report_exact_rows(report->exact, &parts[PART_RULES], &parts[PART_METRICS]);
    if (report->surface)
        report_surface_rows(report->surface, &parts[PART_RULES], &parts[PART_METRICS]);
    for (int i = 0; i < HEAT_STEPS; i++) {
        const HeatStep *step = &heat_steps[i];
        int to = i + 1 < HEAT_STEPS ? heat_steps[i + 1].from_level - 1 : 255;
        text_printf(&parts[PART_LEGEND], "<span><i style=\"background:#%02x%02x%02x\"></i>%d",
                    step->red, step->green, step->blue, step->from_level);
        if (to > step->from_level)
            text_printf(&parts[PART_LEGEND], "–%d", to);
        text_puts(&parts[PART_LEGEND], "</span>");
    }
}

static Status class_part(const ReportCase *report, Text *part, Err *err)
{
    const ReportSide *a = &report->a, *b = &report->b;
    bool geometry = a->depth && a->normal && b->depth && b->normal;
    const Rendering in_a = {a->picture, a->ids, geometry ? a->depth : NULL,
                            geometry ? a->normal : NULL};
    const Rendering in_b = {b->picture, b->ids, geometry ? b->depth : NULL,
                            geometry ? b->normal : NULL};
    Picture classes;
    TRY(class_picture(&classes, &in_a, &in_b, &report->planes[PLANE_COLOR]->tolerance, err));
    Status status = report_picture(part, &classes, err);
    picture_release(&classes);
    return status;
}

static Status plane_parts(const ReportCase *report, Text parts[PARTS], Err *err)
{
    Text *planes[REPORT_PLANES];
    double range_mm[2];
    for (int i = 0; i < REPORT_PLANES; i++)
        planes[i] = &parts[PART_DEPTH_A + i];
    TRY(report_planes(&report->a, &report->b, planes, range_mm, err));
    text_printf(&parts[PART_RANGE], "%.9g %.9g", range_mm[0], range_mm[1]);
    return class_part(report, &parts[PART_CLASSES], err);
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
    Status status = report_picture(part, &picture, err);
    picture_release(&picture);
    return status;
}

/* ---------------------------------------------------------------------------------------- words */

static void side_parts(const ReportSide *side, Fragment name, Fragment alt, Text parts[PARTS])
{
    text_escaped(&parts[name], side->name);
    text_puts(&parts[alt], isnan(side->seconds) ? "The picture " : "The scene as rendered by ");
    text_escaped(&parts[alt], side->name);
    if (isnan(side->seconds))
        return;
    text_escaped(&parts[PART_SIDES], side->name);
    text_puts(&parts[PART_SIDES], " ");
    text_escaped(&parts[PART_SIDES], side->version);
    text_printf(&parts[PART_SIDES], " took %.2f s for the picture. ", side->seconds);
}

/* When, by what and where the case was made. */
static void origin_part(Text *part)
{
    char day[40] = "";
    struct utsname machine = {0};
    struct tm utc;
    time_t now = time(NULL);
    if (gmtime_r(&now, &utc))
        strftime(day, sizeof day, "%Y-%m-%d %H:%M UTC", &utc);
    uname(&machine);
    text_printf(part, "Compared on %s by corcast %s, compiled by %s, on ", day, CORCAST_VERSION,
#ifdef __clang__
                __VERSION__
#else
                "gcc " __VERSION__
#endif
    );
    text_escaped(part, machine.sysname);
    text_puts(part, " ");
    text_escaped(part, machine.machine);
    text_puts(part, ".");
}

static void tolerance_part(const Tolerance *tolerance, Text *part)
{
    text_puts(part, "Tolerance tier ");
    text_escaped(part, tolerance->tier);
    text_puts(part, ". A is the reference; a difference is B less A, in 8-bit levels.");
}

/* The segments in words, and for the viewer's crops as JSON in an attribute. */
static void segment_parts(const CompareResult *color, Text parts[PARTS])
{
    Text *lines = &parts[PART_SEGMENT_LINES];
    for (int i = 0; i < color->n_worst_segments; i++)
        text_printf(lines, "%ssegment %u with %zu", i ? ", " : "", color->worst_segments[i].id,
                    color->worst_segments[i].differing);
    text_puts(lines, color->n_worst_segments ? " pixels."
                     : color->has_ids        ? "No segment differs."
                                             : "Not told apart: no id planes were given.");
    Text json = TEXT_INIT;
    text_json(&json, worst_segments_json(color), 0);
    text_escaped(&parts[PART_SEGMENTS], text_chars(&json));
    text_release(&json);
}

static Status fill_parts(const ReportCase *report, const Picture *heat, Text parts[PARTS], Err *err)
{
    verdict_parts(report, parts);
    table_parts(report, parts);
    side_parts(&report->a, PART_NAME_A, PART_ALT_A, parts);
    side_parts(&report->b, PART_NAME_B, PART_ALT_B, parts);
    origin_part(&parts[PART_SIDES]);
    tolerance_part(&report->planes[PLANE_COLOR]->tolerance, &parts[PART_TOLERANCE]);
    for (size_t i = 0; i < report->n_commands; i++) {
        text_escaped(&parts[PART_COMMANDS], report->commands[i]);
        text_puts(&parts[PART_COMMANDS], "\n");
    }
    segment_parts(report->planes[PLANE_COLOR], parts);
    TRY(report_picture(&parts[PART_IMAGE_A], report->a.picture, err));
    TRY(report_picture(&parts[PART_IMAGE_B], report->b.picture, err));
    TRY(report_picture(&parts[PART_HEAT], heat, err));
    TRY(ids_part(&parts[PART_IDS_A], report->a.ids, err));
    TRY(ids_part(&parts[PART_IDS_B], report->b.ids, err));
    return plane_parts(report, parts, err);
}

static Status expand_case(const ReportCase *report, const Picture *heat, const char *templates,
                          Text *out, Err *err)
{
    Text parts[PARTS] = {0};
    TmplValue values[PARTS];
    char *path = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(fill_parts(report, heat, parts, err));
    for (int i = 0; i < PARTS; i++)
        values[i] = (TmplValue){part_names[i], text_chars(&parts[i])};
    TRY_GOTO(file_join(templates, "case.html", &path, err));
    status = tmpl_expand(path, values, PARTS, out, err);
done:
    for (int i = 0; i < PARTS; i++)
        text_release(&parts[i]);
    free(path);
    return status;
}

/* ---------------------------------------------------------------------------------- table of
 * cases */

static void number_cell(Text *row, double value)
{
    text_printf(row, "<td class=\"number\" data-value=\"%.9g\">", isnan(value) ? -1 : value);
    if (!isnan(value))
        report_number(row, value, "");
    text_puts(row, "</td>");
}

static Status case_row(const ReportCase *report, Text *row, Err *err)
{
    const CompareResult *color = report->planes[PLANE_COLOR];
    bool agrees = report_agrees(report);
    Picture thumbnail;
    text_puts(row,
              REPORT_ROW_BEGIN "<tr data-case=\"" REPORT_FIRST_CASE "\"><td><img alt=\"\" src=\"");
    TRY(report_thumbnail(&thumbnail, report->b.picture, err));
    Status status = report_picture(row, &thumbnail, err);
    picture_release(&thumbnail);
    TRY(status);
    text_puts(row, "\"></td><th><a href=\"#" REPORT_FIRST_CASE "\">");
    text_escaped(row, report->name);
    text_puts(row, "</a><small>");
    put_options(report, row);
    text_puts(row, "</small></th><td>");
    text_escaped(row, report->model);
    text_printf(row, "</td><td class=\"verdict %s\" data-value=\"%.9g\">%s</td>",
                agrees ? "good" : "bad", report_severity(report), agrees ? "✓ agree" : "✗ differ");
    number_cell(row, (double)color->differing_pixels);
    number_cell(row, color->max_abs);
    number_cell(row, color->flip_mean);
    number_cell(row, color->ssim);
    text_puts(row, "</tr>\n" REPORT_ROW_END);
    return text_check(row, err);
}

/* -------------------------------------------------------------------------------------------
 * page */

Status report_frame(const ReportFrame *frame, const char *templates, Text *out, Err *err)
{
    const TmplValue values[] = {{"title", frame->title},
                                {"edge", frame->agrees ? "good-edge" : "bad-edge"},
                                {"heading", frame->heading},
                                {"sentence", frame->sentence},
                                {"table_hidden", frame->n_cases == 1 ? " hidden" : ""},
                                {"rows", frame->rows},
                                {"cases", frame->cases},
                                {"power", frame->power}};
    char *path;
    TRY(file_join(templates, "report.html", &path, err));
    Status status = tmpl_expand(path, values, sizeof values / sizeof *values, out, err);
    free(path);
    return status;
}

Status report_page(const ReportCase *report, const Picture *heat, const char *templates,
                   const char *path, Err *err)
{
    Text row = TEXT_INIT, section = TEXT_INIT, title = TEXT_INIT, heading = TEXT_INIT,
         page = TEXT_INIT;
    bool agrees = report_agrees(report);
    Status status = STATUS_OK;
    TRY_GOTO(case_row(report, &row, err));
    TRY_GOTO(expand_case(report, heat, templates, &section, err));
    text_escaped(&title, report->name);
    text_puts(&title, agrees ? ": the pictures agree" : ": the pictures differ");
    text_escaped(&heading, *report->model ? report->b.name : report->name);
    text_puts(&heading, *report->model ? " and " : "");
    text_escaped(&heading, *report->model ? report->a.name : "");
    text_puts(&heading,
              agrees ? " <span class=\"good\">agree</span>" : " <span class=\"bad\">differ</span>");
    const ReportFrame frame = {.title = text_chars(&title),
                               .heading = text_chars(&heading),
                               .sentence = "",
                               .rows = text_chars(&row),
                               .cases = text_chars(&section),
                               .power = "",
                               .n_cases = 1,
                               .agrees = agrees};
    TRY_GOTO(report_frame(&frame, templates, &page, err));
    status = file_write_text(path, &page, err);
done:
    text_release(&row);
    text_release(&section);
    text_release(&title);
    text_release(&heading);
    text_release(&page);
    return status;
}
