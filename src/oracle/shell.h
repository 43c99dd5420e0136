/* Fills in and runs shell commands that the user specifies. */
#ifndef CORCAST_ORACLE_SHELL_H
#define CORCAST_ORACLE_SHELL_H

#include "base/base.h"
#include <sys/types.h>

/* `mark` is a placeholder in a command, such as "{scene}", and `text` replaces it. Both are
 * borrowed. */
typedef struct ShellMark {
    const char *mark, *text;
    bool is_words; /* `text` is shell code and is inserted as it is; false: it is quoted as one
                    * word */
} ShellMark;

/* Appends `command` with all placeholders replaced. If `command` does not contain marks[0].mark,
 * also appends the texts of marks[0] to marks[appended - 1], each after a blank. If memory runs
 * out, `out` records it. */
void shell_fill(const char *command, const ShellMark *marks, size_t n, size_t appended, Text *out);

/* Runs a command with sh -c and waits for it. If a signal ends this process, the command and all
 * processes that it started are ended as well.
 *
 * heard        true: the output of the command goes to standard error; false: it is discarded.
 * exit_status  receives the exit status of the command; unchanged if no process can be started.
 * Errors       STATUS_TOOL if no process can be started, or if the exit status is 126 or more: the
 *              shell could not run the command, or a signal ended it. */
MUST_CHECK Status shell_run(const char *command, bool heard, int *exit_status, Err *err);

/* Starts a command with sh -c as a process group. If a signal ends this process, the process group
 * is killed. The caller must wait for *child and then call file_spare_on_signal [base/file.h],
 * which cancels this.
 *
 * output  file descriptor that receives the output of the command; -1: the output is discarded.
 * Errors  STATUS_TOOL if no process can be started. */
MUST_CHECK Status shell_start(const char *command, int output, pid_t *child, Err *err);
/* Returns the exit status in `ended`, a status from waitpid; 127 if a signal ended the command. */
int shell_exit_status(int ended);

#endif
