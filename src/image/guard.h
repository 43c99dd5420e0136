/* Calls image libraries and converts their errors to a Status. Private to the module image.
 *
 * libpng and libjpeg report an error through a callback that must not return. libtiff and Little
 * CMS crash if one of their allocations fails; their allocations are functions of this module,
 * which call guard_leave_without_memory instead of returning NULL. Code that calls these libraries
 * therefore runs in a guard: guard_run(guard, work, self, err) calls work(self, err), and a
 * callback of the library returns from guard_run by longjmp [guard_leave]. No other module uses
 * setjmp. */
#ifndef CORCAST_IMAGE_GUARD_H
#define CORCAST_IMAGE_GUARD_H

#include "base/base.h"
#include <setjmp.h>
#include <stdio.h>

/* Size of a message in bytes; reason of the value not recorded. */
enum { GUARD_TEXT = 200 };

/* The state of a library's work on one file. Before the first guard_run, the caller sets the first
 * three members and zeroes the others. */
typedef struct Guard {
    const char *format;       /* name of the format, for errors: "PNG" */
    const char *name;         /* name of the file that is read, for errors; NULL: a file is
                               * written */
    FILE *stream;             /* borrowed; the file that is written; NULL: a file is read */
    char message[GUARD_TEXT]; /* message of the library, in printable ASCII; "": none. It is kept
                               * from one guard_run to the next */
    bool failed;              /* true: a callback has left the guard, and the library's objects are
                               * in an undefined state. Never reset */
    jmp_buf exit;
    struct Guard *outer; /* the guard that was running before; NULL: none */
} Guard;

/* Work that runs in a guard. Errors are those of the library and of the work itself. */
typedef Status GuardedWork(void *self, Err *err);

/* Sets errno to 0, calls work(self, err), and returns its status. If a callback left the guard,
 * returns guard_failure(err) instead. Calls may be nested.
 *
 * If a library has no memory for a part of a file, it may skip the part and leave ENOMEM in errno.
 * Therefore STATUS_OK becomes STATUS_MEMORY if errno is ENOMEM at the end.
 *
 * self     must own everything that `work` acquires: the locals of `work` are lost when it is left.
 * Threads  The running guard is thread-local. */
MUST_CHECK Status guard_run(Guard *guard, GuardedWork *work, void *self, Err *err);

/* The following functions are for `work` and the callbacks of its library. They act on the running
 * guard of the thread. Except guard_failure, they do nothing if no guard is running. */

/* Leaves the guard by longjmp. `message` replaces an earlier message; NULL keeps the earlier one.
 * If no guard is running, returns, and the library goes on. */
void guard_leave(const char *message);
/* Leaves the guard because an allocation failed. */
void guard_leave_without_memory(void);
/* Stores a library's message, unless an earlier one is stored. */
void guard_note_message(const char *message);
/* Removes the stored message, after a step of the library whose messages are not errors. */
void guard_clear_message(void);

/* Writes the error message for a failure of the running guard's library to *err. A guard must be
 * running.
 *
 * Returns  STATUS_MEMORY if errno is ENOMEM, else STATUS_INPUT for a file that is read and
 *          STATUS_IO for a file that is written. */
Status guard_failure(Err *err);

/* Replaces all characters of a library's text that are not printable ASCII by blanks, because a
 * terminal would obey control characters. Needs no running guard. */
void image_plain_text(char *text);

#endif
