/* Commands of the user's, run by the shell. */
#ifndef CORCAST_ORACLE_SHELL_H
#define CORCAST_ORACLE_SHELL_H

#include "base/base.h"

/* Appends `command` with `path`, as a word of the shell, for every `mark` ("{}"); how many there
 * are. */
size_t shell_fill(const char *command, const char *mark, const char *path, Text *out);

/* Runs a command by sh -c and waits for it. What it prints goes to standard error where it is
 * `heard`, else nowhere. A signal that ends this process ends it and all that it has started.
 * STATUS_TOOL when it cannot be started, or is ended by a signal. */
MUST_CHECK Status shell_run(const char *command, bool heard, int *exit_status, Err *err);

#endif
