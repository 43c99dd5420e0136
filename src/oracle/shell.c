/* Fills and runs shell commands. Each command runs in a process group of its own. A signal to the
 * group ends the command and all processes that it started. */
#include "oracle/shell.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static void put_mark(const ShellMark *mark, Text *out)
{
    if (mark->is_words)
        text_puts(out, mark->text);
    else
        text_put_shell_word(out, mark->text);
}

void shell_fill(const char *command, const ShellMark *marks, size_t n, size_t appended, Text *out)
{
    const bool has_marks = strstr(command, marks[0].mark) != NULL;
    for (const char *at = command; *at;) {
        size_t i = 0;
        while (i < n && strncmp(at, marks[i].mark, strlen(marks[i].mark)) != 0)
            i++;
        if (i < n)
            put_mark(&marks[i], out);
        else
            text_append(out, at, 1);
        at += i < n ? strlen(marks[i].mark) : 1;
    }
    for (size_t i = 0; i < appended && !has_marks; i++) {
        text_puts(out, " ");
        put_mark(&marks[i], out);
    }
}

/* Replaces this process, a child, by the command. The output goes to the file descriptor `output`;
 * -1: it is discarded. */
static void become_command(const char *command, int output)
{
    int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
    setpgid(0, 0);
    dup2(nothing, STDIN_FILENO);
    dup2(output >= 0 ? output : nothing, STDOUT_FILENO);
    dup2(output >= 0 ? output : nothing, STDERR_FILENO);
    execl("/bin/sh", "sh", "-c", command, (char *)NULL);
    _exit(127);
}

int shell_exit_status(int ended)
{
    return WIFEXITED(ended) ? WEXITSTATUS(ended) : 127;
}

Status shell_start(const char *command, int output, pid_t *child, Err *err)
{
    *child = fork();
    if (*child == 0)
        become_command(command, output);
    if (*child < 0)
        return err_set(err, STATUS_TOOL, "a shell cannot be started: %s", strerror(errno));
    setpgid(*child, *child); /* in both processes, because either may run first */
    file_kill_on_signal(*child);
    return STATUS_OK;
}

Status shell_run(const char *command, bool heard, int *exit_status, Err *err)
{
    int ended = 0;
    pid_t child;
    TRY(shell_start(command, heard ? STDERR_FILENO : -1, &child, err));
    while (waitpid(child, &ended, 0) < 0 && errno == EINTR)
        ;
    file_spare_on_signal(child);
    *exit_status = shell_exit_status(ended);
    if (*exit_status < 126) /* 126 and above: the shell could not run it, or a signal ended it */
        return STATUS_OK;
    return err_set(err, STATUS_TOOL, "the command could not be run, or a signal ended it: %s",
                   command);
}
