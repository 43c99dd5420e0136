/* Runs calls of an image library in a guard: run() calls setjmp, and the library's error handler
 * returns to it by longjmp [guard_leave]. The guard then turns the library's message into a Status.
 * What `work` and the library allocated belongs to the object `self`, whose owner frees it, unless
 * the library's own objects are undefined [Guard.failed].
 *
 * The running guard is a thread-local variable, because libtiff's allocation functions receive no
 * pointer to the caller's data. run() changes no local variable between setjmp and longjmp, so none
 * needs `volatile`. */
#include "image/guard.h"

#include <errno.h>
#include <string.h>

static _Thread_local Guard *running; /* the innermost guard of the thread; NULL: none */

void image_plain_text(char *text)
{
    for (; *text; text++)
        if (*text < ' ' || *text > '~')
            *text = ' ';
}

static void set_message(const char *message)
{
    snprintf(running->message, sizeof running->message, "%s", message);
    image_plain_text(running->message);
}

void guard_leave(const char *message)
{
    if (!running)
        return;
    if (message)
        set_message(message);
    running->failed = true;
    longjmp(running->exit, 1);
}

void guard_leave_without_memory(void)
{
    errno = ENOMEM;
    guard_leave(NULL);
}

void guard_note_message(const char *message)
{
    if (running && !*running->message)
        set_message(message);
}

void guard_clear_message(void)
{
    if (running)
        *running->message = '\0';
}

/* Writes the error for a file that is read. A library that fails without a message has usually
 * found less data than the header of the file states. */
static Status failed_reading(Err *err)
{
    if (errno == ENOMEM)
        return mem_out_of("to read", running->name, err);
    return err_set(err, STATUS_INPUT, "%s: is not a valid %s file: %s", running->name,
                   running->format,
                   *running->message ? running->message : "its header contradicts its data");
}

static Status failed_writing(Err *err)
{
    if (errno == ENOMEM)
        return mem_out_of("to write a file of the format", running->format, err);
    return err_set(err, STATUS_IO, "writing the %s failed: %s", running->format,
                   ferror(running->stream) || !*running->message ? strerror(errno)
                                                                 : running->message);
}

Status guard_failure(Err *err)
{
    /* Only guards of a file that is read have a name [Guard.name]. */
    return running->name ? failed_reading(err) : failed_writing(err);
}

/* Runs the work; longjmp from the library's error handler returns to this function. */
static Status run(Guard *guard, GuardedWork *work, void *self, Err *err)
{
    if (setjmp(guard->exit))
        return guard_failure(err);
    Status status = work(self, err);
    /* guard_run cleared errno. ENOMEM now means that the library ran out of memory and went on
     * without reporting it. */
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
