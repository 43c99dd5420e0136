/* The commands there are, in the order of the help. A new one is its row here, its declaration, and
 * a file cmd_NAME.c. */
#include "cli/commands.h"

#include "cli/help.h"
#include "cli/screen.h"
#include "job/export/export.h"
#include "job/export/scene.h"
#include "job/picture/convert.h"
#include "job/picture/diagram.h"
#include "options/templates.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const CommandRow command_rows[] = {
    {&command_grow, run_tree_maker},
    {&command_refine, run_tree_maker},
    {&command_bifurcation, run_tree_maker},
    {&command_study, run_study},
    {&command_info, run_info},
    {&command_certify, run_certify},
    {&command_convert, convert_run},
    {&command_scene, scene_run},
    {&command_export, export_run},
    {&command_povray, run_povray},
    {&command_render, run_render},
    {&command_merge, run_merge},
    {&command_diagram, diagram_run},
    {&command_figure, run_figure},
    {&command_view, run_view},
    {&command_verify, run_verify},
    {&command_compare, run_compare},
    {&command_report, run_report},
    {&command_power, run_power},
    {&command_check_figure, run_check_figure},
    {&command_models, run_models},
    {&command_fields, run_list},
    {&command_looks, run_list},
    {&command_presets, run_list},
    {&command_colormaps, run_colormaps},
    {&command_domains, run_list},
    {&command_formats, run_list},
    {&command_morphometries, run_list},
    {&command_help, run_help},
    {&command_version, run_version},
    {0},
};

/* The row of this name; the one that ends the rows when there is none. */
static const CommandRow *find_row(const char *name)
{
    const CommandRow *row = command_rows;
    while (row->command && strcmp(row->command->name, name) != 0)
        row++;
    return row;
}

const Command *command_find(const char *name)
{
    return find_row(name)->command;
}

Status command_unknown(const char *name, Err *err)
{
    Suggestion suggestion = suggestion_for(name, strlen(name));
    for (const CommandRow *row = command_rows; row->command; row++)
        suggestion_offer(&suggestion, row->command->name);
    Status status = err_set(err, STATUS_USAGE,
                            "unknown command '%s'; corcast --help lists those there are", name);
    suggestion_add(&suggestion, "", err);
    return status;
}

/* What is printed may be what is written, too. */
static Status check_dump(const Parsed *parsed, Err *err)
{
    const char *path = parsed_text(parsed, "output");
    if (!parsed->common.dump || (path && strcmp(path, "-") != 0))
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "--dump-recipe prints a recipe, so it needs -o FILE");
}

static Status run(Parsed *parsed, Err *err)
{
    const Command *command = parsed->command;
    RunCommand *run_command = find_row(command->name)->run;
    if (parsed->common.help)
        return help_print(command, err);
    TRY(check_dump(parsed, err));
    if (!parsed->common.dump || command->own_recipe)
        return run_command(parsed->options, parsed, err);
    Text recipe = TEXT_INIT; /* made first: what is written is not to be followed by a failure */
    options_put_recipe(parsed, &recipe);
    Status status = text_check(&recipe, err);
    if (status == STATUS_OK)
        status = run_command(parsed->options, parsed, err);
    if (status == STATUS_OK)
        fputs(text_chars(&recipe), stdout);
    text_release(&recipe);
    return status;
}

Status command_run(const Command *command, int argc, char **argv, Err *err)
{
    Parsed parsed;
    TRY(parsed_init(&parsed, command, err));
    parsed.find_command = command_find;
    (void)templates_set(getenv("CORCAST_TEMPLATES"));
    Screen screen;
    Status status = options_parse(&parsed, argc, argv, err);
    Talk talk = screen_talk(&screen, parsed.common.quiet);
    parsed.common.talk = &talk;
    if (status == STATUS_OK)
        status = run(&parsed, err);
    bool failed = status_exit(status) >= 2 || fflush(stdout) != 0;
    (failed ? screen_drop_held : screen_print_held)(&screen);
    if (status != STATUS_OK)
        options_name_fields(&parsed, err);
    parsed_release(&parsed);
    return status;
}
