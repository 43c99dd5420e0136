/* Runs work in a child process, so that a failed allocation in a library cannot harm the program.
 * The child sends its status and its error sentence first, then the bytes of the result, through a
 * pipe. */
#include "base/isolated.h"

#include "base/memory.h"
#include "base/system.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* The first message of the child. */
typedef struct Report {
    Status status;
    Err err;
    size_t length; /* number of bytes that follow */
} Report;

static bool send_all(int handle, const void *from, size_t size)
{
    for (size_t done = 0; done < size;) {
        ssize_t count = write(handle, (const char *)from + done, size - done);
        if (count < 0 && errno != EINTR)
            return false;
        done += count > 0 ? (size_t)count : 0;
    }
    return true;
}

static bool receive(int handle, void *to, size_t size)
{
    for (size_t done = 0; done < size;) {
        ssize_t count = read(handle, (char *)to + done, size - done);
        if (count == 0 || (count < 0 && errno != EINTR))
            return false;
        done += count > 0 ? (size_t)count : 0;
    }
    return true;
}

/* Restores the default actions of signals, because the parent removes its temporary files itself.
 */
static void restore_signals(void)
{
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXCPU, SIGXFSZ};
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) {
        struct sigaction before;
        if (sigaction(signals[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            signal(signals[i], SIG_DFL);
    }
}

/* Does the work in the child process, sends the result, and ends the process. */
static void work_in_child(IsolatedWork *work, const void *context, const char *subject, int handle)
{
    Report report = {.status = STATUS_OK};
    Text bytes = TEXT_INIT;
    restore_signals();
    errno = 0;
    report.status = work(context, &bytes, &report.err);
    if (report.status == STATUS_OK && (errno == ENOMEM || !text_chars(&bytes)))
        report.status = mem_out_of("for", subject, &report.err);
    report.length = report.status == STATUS_OK ? bytes.length : 0;
    bool sent = send_all(handle, &report, sizeof report) &&
                (report.length == 0 || send_all(handle, text_chars(&bytes), report.length));
    _exit(sent ? 0 : 1);
}

/* Appends `length` bytes of the pipe to the text. */
static bool receive_text(int handle, size_t length, Text *bytes)
{
    char block[1 << 14];
    for (size_t done = 0; done < length;) {
        size_t count = length - done < sizeof block ? length - done : sizeof block;
        if (!receive(handle, block, count))
            return false;
        text_append(bytes, block, count);
        done += count;
    }
    return true;
}

/* Reads what the child sends. A child that crashes sends too little, which is an error. */
static Status hear_child(int handle, const char *subject, Text *bytes, Err *err)
{
    Report report;
    if (!receive(handle, &report, sizeof report))
        return mem_out_of("for", subject, err);
    if (report.status != STATUS_OK)
        return err_set(err, report.status, "%s", report.err.text);
    Text heard = TEXT_INIT;
    bool whole = receive_text(handle, report.length, &heard);
    if (whole)
        text_add(bytes, &heard);
    text_release(&heard);
    return whole && text_chars(bytes) ? STATUS_OK : mem_out_of("for", subject, err);
}

Status isolated_run(IsolatedWork *work, const void *context, const char *subject, Text *bytes,
                    Err *err)
{
    int pipe_ends[2];
    if (!system_pipe(pipe_ends))
        return err_set(err, STATUS_IO, "no process for %s: %s", subject, strerror(errno));
    pid_t child = fork();
    if (child == 0)
        work_in_child(work, context, subject, pipe_ends[1]);
    close(pipe_ends[1]);
    Status status =
        child > 0 ? hear_child(pipe_ends[0], subject, bytes, err) : mem_out_of("for", subject, err);
    close(pipe_ends[0]);
    while (child > 0 && waitpid(child, NULL, 0) < 0 && errno == EINTR)
        ;
    return status;
}
