/* The subcommands. */
#ifndef CORCAST_CLI_COMMANDS_H
#define CORCAST_CLI_COMMANDS_H

#include "options/registry.h"

extern const Command command_grow, command_refine, command_info, command_convert, command_scene,
    command_export, command_povray, command_render, command_view, command_verify, command_compare,
    command_report, command_power, command_models, command_fields, command_looks, command_colormaps,
    command_domains, command_formats, command_morphometries, command_diagram, command_figure,
    command_merge, command_study, command_certify, command_bifurcation, command_check_figure,
    command_presets, command_help, command_version;

/* STATUS_USAGE for a name that no command has, with one that may have been meant. */
Status command_unknown(const char *name, Err *err);

#endif
