/* The commands there are. The program that links this module defines them. */
#ifndef CORCAST_OPTIONS_REGISTRY_H
#define CORCAST_OPTIONS_REGISTRY_H

#include "options/options.h"

/* All commands in the order of the help; NULL ends them. */
extern const Command *const all_commands[];

/* Finds the command of this name; NULL when there is none. */
const Command *command_find(const char *name);

/* Reads the arguments after the command's name, and runs the command. Errors are those of
 * options_parse and of the command. */
MUST_CHECK Status command_run(const Command *command, int argc, char **argv, Err *err);

#endif
