/* The commands there are, in the order of the help. A new one is its row here, its declaration, and
 * a file cmd_NAME.c. */
#include "cli/commands.h"
#include "cli/screen.h"

#include "cli/help.h"
#include <stdio.h>
#include <string.h>

const Command *const all_commands[] = {
    &command_grow,
    &command_refine,
    &command_bifurcation,
    &command_study,
    &command_info,
    &command_certify,
    &command_convert,
    &command_scene,
    &command_export,
    &command_povray,
    &command_render,
    &command_merge,
    &command_diagram,
    &command_figure,
    &command_view,
    &command_verify,
    &command_compare,
    &command_report,
    &command_power,
    &command_check_figure,
    &command_models,
    &command_fields,
    &command_looks,
    &command_presets,
    &command_colormaps,
    &command_domains,
    &command_formats,
    &command_morphometries,
    &command_help,
    &command_version,
    NULL,
};

const Command *command_find(const char *name)
{
    for (const Command *const *command = all_commands; *command; command++)
        if (strcmp((*command)->name, name) == 0)
            return *command;
    return NULL;
}

Status command_unknown(const char *name, Err *err)
{
    Suggestion suggestion = suggestion_for(name, strlen(name));
    for (const Command *const *command = all_commands; *command; command++)
        suggestion_offer(&suggestion, (*command)->name);
    Status status = err_set(err, STATUS_USAGE,
                            "unknown command '%s'; corcast --help lists those there are", name);
    suggestion_add(&suggestion, "", err);
    return status;
}

/* What is printed may be what is written, too. */
static Status check_dump(const Parsed *parsed, Err *err)
{
    const Setting *output = parsed_find(parsed, "output", strlen("output"));
    const char *path = output ? *(const char *const *)(output->base + output->option->where) : NULL;
    if (!parsed->common.dump || (path && strcmp(path, "-") != 0))
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "--dump-recipe prints a recipe, so it needs -o FILE");
}

static Status run(Parsed *parsed, Err *err)
{
    const Command *command = parsed->command;
    if (parsed->common.help)
        return help_print(command, err);
    TRY(check_dump(parsed, err));
    if (!parsed->common.dump || command->own_recipe)
        return command->run(parsed->options, parsed, err);
    Text recipe = TEXT_INIT; /* made first: what is written is not to be followed by a failure */
    options_put_recipe(parsed, &recipe);
    Status status = text_check(&recipe, err);
    if (status == STATUS_OK)
        status = command->run(parsed->options, parsed, err);
    if (status == STATUS_OK)
        fputs(text_chars(&recipe), stdout);
    text_release(&recipe);
    return status;
}

Status command_run(const Command *command, int argc, char **argv, Err *err)
{
    Parsed parsed;
    TRY(parsed_init(&parsed, command, err));
    Screen screen;
    Status status = options_parse(&parsed, argc, argv, err);
    Talk talk = screen_talk(&screen, parsed.common.quiet);
    parsed.common.talk = &talk;
    if (status == STATUS_OK)
        status = run(&parsed, err);
    if (status != STATUS_OK)
        options_name_fields(&parsed, err);
    parsed_release(&parsed);
    return status;
}
