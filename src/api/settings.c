/* Implements the options of the library: corcast_options_new, _set, _get and _callbacks. The
 * options of a command are stored as the texts that the caller set. A Parsed with the same values
 * checks each text and formats values for corcast_options_get. Operations make a Parsed of their
 * own [api/request.h]. */
#include "api/request.h"

#include "job/job.h"
#include "options/output.h"
#include <stdlib.h>
#include <string.h>

Status request_require_command(const char *name, const Command **command, Err *err)
{
    TRY(argument_check(name, "command", err));
    *command = request_find_command(name);
    if (*command)
        return STATUS_OK;
    Suggestion suggestion = suggestion_start(name, strlen(name));
    for (const Command *const *known = job_commands; *known; known++)
        suggestion_offer(&suggestion, (*known)->name);
    (void)err_set(err, STATUS_USAGE, "'%s' is not a command of the library", name);
    suggestion_append(&suggestion, "", err);
    return STATUS_USAGE;
}

/* Frees a Parsed of parsed_new. NULL is allowed. */
static void parsed_free(Parsed *parsed)
{
    if (parsed)
        parsed_release(parsed);
    free(parsed);
}

/* Makes a Parsed with the defaults of a command. It is allocated, because a Parsed points into
 * itself and must not be moved. Errors: STATUS_MEMORY; those of parsed_init. */
static Status parsed_new(const Command *command, Parsed **out, Err *err)
{
    Parsed *made = NULL;
    TRY(mem_calloc(&made, 1, sizeof *made, "options", err));
    Status status = parsed_init(made, command, err);
    if (status != STATUS_OK)
        free(made);
    else
        *out = made;
    return status;
}

static Status new_options(const char *name, corcast_options **out, Err *err)
{
    const Command *command = NULL;
    corcast_options *made = NULL;
    TRY(argument_check(out, "out", err));
    TRY(request_require_command(name, &command, err));
    TRY(handle_new(&made, HANDLE_OPTIONS, sizeof *made, err));
    made->command = command;
    Status status = parsed_new(command, &made->parsed, err);
    if (status != STATUS_OK)
        handle_free(made);
    else
        *out = made;
    return status;
}

int corcast_options_new(const char *command, corcast_options **out, corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, new_options(command, out, &call.err));
}

/* ---- setting --------------------------------------------------------------------------------- */

/* Finds the row of an option. Errors: STATUS_USAGE for an unknown option and for an option that
 * only the command line has. */
static Status find_option(const corcast_options *options, const char *name, const Option **option,
                          Err *err)
{
    static const char *const printing[] = {"help", "dump-recipe", "commands", NULL};
    TRY(argument_check(name, "name", err));
    const Setting *setting = parsed_find(options->parsed, name, strlen(name));
    Text unused = TEXT_INIT;
    if (!setting) /* options_get sets the error */
        return options_get(options->parsed, name, &unused, err);
    *option = setting->option;
    if (is_one_of(name, printing))
        return err_set(err, STATUS_USAGE, "'%s' is an option of the command line only", name);
    return STATUS_OK;
}

static void remove_text(OptionTexts *texts, size_t at)
{
    free(texts->items[at].value);
    memmove(&texts->items[at], &texts->items[at + 1], (--texts->n - at) * sizeof *texts->items);
}

/* Removes those of the first `n` texts that belong to the option. */
static void remove_texts(OptionTexts *texts, const char *name, size_t n)
{
    for (size_t i = n; i-- > 0;)
        if (strcmp(texts->items[i].name, name) == 0)
            remove_text(texts, i);
}

/* Replaces the Parsed by a new one that is set from the texts. The texts are valid, so only memory
 * can be missing. */
static Status parse_again(corcast_options *options, Err *err)
{
    Parsed *made = NULL;
    Status status = STATUS_OK;
    TRY(parsed_new(options->command, &made, err));
    for (size_t i = 0; i < options->texts.n; i++) {
        const OptionText *text = &options->texts.items[i];
        TRY_GOTO(options_set(made, text->name, text->value, err));
    }
    parsed_free(options->parsed);
    options->parsed = made;
    made = NULL;
done:
    parsed_free(made);
    return status;
}

/* Sets an option back to its default. The texts change only after the Parsed was made, so that an
 * error leaves the options as they were. */
static Status unset(corcast_options *options, const Option *option, Err *err)
{
    OptionTexts kept = {0};
    Status status = STATUS_OK;
    for (size_t i = 0; i < options->texts.n; i++)
        if (strcmp(options->texts.items[i].name, option->name) != 0)
            TRY_GOTO(ARRAY_PUSH(&kept, "options", err, options->texts.items[i]));
    OptionTexts all = options->texts;
    options->texts = kept;
    status = parse_again(options, err);
    options->texts = all;
    TRY_GOTO(status);
    remove_texts(&options->texts, option->name, options->texts.n);
done:
    ARRAY_RELEASE(&kept);
    return status;
}

/* Checks that a value does not contain the file "-", as "mask:-,0.5" does. On the command line "-"
 * is standard input. Errors: STATUS_USAGE. */
static Status check_no_stream(const char *name, const char *value, Err *err)
{
    for (const char *at = strstr(value, ":-"); at; at = strstr(at + 1, ":-"))
        if (at[2] == '\0' || at[2] == ',' || at[2] == '@')
            return err_set(err, STATUS_USAGE,
                           "%s is \"%s\", which reads the file \"-\": the library does not use "
                           "the standard streams",
                           name, value);
    return STATUS_OK;
}

/* Sets an option. The new text replaces earlier texts of the option, unless the option may be given
 * several times. */
static Status set(corcast_options *options, const Option *option, const char *value, Err *err)
{
    OptionTexts *texts = &options->texts;
    char *made = NULL;
    if (option->kind == OPTION_FLAG && strcmp(value, "off") == 0)
        return unset(options, option, err);
    if (option_is_path(option))
        TRY(path_check(value, option->name, err));
    TRY(check_no_stream(option->name, value, err));
    TRY(ARRAY_RESERVE(texts, 1, "options", err));
    TRY(mem_strdup(&made, value, err));
    Status status = options_set(options->parsed, option->name, value, err);
    if (status != STATUS_OK) {
        free(made);
        return status;
    }
    texts->items[texts->n++] = (OptionText){option->name, made};
    if (option->kind != OPTION_VECTORS)
        remove_texts(texts, option->name, texts->n - 1);
    return STATUS_OK;
}

static Status set_templates(corcast_options *options, const char *value, Err *err)
{
    char *made = NULL;
    if (value) {
        TRY(path_check(value, "templates", err));
        TRY(mem_strdup(&made, value, err));
    }
    free(options->templates);
    options->templates = made;
    return STATUS_OK;
}

static Status set_option(corcast_options *options, const char *name, const char *value, Err *err)
{
    const Option *option = NULL;
    TRY(handle_check(options, HANDLE_OPTIONS, "options", err));
    if (name && strcmp(name, "templates") == 0)
        return set_templates(options, value, err);
    TRY(find_option(options, name, &option, err));
    return value ? set(options, option, value, err) : unset(options, option, err);
}

int corcast_options_set(corcast_options *options, const char *name, const char *value,
                        corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, set_option(options, name, value, &call.err));
}

/* ---- reading back ---------------------------------------------------------------------------- */

static Status get_option(corcast_options *options, const char *name, const char **value, Err *err)
{
    const Option *option = NULL;
    TRY(handle_check(options, HANDLE_OPTIONS, "options", err));
    TRY(argument_check(value, "value", err));
    text_release(&options->last_value);
    if (name && strcmp(name, "templates") == 0) {
        *value = options->templates;
        return STATUS_OK;
    }
    TRY(find_option(options, name, &option, err));
    bool is_set = !option->otherwise; /* else the default is words, as "from the tree" */
    for (size_t i = 0; i < options->texts.n && !is_set; i++)
        is_set = strcmp(options->texts.items[i].name, option->name) == 0;
    if (is_set)
        TRY(options_get(options->parsed, name, &options->last_value, err));
    *value = options->last_value.length ? text_chars(&options->last_value) : NULL;
    return STATUS_OK;
}

int corcast_options_get(corcast_options *options, const char *name, const char **value,
                        corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, get_option(options, name, value, &call.err));
}

int corcast_options_callbacks(corcast_options *options, corcast_progress *progress,
                              corcast_message *message, void *user, corcast_error *error)
{
    Call call = call_begin(error);
    Status status = handle_check(options, HANDLE_OPTIONS, "options", &call.err);
    if (status != STATUS_OK)
        return call_end(&call, status);
    options->progress = progress;
    options->message = message;
    options->user = user;
    return call_end(&call, STATUS_OK);
}

void corcast_options_free(corcast_options *options)
{
    if (!handle_is(options, HANDLE_OPTIONS))
        return;
    parsed_free(options->parsed);
    while (options->texts.n > 0)
        remove_text(&options->texts, options->texts.n - 1);
    ARRAY_RELEASE(&options->texts);
    text_release(&options->last_value);
    free(options->templates);
    handle_free(options);
}
