/* The command is a process group, so that a signal can end all of it. */
#include "oracle/shell.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
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

/* Runs `command` in this process. Its output goes to the file descriptor `output`; -1: it is
 * dropped. */
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

static int exit_status_of(int ended)
{
    return WIFEXITED(ended) ? WEXITSTATUS(ended) : 127;
}

Status shell_run(const char *command, bool heard, int *exit_status, Err *err)
{
    int ended = 0;
    pid_t child = fork();
    if (child == 0)
        become_command(command, heard ? STDERR_FILENO : -1);
    if (child < 0)
        return err_set(err, STATUS_TOOL, "a shell cannot be started: %s", strerror(errno));
    setpgid(child, child); /* in both processes, because either may run first */
    file_kill_on_signal(child);
    while (waitpid(child, &ended, 0) < 0 && errno == EINTR)
        ;
    file_spare_on_signal(child);
    *exit_status = exit_status_of(ended);
    if (*exit_status < 126)
        return STATUS_OK;
    return err_set(err, STATUS_TOOL, "the command could not be run, or a signal ended it: %s",
                   command);
}

/* ---- several commands ------------------------------------------------------------------------ */

enum { MAX_JOBS = 32 };

/* A running command. */
typedef struct ShellJob {
    pid_t child; /* 0: none */
    double start_s;
    ShellCommand *command;
} ShellJob;

static Status start_job(ShellJob *job, ShellCommand *command, Err *err)
{
    pid_t child = fork();
    if (child == 0) {
        const int log = open(command->log, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
        become_command(command->command, log);
    }
    if (child < 0)
        return err_set(err, STATUS_TOOL, "a shell cannot be started: %s", strerror(errno));
    setpgid(child, child);
    file_kill_on_signal(child);
    *job = (ShellJob){child, clock_seconds(), command};
    command->end = (ShellEnd){0};
    return STATUS_OK;
}

/* Takes the end of a job, if it has ended or is too old. Returns false if it goes on. */
static bool end_job(ShellJob *job, double seconds)
{
    int ended = 0;
    const bool too_old = clock_seconds() - job->start_s > seconds;
    if (too_old)
        kill(-job->child, SIGKILL);
    const pid_t done = waitpid(job->child, &ended, too_old ? 0 : WNOHANG);
    if (done == 0 || (done < 0 && errno == EINTR))
        return false;
    kill(-job->child, SIGKILL); /* what the command left running */
    file_spare_on_signal(job->child);
    job->command->end = (ShellEnd){exit_status_of(ended), too_old};
    job->child = 0;
    return true;
}

Status shell_run_all(ShellCommand *commands, size_t n, int jobs, double seconds, Err *err)
{
    static const struct timespec pause = {0, 500000};
    ShellJob running[MAX_JOBS] = {{0}};
    Status status = STATUS_OK;
    size_t next = 0, ended = 0;
    while (ended < (status == STATUS_OK ? n : next)) {
        bool idle = true;
        for (int i = 0; i < jobs; i++) {
            if (!running[i].child && next < n && status == STATUS_OK) {
                status = start_job(&running[i], &commands[next], err);
                next += status == STATUS_OK;
                idle = false;
            } else if (running[i].child && end_job(&running[i], seconds)) {
                ended++;
                idle = false;
            }
        }
        if (idle)
            nanosleep(&pause, NULL);
    }
    return status;
}
