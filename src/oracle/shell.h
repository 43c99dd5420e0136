/* Runs shell commands that the user specifies. */
#ifndef CORCAST_ORACLE_SHELL_H
#define CORCAST_ORACLE_SHELL_H

#include "base/base.h"

/* A placeholder in a command, such as "{scene}", and the text that replaces it. Both are
 * borrowed. */
typedef struct ShellMark {
    const char *mark, *text;
    bool is_words; /* `text` is shell code and is inserted as it is; false: it is quoted as one
                    * word */
} ShellMark;

/* Appends `command` with all placeholders replaced. If `command` does not contain the first
 * placeholder, also appends the texts of the first `appended` placeholders. */
void shell_fill(const char *command, const ShellMark *marks, size_t n, size_t appended, Text *out);

/* How a command ended. */
typedef struct ShellEnd {
    int exit_status; /* 127 if a signal ended it */
    bool timed_out;  /* it was killed because it exceeded the time limit */
} ShellEnd;

/* Runs a command with sh -c and waits for it. If a signal ends this process, the command and all
 * processes that it started are ended as well.
 *
 * heard        true: the output of the command goes to standard error; false: it is discarded.
 * exit_status  receives the exit status of the command.
 * Errors       STATUS_TOOL if the command cannot be run, or is ended by a signal. */
MUST_CHECK Status shell_run(const char *command, bool heard, int *exit_status, Err *err);

/* A command of shell_run_all. The strings are borrowed. */
typedef struct ShellCommand {
    const char *command;
    const char *log; /* path of the file that receives the output of the command */
    ShellEnd end;    /* set by shell_run_all */
} ShellCommand;

/* Runs commands with sh -c, at most `jobs` (1 to 32) at the same time, and waits for them. A
 * command that runs longer than `seconds` is killed with all processes that it started. If a signal
 * ends this process, all commands are killed.
 *
 * Errors  STATUS_TOOL if no process can be started. A command that fails is not an error. */
MUST_CHECK Status shell_run_all(ShellCommand *commands, size_t n, int jobs, double seconds,
                                Err *err);

#endif
