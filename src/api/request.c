/* Opens and closes the request of an operation: the parsed command line that its job runs with. An
 * operation makes a Parsed of its own, because jobs change their Parsed. The caller's options are
 * therefore unchanged and can be used for any number of operations. */
#include "api/request.h"

#include "job/job.h"
#include "options/output.h"
#include "options/templates.h"
#include <stdlib.h>
#include <string.h>

const Command *request_find_command(const char *name)
{
    for (const Command *const *command = job_commands; *command; command++)
        if (strcmp((*command)->name, name) == 0)
            return *command;
    return NULL;
}

/* ---- callbacks ------------------------------------------------------------------------------- */

static void say(void *user, TalkKind kind, const char *sentence)
{
    const Request *request = user;
    if (!request->message || (kind == TALK_NOTE && request->parsed.common.quiet))
        return;
    locale_t own = callback_begin(request->caller_locale);
    request->message(request->user, kind == TALK_WARNING, sentence);
    callback_end(own);
}

static bool show_progress(void *user, const char *what, double fraction)
{
    const Request *request = user;
    if (!request->progress)
        return true;
    locale_t own = callback_begin(request->caller_locale);
    int stop = request->progress(request->user, what, fraction);
    callback_end(own);
    return stop == 0;
}

/* ---- opening --------------------------------------------------------------------------------- */

/* Finds the command of the caller's options; without options, the first of the operation. */
static Status find_command(const RequestArguments *arguments, const Command **command, Err *err)
{
    char first[32];
    snprintf(first, sizeof first, "%.*s", (int)strcspn(arguments->commands, " "),
             arguments->commands);
    *command = request_find_command(first);
    if (!arguments->options && !arguments->needs_options)
        return STATUS_OK;
    TRY(handle_check(arguments->options, HANDLE_OPTIONS, "options", err));
    *command = arguments->options->command;
    if (wordlist_has(arguments->commands, (*command)->name))
        return STATUS_OK;
    return err_set(err, STATUS_USAGE,
                   "the options belong to the command %s; this operation takes options of: %s",
                   (*command)->name, arguments->commands);
}

/* Sets the caller's options in `parsed`. arguments->output replaces the option output. */
static Status set_options(Parsed *parsed, const RequestArguments *arguments, Err *err)
{
    for (size_t i = 0; arguments->options && i < arguments->options->texts.n; i++) {
        const OptionText *text = &arguments->options->texts.items[i];
        if (strcmp(text->name, "output") != 0)
            TRY(options_set(parsed, text->name, text->value, err));
    }
    if (!arguments->output)
        return STATUS_OK;
    if (parsed->command->writes_last) {
        parsed->operands[parsed->n_operands++] = arguments->output;
        return STATUS_OK;
    }
    return parsed_find(parsed, "output", strlen("output"))
               ? options_set(parsed, "output", arguments->output, err)
               : STATUS_OK;
}

/* Copies the callbacks and the folder of templates from the caller's options. */
static Status take_surroundings(Request *request, const corcast_options *options, Err *err)
{
    request->talk = (Talk){.say = say, .progress = show_progress, .user = request};
    request->parsed.common.talk = &request->talk;
    if (!options)
        return STATUS_OK;
    request->progress = options->progress;
    request->message = options->message;
    request->user = options->user;
    if (options->templates)
        TRY(mem_strdup(&request->templates, options->templates, err));
    (void)templates_set(request->templates);
    return STATUS_OK;
}

/* Sets the operand: a file that the caller names, or the caller's tree. */
static Status give_operand(Request *request, const RequestArguments *arguments, Err *err)
{
    Parsed *parsed = &request->parsed;
    if (arguments->operand) {
        TRY(mem_strdup(&request->name, arguments->operand, err));
        parsed->operands[parsed->n_operands++] = request->name;
    }
    if (!arguments->tree)
        return STATUS_OK;
    if (arguments->tree->name)
        TRY(mem_strdup(&request->name, arguments->tree->name, err));
    parsed_give(parsed, &arguments->tree->tree, request->name);
    return STATUS_OK;
}

Status request_open(Request *request, const RequestArguments *arguments, const Call *call, Err *err)
{
    const Command *command = NULL;
    *request = (Request){.caller_locale = call->caller_locale};
    TRY(find_command(arguments, &command, err));
    TRY(parsed_init(&request->parsed, command, err));
    request->parsed.find_command = request_find_command;
    request->parsed.in_memory = arguments->output == NULL;
    TRY(take_surroundings(request, arguments->options, err));
    TRY(give_operand(request, arguments, err));
    TRY(set_options(&request->parsed, arguments, err));
    return options_finish(&request->parsed, err);
}

Status request_close(Request *request, Status status, Err *err)
{
    if (status != STATUS_OK && status != STATUS_DIFFERS && request->parsed.settings)
        options_name_fields(&request->parsed, err);
    parsed_release(&request->parsed);
    free(request->name);
    free(request->templates);
    return status;
}
