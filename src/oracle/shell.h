/* Runs commands of the user through the shell. */
#ifndef CORCAST_ORACLE_SHELL_H
#define CORCAST_ORACLE_SHELL_H

#include "base/base.h"

/* A mark of a command, such as "{scene}", and what replaces it. Borrowed. */
typedef struct ShellMark {
    const char *mark, *text;
    bool is_words; /* `text` is several words of the shell; false: one word, which is quoted */
} ShellMark;

/* Appends `command` with all marks replaced. If the first mark is missing in `command`, the texts
 * of the first `appended` marks are appended. */
void shell_fill(const char *command, const ShellMark *marks, size_t n, size_t appended, Text *out);

/* How a command ended. */
typedef struct ShellEnd {
    int exit_status; /* 127 if a signal ended it */
    bool timed_out;  /* it was killed, because it took too long */
} ShellEnd;

/* Runs a command with sh -c and waits for it. The command, and everything that it starts, is ended
 * by a signal that ends this process.
 *
 * heard        true: its output goes to standard error; false: its output is dropped.
 * exit_status  receives its exit status.
 * Errors       STATUS_TOOL if the command cannot be run, or is ended by a signal. */
MUST_CHECK Status shell_run(const char *command, bool heard, int *exit_status, Err *err);

/* A command of shell_run_all. The strings are borrowed. */
typedef struct ShellCommand {
    const char *command;
    const char *log; /* path of the file that receives what the command prints */
    ShellEnd end;    /* how it ended; set by shell_run_all */
} ShellCommand;

/* Runs commands with sh -c, at most `jobs` (1 to 32) at the same time, and waits for them. A
 * command that runs longer than `seconds` is killed, with everything that it started. A signal that
 * ends this process kills all commands.
 *
 * Errors  STATUS_TOOL if no process can be started. Commands that fail are no error. */
MUST_CHECK Status shell_run_all(ShellCommand *commands, size_t n, int jobs, double seconds,
                                Err *err);

#endif
