/* The subcommands. */
#ifndef CORCAST_APP_COMMANDS_H
#define CORCAST_APP_COMMANDS_H

#include "app/run/options.h"

extern const Command command_grow, command_refine, command_info, command_convert, command_scene,
    command_export, command_povray, command_render, command_view, command_verify, command_compare,
    command_report, command_power, command_models, command_fields, command_looks, command_colormaps,
    command_domains, command_formats, command_morphometries, command_diagram, command_figure,
    command_merge, command_study, command_certify, command_bifurcation, command_check_figure,
    command_presets, command_help, command_version;

/* In the order of the help; NULL ends them. */
extern const Command *const all_commands[];
/* NULL when no command has this name. */
const Command *command_find(const char *name);
/* Reads the arguments after the command's name and runs it. Errors are options_parse's and its own.
 */
MUST_CHECK Status command_run(const Command *command, int argc, char **argv, Err *err);
/* STATUS_USAGE for a name that no command has, with one that may have been meant. */
Status command_unknown(const char *name, Err *err);

#endif
