/* The subcommands: what each is called, and what runs it. */
#ifndef CORCAST_CLI_COMMANDS_H
#define CORCAST_CLI_COMMANDS_H

#include "job/job.h"

extern const Command command_study, command_view, command_models, command_fields, command_looks,
    command_presets, command_colormaps, command_domains, command_formats, command_morphometries,
    command_help, command_version;

/* Works and prints; `options` are parsed->options. Errors are the command's. */
typedef Status RunCommand(void *options, Parsed *parsed, Err *err);

RunCommand run_tree_maker, run_study, run_info, run_certify, run_render, run_povray, run_merge,
    run_figure, run_view, run_verify, run_compare, run_report, run_power, run_check_figure,
    run_models, run_list, run_colormaps, run_help, run_version;

typedef struct CommandRow {
    const Command *command;
    RunCommand *run;
} CommandRow;

/* All commands in the order of the help; one without a command ends them. */
extern const CommandRow command_rows[];

/* Finds the command of this name; NULL when there is none. */
const Command *command_find(const char *name);
/* STATUS_USAGE for a name that no command has, with one that may have been meant. */
Status command_unknown(const char *name, Err *err);

/* Reads the arguments after the command's name, and runs the command. Errors are those of
 * options_parse and of the command. */
MUST_CHECK Status command_run(const Command *command, int argc, char **argv, Err *err);

#endif
