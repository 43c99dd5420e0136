/* Serves a test runner (`compare --serve`): for each line of JSON on standard input, a question, it
 * compares two images and writes the answer as a line of JSON. Each question is parsed as a command
 * line of its own, so that a question with an error does not change the next question. */
#include "cli/command/compare_serve.h"

#include "job/verify/compare.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Sets an option to a string, number or boolean. null and false leave the option unchanged, except
 * that false turns `metrics` off, which is on by default. "-" is refused, because standard input
 * carries the questions. */
static Status set_option(Parsed *parsed, const char *name, const json_t *value, Err *err)
{
    char number[40];
    if (json_is_false(value) || json_is_null(value))
        return json_is_false(value) && strcmp(name, "metrics") == 0
                   ? options_set(parsed, name, "off", err)
                   : STATUS_OK;
    if (json_is_true(value))
        return options_set(parsed, name, "on", err);
    if (json_is_string(value) && strcmp(json_string_value(value), "-") != 0)
        return options_set(parsed, name, json_string_value(value), err);
    if (!json_is_number(value))
        return err_set(err, STATUS_USAGE,
                       "--%s: the value must be a string other than \"-\", a number, true or false",
                       name);
    snprintf(number, sizeof number, "%.17g", json_number_value(value));
    return options_set(parsed, name, number, err);
}

/* Returns true if every member of the question is known: operands, options and id. */
static bool is_known(const json_t *question)
{
    const size_t known = (json_object_get(question, "operands") != NULL) +
                         (json_object_get(question, "options") != NULL) +
                         (json_object_get(question, "id") != NULL);
    return json_object_size(question) == known;
}

/* Fills in the command line that a question stands for. The operands point into the question, which
 * must outlive *parsed. */
static Status fill_parsed(const json_t *question, Parsed *parsed, Err *err)
{
    json_t *operands = json_object_get(question, "operands"),
           *options = json_object_get(question, "options"), *value;
    const char *name;
    size_t i;
    if (!json_is_array(operands) || (options && !json_is_object(options)) || !is_known(question))
        return err_set(err, STATUS_USAGE,
                       "a question needs \"operands\", an array of strings, and may have "
                       "\"options\", an object, and \"id\", but nothing else");
    json_array_foreach(operands, i, value)
    {
        if (!json_is_string(value) || strcmp(json_string_value(value), "-") == 0 || i == 2)
            return err_set(err, STATUS_USAGE,
                           "\"operands\" must be one or two strings, none of them \"-\"");
        parsed->operands[parsed->n_operands++] = json_string_value(value);
    }
    json_object_foreach(options, name, value)
    {
        TRY(set_option(parsed, name, value, err));
    }
    if (((CompareOptions *)parsed->options)->serve)
        return err_set(err, STATUS_USAGE, "--serve is already on");
    return options_finish(parsed, err);
}

/* Compares the images of a question. Sets *result to the JSON of the result, a new reference, or to
 * NULL with --accept. */
static Status answer(const json_t *question, json_t **result, Err *err)
{
    Parsed parsed;
    Comparison comparison = {0};
    Status status;
    TRY(parsed_init(&parsed, &command_compare, err));
    parsed.common.quiet = true;
    TRY_GOTO(fill_parsed(question, &parsed, err));
    TRY_GOTO(compare_make(parsed.options, &parsed, &comparison, err));
    status = compare_write(parsed.options, &parsed, &comparison, err);
    if (status == STATUS_OK) {
        *result = comparison_json(&comparison);
        status = comparison.agrees ? STATUS_OK : STATUS_DIFFERS;
    }
    comparison_release(&comparison);
done:
    parsed_release(&parsed);
    return status;
}

/* Reads a question, and returns the answer as JSON, a new reference. Returns NULL if memory runs
 * out, which text_json then reports. */
static json_t *answer_line(const char *line, size_t length)
{
    Err err = {0};
    json_error_t error;
    bool no_memory;
    json_t *result = NULL, *question = json_read(line, length, 0, &error, &no_memory);
    Status status;
    if (no_memory)
        status = mem_out_of("to read", "the question", &err);
    else if (!question)
        status = err_set(&err, STATUS_INPUT, "the line is not valid JSON: %s", error.text);
    else if (!json_is_object(question))
        status = err_set(&err, STATUS_INPUT, "the line is not a JSON object");
    else
        status = answer(question, &result, &err);
    json_t *id = question ? json_object_get(question, "id") : NULL;
    const bool failed = status != STATUS_OK && status != STATUS_DIFFERS;
    json_t *json = json_with(json_object(), "id", id ? json_incref(id) : json_null());
    json = json_with(json, "exit_status", json_integer(status_exit(status)));
    json = json_with(json, failed ? "error" : "result",
                     failed   ? json_text(err.text)
                     : result ? json_incref(result)
                              : json_null());
    json_decref(result);
    json_decref(question);
    return json;
}

Status compare_serve(Err *err)
{
    char *line = NULL;
    size_t capacity = 0;
    Status status = STATUS_OK;
    for (ssize_t length; status == STATUS_OK && (length = getline(&line, &capacity, stdin)) >= 0;) {
        Text text = TEXT_TO(stdout);
        if (strspn(line, " \t\r\n") == (size_t)length)
            continue;
        text_json(&text, answer_line(line, (size_t)length), 0);
        text_puts(&text, "\n");
        status = text_flush(&text, err);
        if (status == STATUS_OK && fflush(stdout) != 0)
            status = err_set(err, STATUS_IO, "standard output: writing failed");
        text_release(&text);
    }
    free(line);
    return status;
}
