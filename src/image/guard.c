/* The running guard is a thread-local variable, because libtiff's allocation functions receive no
 * pointer to the caller's data. The functions that call setjmp and longjmp have no local variables
 * that change between the two calls. */
#include "image/guard.h"

#include <errno.h>
#include <string.h>

static _Thread_local Guard *running;

void image_plain_text(char *text)
{
    for (; *text; text++)
        if (*text < ' ' || *text > '~')
            *text = ' ';
}

static void set_complaint(const char *complaint)
{
    snprintf(running->complaint, sizeof running->complaint, "%s", complaint);
    image_plain_text(running->complaint);
}

void guard_leave(const char *complaint)
{
    if (!running)
        return;
    if (complaint)
        set_complaint(complaint);
    running->left = true;
    longjmp(running->exit, 1);
}

void guard_leave_without_memory(void)
{
    errno = ENOMEM;
    guard_leave(NULL);
}

void guard_complain(const char *complaint)
{
    if (running && !*running->complaint)
        set_complaint(complaint);
}

void guard_forget(void)
{
    if (running)
        *running->complaint = '\0';
}

static Status failed_reading(Err *err)
{
    if (errno == ENOMEM)
        return mem_out_of("to read", running->name, err);
    return err_set(err, STATUS_INPUT, "%s: is not a valid %s file: %s", running->name,
                   running->format,
                   *running->complaint ? running->complaint : "its header contradicts its data");
}

static Status failed_writing(Err *err)
{
    if (errno == ENOMEM)
        return mem_out_of("to write a file of the format", running->format, err);
    return err_set(err, STATUS_IO, "writing the %s failed: %s", running->format,
                   ferror(running->stream) || !*running->complaint ? strerror(errno)
                                                                   : running->complaint);
}

Status guard_failure(Err *err)
{
    return running->name ? failed_reading(err) : failed_writing(err);
}

static Status run(Guard *guard, GuardedWork *work, void *self, Err *err)
{
    if (setjmp(guard->exit))
        return guard_failure(err);
    Status status = work(self, err);
    return status == STATUS_OK && errno == ENOMEM ? guard_failure(err) : status;
}

Status guard_run(Guard *guard, GuardedWork *work, void *self, Err *err)
{
    guard->outer = running;
    running = guard;
    errno = 0;
    Status status = run(guard, work, self, err);
    running = guard->outer;
    return status;
}
