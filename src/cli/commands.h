/* The table of the commands of the program corcast: "grow", "render" and all others.
 *
 * A Command [options/options.h] describes a command and its options. A CommandRow adds the function
 * that runs the command, and the heading under which the help lists it. To add a command, declare
 * its RunCommand here, and its Command here or, for an operation of the module job, in the
 * operation's header. Then add a row to command_rows, and define both, usually in
 * cli/command/cmd_NAME.c:
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

/* Runs a command after options_finish: reads its input, writes its files, and prints its result to
 * standard output.
 *
 * options  parsed->options: the struct that the options of the command set.
 * Errors   depend on the command; STATUS_DIFFERS if a comparison finds a difference. */
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

/* A bit for each group of common options that can have an effect on a command. Every command
 * accepts all common options, but its help shows only those with an effect. --help has an effect on
 * all commands. */
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

/* All commands in the order of the help, sorted by group. The last row has the command NULL. */
extern const CommandRow command_rows[];

/* Returns the command with this name; NULL if there is none. */
const Command *command_find(const char *name);

/* Returns true if the option has an effect on the command of `parsed`. It is false only for common
 * options whose bit is not in CommandRow.obeys. */
bool command_obeys(const Parsed *parsed, const Setting *setting);

/* Returns STATUS_USAGE, with a sentence that `name` is unknown. The sentence suggests the most
 * similar command, if a similar one exists. */
Status command_unknown(const char *name, Err *err);

/* Parses the arguments and runs the command. With --help, prints the help instead of running the
 * command. With --dump-recipe, also prints the recipe.
 *
 * argc, argv  the arguments after the command's name.
 * Errors      the errors of options_parse and of the command; STATUS_USAGE if --dump-recipe is
 *             given without an output file. */
MUST_CHECK Status command_run(const Command *command, int argc, char **argv, Err *err);

/* Prints *text on standard output if `status` is STATUS_OK. Releases *text in any case.
 *
 * Returns  `status` if it is not STATUS_OK, else STATUS_MEMORY if *text has failed, else STATUS_OK.
 */
MUST_CHECK Status command_print(Status status, Text *text, Err *err);

#endif
