/* Prints which requirements of a publisher a figure violates, as lines or as JSON. */
#include "cli/commands.h"
#include "job/figure/check_figure.h"
#include "options/output.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Returns the lines of *text as a new JSON array, and empties *text. NULL if memory runs out. */
static json_t *json_lines(Text *text)
{
    json_t *array = json_array();
    char *rest = NULL, *copy = NULL;
    Err err;
    if (text_take(text, &copy, &err) != STATUS_OK)
        return json_decref(array), NULL;
    for (char *line = strtok_r(copy, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest))
        array = json_with_item(array, json_text(line));
    free(copy);
    return array;
}

static Status print_json(FigureFindings *found, const char *path, const CheckFigureOptions *options,
                         Err *err)
{
    return json_write(JSON_OBJECT({"file", json_text(file_name(path))},
                                  {"preset", json_text(options->preset)},
                                  {"kind", json_text(content_kinds[options->kind])},
                                  {"accepted", json_boolean(found->n_refused == 0)},
                                  {"refused", json_lines(&found->refused)},
                                  {"not_checked", json_lines(&found->unchecked)}),
                      "-", err);
}

/* Prints each line after the name of the file. */
static void print_lines(const char *path, const Text *lines)
{
    const char *line = text_chars(lines);
    for (size_t length; line && *line; line += length + 1) {
        length = strcspn(line, "\n");
        printf("%s: %.*s\n", path, (int)length, line);
    }
}

static Status print_verdict(FigureFindings *found, const char *path,
                            const CheckFigureOptions *options, Err *err)
{
    if (options->json)
        return print_json(found, path, options, err);
    if (found->n_refused == 0)
        printf("%s: meets the preset %s. Not checked: %s", path, options->preset,
               text_chars(&found->unchecked) ? text_chars(&found->unchecked) : "nothing\n");
    else
        print_lines(path, &found->refused);
    return STATUS_OK;
}

Status run_check_figure(void *options, Parsed *parsed, Err *err)
{
    FigureFindings found = {0};
    const char *path = parsed->operands[0];
    Status status = check_figure_make(options, path, &found, err);
    if (status == STATUS_OK)
        status = print_verdict(&found, path, options, err);
    if (status == STATUS_OK && found.n_refused > 0)
        status = STATUS_DIFFERS;
    figurefindings_release(&found);
    return status;
}
