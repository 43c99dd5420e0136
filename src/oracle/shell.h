/* Runs commands of the user through the shell. */
#ifndef CORCAST_ORACLE_SHELL_H
#define CORCAST_ORACLE_SHELL_H

#include "base/base.h"

/* Appends `command`, with each `mark` ("{}") replaced by `path` as a word of the shell. Returns the
 * number of marks. */
size_t shell_fill(const char *command, const char *mark, const char *path, Text *out);

/* Runs a command with sh -c and waits for it. The command, and everything that it starts, is ended
 * by a signal that ends this process.
 *
 * heard        true: its output goes to standard error; false: its output is dropped.
 * exit_status  receives its exit status.
 * Errors       STATUS_TOOL if the command cannot be run, or is ended by a signal. */
MUST_CHECK Status shell_run(const char *command, bool heard, int *exit_status, Err *err);

#endif
