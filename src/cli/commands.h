/* The table of commands: "grow", "render" and all others.
 *
 * A Command (options/options.h) describes a command and its options. A CommandRow adds the function
 * that runs the command, and where the help lists it. To add a command, declare its Command and its
 * RunCommand here, add a row to command_rows, and define both, usually in cli/command/cmd_NAME.c:
 *
 *     const Command *command = command_find("grow");
 *     Status status = command ? command_run(command, argc - 2, argv + 2, &err)
 *                             : command_unknown("grow", &err); */
#ifndef CORCAST_CLI_COMMANDS_H
#define CORCAST_CLI_COMMANDS_H

#include "job/job.h"

extern const Command command_study, command_view, command_models, command_fields, command_looks,
    command_presets, command_colormaps, command_domains, command_formats, command_morphometries,
    command_waveforms, command_walls, command_help, command_version;

/* Runs a command: reads its input, writes its files, and prints its result to standard output.
 *
 * options  parsed->options: the struct that the options of the command set.
 * Errors   of the command. */
typedef Status RunCommand(void *options, Parsed *parsed, Err *err);

RunCommand run_tree_maker, run_study, run_info, run_coverage, run_flow, run_certify, run_pulse,
    run_render, run_povray, run_merge, run_figure, run_view, run_verify, run_compare, run_report,
    run_power, run_check_figure, run_models, run_list, run_colormaps, run_help, run_version,
    run_answer, run_metamorph, run_suite;

/* The headings of `corcast --help`, in its order. Each command is under one of them. */
typedef enum CommandGroup {
    COMMANDS_GROW,
    COMMANDS_DRAW,
    COMMANDS_EXPORT,
    COMMANDS_CHECK,
    COMMANDS_LIST,
    COMMANDS_HELP,
    COMMAND_GROUPS
} CommandGroup;

/* The text of each heading. */
extern const char *const command_group_names[COMMAND_GROUPS];

/* The common options that a command obeys, as bits. Every command accepts all common options; its
 * help shows only those that have an effect. All commands obey --help. */
typedef enum ObeyedOptions {
    OBEYS_RUN = 1 << 0,     /* --recipe, --dump-recipe, --quiet */
    OBEYS_THREADS = 1 << 1, /* --threads */
    OBEYS_SEED = 1 << 2     /* --seed */
} ObeyedOptions;

typedef struct CommandRow {
    const Command *command;
    RunCommand *run;
    CommandGroup group;
    unsigned obeys; /* a set of ObeyedOptions */
} CommandRow;

/* All commands in the order of the help, sorted by group. A row without a command ends the
 * table. */
extern const CommandRow command_rows[];

/* Returns the command with this name; NULL if there is none. */
const Command *command_find(const char *name);

/* Returns true if the option has an effect on the command of `parsed`. False only for common
 * options that the command does not obey. */
bool command_obeys(const Parsed *parsed, const Setting *setting);

/* Returns STATUS_USAGE with a sentence about the unknown name. The sentence suggests the most
 * similar command, if one is similar. */
Status command_unknown(const char *name, Err *err);

/* Parses the arguments and runs the command. Prints the recipe of --dump-recipe, or the help of
 * --help instead of running the command.
 *
 * argc, argv  the arguments after the command's name.
 * Errors      of options_parse and of the command. STATUS_USAGE if --dump-recipe is given without
 *             an output file. */
MUST_CHECK Status command_run(const Command *command, int argc, char **argv, Err *err);

/* Prints *text on standard output if `status` is STATUS_OK, and releases *text in any case.
 *
 * Returns  `status` if it is an error, else the result of text_check. */
MUST_CHECK Status command_print(Status status, Text *text, Err *err);

#endif
