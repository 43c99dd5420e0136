/* The command is a process group, so that a signal can end all of it. */
#include "oracle/shell.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

size_t shell_fill(const char *command, const char *mark, const char *path, Text *out)
{
    size_t n = 0;
    for (const char *next; (next = strstr(command, mark)); command = next + strlen(mark), n++) {
        text_append(out, command, (size_t)(next - command));
        text_put_shell_word(out, path);
    }
    text_puts(out, command);
    return n;
}

static void become_command(const char *command, bool heard)
{
    int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
    setpgid(0, 0);
    dup2(nothing, STDIN_FILENO);
    dup2(heard ? STDERR_FILENO : nothing, STDOUT_FILENO);
    if (!heard)
        dup2(nothing, STDERR_FILENO);
    execl("/bin/sh", "sh", "-c", command, (char *)NULL);
    _exit(127);
}

Status shell_run(const char *command, bool heard, int *exit_status, Err *err)
{
    int ended = 0;
    pid_t child = fork();
    if (child == 0)
        become_command(command, heard);
    if (child < 0)
        return err_set(err, STATUS_TOOL, "a shell cannot be started: %s", strerror(errno));
    setpgid(child, child); /* in both processes, because either may run first */
    file_kill_on_signal(child);
    while (waitpid(child, &ended, 0) < 0 && errno == EINTR)
        ;
    file_spare_on_signal(child);
    *exit_status = WIFEXITED(ended) ? WEXITSTATUS(ended) : 127;
    if (*exit_status < 126)
        return STATUS_OK;
    return err_set(err, STATUS_TOOL, "the command could not be run, or a signal ended it: %s",
                   command);
}
