/* Runs commands of the user through the shell. */
#ifndef CORCAST_ORACLE_SHELL_H
#define CORCAST_ORACLE_SHELL_H

#include "base/base.h"
#include <sys/types.h>

/* A mark of a command, such as "{scene}", and what replaces it. Borrowed. */
typedef struct ShellMark {
    const char *mark, *text;
    bool is_words; /* `text` is several words of the shell; false: one word, which is quoted */
} ShellMark;

/* Appends `command` with all marks replaced. If the first mark is missing in `command`, the texts
 * of the first `appended` marks are appended. */
void shell_fill(const char *command, const ShellMark *marks, size_t n, size_t appended, Text *out);

/* Runs a command with sh -c and waits for it. The command, and everything that it starts, is ended
 * by a signal that ends this process.
 *
 * heard        true: its output goes to standard error; false: its output is dropped.
 * exit_status  receives its exit status.
 * Errors       STATUS_TOOL if the command cannot be run, or is ended by a signal. */
MUST_CHECK Status shell_run(const char *command, bool heard, int *exit_status, Err *err);

/* Starts a command with sh -c, as a process group that a signal that ends this process kills. The
 * caller waits for *child and calls file_spare_on_signal.
 *
 * output  file descriptor that receives its output; -1: its output is dropped.
 * Errors  STATUS_TOOL if no process can be started. */
MUST_CHECK Status shell_start(const char *command, int output, pid_t *child, Err *err);
/* Returns the exit status of what waitpid reports; 127 if a signal ended the command. */
int shell_exit_status(int ended);

#endif
