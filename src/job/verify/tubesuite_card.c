/* Formats the score card of the tube suite as text, JSON and a page. Scenes that are not certified
 * come first on the page. */
#include "job/verify/tubesuite.h"

static void put_verdict(const TubeCase *one, Text *out)
{
    const AnswerGrade *grade = &one->grade;
    if (!one->drawing->is_drawn)
        text_printf(out, "not drawn: %s", one->drawing->reason);
    else if (one->certified)
        text_printf(out, "certified, %zu undecided", grade->undecided);
    else
        text_printf(out,
                    "%zu of %zu pixels wrong, by up to %.3g levels (%zu brighter, %zu darker), "
                    "%zu undecided",
                    one->wrong, grade->pixels, fabs(grade->worst), grade->brighter, grade->darker,
                    grade->undecided);
}

void tubesuite_text(const TubeSuite *suite, Text *out)
{
    text_printf(out, "%zu of %zu scenes certified, %zu not drawn\n", suite->certified,
                suite->cases.n, suite->cases.n - suite->drawn);
    for (size_t i = 0; i < suite->cases.n; i++) {
        const TubeCase *one = &suite->cases.items[i];
        if (one->certified)
            continue;
        text_printf(out, "%s: ", one->name);
        put_verdict(one, out);
        text_puts(out, "\n");
    }
}

static json_t *case_json(const TubeCase *one)
{
    return JSON_OBJECT(
        {"name", json_text(one->name)}, {"group", json_text(one->group)},
        {"look", json_text(one->look)}, {"options", json_text(one->options)},
        {"rows", json_count((uint64_t)one->rows)}, {"drawn", json_boolean(one->drawing->is_drawn)},
        {"certified", json_boolean(one->certified)}, {"wrong", json_count(one->wrong)},
        {"reason", json_text_or_null(one->drawing->is_drawn ? NULL : one->drawing->reason)},
        {"grade", one->drawing->is_drawn ? answergrade_json(&one->grade) : json_null()});
}

json_t *tubesuite_json(const TubeSuite *suite)
{
    json_t *cases = json_array();
    for (size_t i = 0; i < suite->cases.n; i++)
        cases = json_with_item(cases, case_json(&suite->cases.items[i]));
    return JSON_OBJECT(
        {"renderer", json_text(suite->options->title ? suite->options->title
                                                     : suite->options->renderer.shell.command)},
        {"scenes", json_count(suite->cases.n)}, {"drawn", json_count(suite->drawn)},
        {"certified", json_count(suite->certified)}, {"cases", cases});
}

static void put_row(const TubeCase *one, Text *out)
{
    text_printf(out, "<tr class=\"%s\"><td>%s</td><td>%s</td><td>%d</td><td>",
                one->certified ? "good" : "bad", one->name, one->group, one->rows);
    Text verdict = TEXT_INIT;
    put_verdict(one, &verdict);
    text_escaped(out, text_chars(&verdict) ? text_chars(&verdict) : "");
    text_release(&verdict);
    text_puts(out, "</td><td>");
    if (one->drawing->is_drawn)
        text_printf(out,
                    "<img src=\"%s.png\" alt=\"picture\"> <img src=\"%s.distance.png\" "
                    "alt=\"distance from the answer\">",
                    one->name, one->name);
    text_puts(out, "</td></tr>\n");
}

void tubesuite_page(const TubeSuite *suite, Text *out)
{
    const char *title =
        suite->options->title ? suite->options->title : suite->options->renderer.shell.command;
    text_puts(out, "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<title>"
                   "Score card</title>\n<style>body{font:16px sans-serif;margin:2em}"
                   "td,th{padding:.2em .8em;text-align:left}img{image-rendering:pixelated;"
                   "width:128px}.bad{background:#fbe3dc}</style></head><body>\n<h1>");
    text_escaped(out, title);
    text_printf(out,
                "</h1>\n<p>%zu of %zu scenes of the tube suite are certified: each pixel lies in "
                "its proven interval. %zu scenes are not drawn. In the second picture, red pixels "
                "are too bright, and blue pixels are too dark.</p>\n<table><tr><th>scene</th>"
                "<th>group</th><th>rows</th><th>verdict</th><th>picture, distance</th></tr>\n",
                suite->certified, suite->cases.n, suite->cases.n - suite->drawn);
    for (int good = 0; good < 2; good++)
        for (size_t i = 0; i < suite->cases.n; i++)
            if (suite->cases.items[i].certified == good)
                put_row(&suite->cases.items[i], out);
    text_puts(out, "</table></body></html>\n");
}
