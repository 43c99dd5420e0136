/* Lists the commands of the program in a table, and runs a command. All commands have in common:
 * the templates folder, progress and messages on the screen, --help and --dump-recipe. */
#include "cli/commands.h"

#include "cli/help.h"
#include "cli/screen.h"
#include "job/export/export.h"
#include "job/export/scene.h"
#include "job/picture/convert.h"
#include "job/picture/diagram.h"
#include "options/output.h"
#include "options/templates.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const command_group_names[COMMAND_GROUPS] = {
    [COMMANDS_GROW] = "Grow and measure",         [COMMANDS_DRAW] = "Draw",
    [COMMANDS_EXPORT] = "Convert and export",     [COMMANDS_CHECK] = "Check",
    [COMMANDS_LIST] = "List what options accept", [COMMANDS_HELP] = "Help",
};

/* The bits of most commands. */
enum { OBEYS_ALL = OBEYS_RUN | OBEYS_THREADS | OBEYS_SEED, OBEYS_MOST = OBEYS_RUN | OBEYS_THREADS };

const CommandRow command_rows[] = {
    {&command_grow, run_tree_maker, COMMANDS_GROW, OBEYS_ALL},
    {&command_info, run_info, COMMANDS_GROW, OBEYS_RUN},
    {&command_coverage, run_coverage, COMMANDS_GROW, OBEYS_MOST},
    {&command_flow, run_flow, COMMANDS_GROW, OBEYS_ALL},
    {&command_refine, run_tree_maker, COMMANDS_GROW, OBEYS_ALL},
    {&command_bifurcation, run_tree_maker, COMMANDS_GROW, OBEYS_RUN},
    {&command_study, run_study, COMMANDS_GROW, OBEYS_MOST},
    {&command_certify, run_certify, COMMANDS_GROW, OBEYS_RUN},
    {&command_pulse, run_pulse, COMMANDS_GROW, OBEYS_MOST},
    {&command_render, run_render, COMMANDS_DRAW, OBEYS_MOST},
    {&command_view, run_view, COMMANDS_DRAW, OBEYS_MOST},
    {&command_figure, run_figure, COMMANDS_DRAW, OBEYS_MOST},
    {&command_diagram, diagram_run, COMMANDS_DRAW, OBEYS_MOST},
    {&command_povray, run_povray, COMMANDS_DRAW, OBEYS_MOST},
    {&command_merge, run_merge, COMMANDS_DRAW, OBEYS_MOST},
    {&command_convert, convert_run, COMMANDS_EXPORT, OBEYS_MOST},
    {&command_export, export_run, COMMANDS_EXPORT, OBEYS_MOST},
    {&command_scene, scene_run, COMMANDS_EXPORT, OBEYS_MOST},
    {&command_verify, run_verify, COMMANDS_CHECK, OBEYS_MOST},
    {&command_answer, run_answer, COMMANDS_CHECK, OBEYS_MOST},
    {&command_compare, run_compare, COMMANDS_CHECK, OBEYS_MOST},
    {&command_report, run_report, COMMANDS_CHECK, OBEYS_RUN},
    {&command_power, run_power, COMMANDS_CHECK, OBEYS_MOST},
    {&command_suite, run_suite, COMMANDS_CHECK, OBEYS_MOST},
    {&command_metamorph, run_metamorph, COMMANDS_CHECK, OBEYS_ALL},
    {&command_check_figure, run_check_figure, COMMANDS_CHECK, OBEYS_RUN},
    {&command_models, run_models, COMMANDS_LIST, 0},
    {&command_fields, run_list, COMMANDS_LIST, 0},
    {&command_looks, run_list, COMMANDS_LIST, 0},
    {&command_colormaps, run_colormaps, COMMANDS_LIST, 0},
    {&command_domains, run_list, COMMANDS_LIST, 0},
    {&command_formats, run_list, COMMANDS_LIST, 0},
    {&command_presets, run_list, COMMANDS_LIST, 0},
    {&command_morphometries, run_list, COMMANDS_LIST, 0},
    {&command_waveforms, run_list, COMMANDS_LIST, 0},
    {&command_walls, run_list, COMMANDS_LIST, 0},
    {&command_help, run_help, COMMANDS_HELP, 0},
    {&command_version, run_version, COMMANDS_HELP, 0},
    {0},
};

/* Returns the row of the command with this name, or the row without a command that ends the
 * table. */
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

bool command_obeys(const Parsed *parsed, const Setting *setting)
{
    static const char *const run_options[] = {"recipe", "dump-recipe", "quiet", NULL};
    const unsigned obeys = find_row(parsed->command->name)->obeys;
    const char *name = setting->option->name;
    if (!setting_is_common(parsed, setting) || strcmp(name, "help") == 0)
        return true;
    if (strcmp(name, "dump-recipe") == 0 && !parsed_find(parsed, "output", strlen("output")))
        return false; /* check_dump refuses it */
    if (is_one_of(name, run_options))
        return obeys & OBEYS_RUN;
    return obeys & (strcmp(name, "seed") == 0 ? OBEYS_SEED : OBEYS_THREADS);
}

Status command_unknown(const char *name, Err *err)
{
    Suggestion suggestion = suggestion_start(name, strlen(name));
    for (const CommandRow *row = command_rows; row->command; row++)
        suggestion_offer(&suggestion, row->command->name);
    Status status =
        err_set(err, STATUS_USAGE, "unknown command '%s'; corcast --help lists all commands", name);
    suggestion_append(&suggestion, "", err);
    return status;
}

Status command_print(Status status, Text *text, Err *err)
{
    if (status == STATUS_OK)
        status = text_check(text, err);
    if (status == STATUS_OK)
        fputs(text_chars(text), stdout);
    text_release(text);
    return status;
}

/* Returns STATUS_USAGE if the recipe would be printed into the output on standard output. */
static Status check_dump(const Parsed *parsed, Err *err)
{
    const char *path = parsed_text(parsed, "output");
    if (!parsed->common.dump || (path && strcmp(path, "-") != 0))
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "--dump-recipe prints a recipe, so it needs -o FILE");
}

/* Runs the command, or prints its help. */
static Status run(Parsed *parsed, Err *err)
{
    const Command *command = parsed->command;
    RunCommand *run_command = find_row(command->name)->run;
    if (parsed->common.help)
        return help_print(command, err);
    TRY(check_dump(parsed, err));
    if (!parsed->common.dump || command->own_recipe)
        return run_command(parsed->options, parsed, err);
    /* The recipe is made first, so that no error can follow after the output has been written. */
    Text recipe = TEXT_INIT;
    options_put_recipe(parsed, &recipe);
    Status status = text_check(&recipe, err);
    if (status == STATUS_OK)
        status = run_command(parsed->options, parsed, err);
    return command_print(status, &recipe, err);
}

/* The library reads no environment, so these variables are read here. */
static Status read_environment(Err *err)
{
    const char *date = getenv("SOURCE_DATE_EPOCH");
    (void)templates_set(getenv("CORCAST_TEMPLATES"));
    if (clock_set_date(date && *date ? date : NULL))
        return STATUS_OK;
    return err_set(err, STATUS_USAGE,
                   "SOURCE_DATE_EPOCH is '%s'; it must be the seconds since 1970-01-01 UTC as an "
                   "integer from 0 to 253402300799",
                   date);
}

Status command_run(const Command *command, int argc, char **argv, Err *err)
{
    Parsed parsed;
    TRY(read_environment(err));
    TRY(parsed_init(&parsed, command, err));
    parsed.find_command = command_find;
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
