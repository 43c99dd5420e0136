/* Calls of libraries that report an error through a callback which must not return; private to the
 * module image.
 *
 * libpng and libjpeg call an error handler, and libtiff and Little CMS crash where an allocation of
 * theirs fails. Code that calls them runs in a guard, which such a callback leaves by longjmp. This
 * module is the only one that uses setjmp. */
#ifndef CORCAST_IMAGE_GUARD_H
#define CORCAST_IMAGE_GUARD_H

#include "base/base.h"
#include <setjmp.h>
#include <stdio.h>

enum { GUARD_TEXT = 200 };

/* The work of a library on one file. Zeroed but for the first three members before the first call
 * of guard_run. */
typedef struct Guard {
    const char *format;         /* of the file, for errors: "PNG" */
    const char *name;           /* the file that is read, for errors; NULL: a file is written */
    FILE *stream;               /* borrowed; the file that is written; NULL: a file is read */
    char complaint[GUARD_TEXT]; /* what the library reported, in printable ASCII; "": nothing */
    bool left;                  /* a callback has left the guard: the library's objects are in an
                                 * undefined state */
    jmp_buf exit;
    struct Guard *outer; /* the guard that was running before; NULL: none */
} Guard;

typedef Status GuardedWork(void *self, Err *err);

/* Sets errno to 0 and returns work(self, err), or guard_failure if a callback left the guard.
 *
 * Libraries go on without parts they had no memory for, and leave ENOMEM in errno. STATUS_OK
 * therefore becomes STATUS_MEMORY if errno is ENOMEM at the end. Calls may be nested.
 *
 * self     must own everything that `work` acquires: the locals of `work` are lost when it is left.
 * Threads  The running guard is a variable of the thread. */
MUST_CHECK Status guard_run(Guard *guard, GuardedWork *work, void *self, Err *err);

/* The following functions are for `work` and the callbacks of its library. They act on the running
 * guard of the thread. Without one they do nothing. */

/* Leaves the guard. `complaint` replaces an earlier one. */
void guard_leave(const char *complaint);
/* Leaves the guard because an allocation failed. */
void guard_leave_without_memory(void);
/* Stores a complaint unless there is one. */
void guard_complain(const char *complaint);
/* Forgets the complaint: what the library reported is no error here. */
void guard_forget(void);

/* Writes the sentence for a failure of the running guard's library.
 *
 * Returns  STATUS_MEMORY if errno is ENOMEM, else STATUS_INPUT for a file that is read and
 *          STATUS_IO for a file that is written. */
Status guard_failure(Err *err);

/* Replaces all characters of a library's text that are not printable ASCII by blanks. */
void image_plain_text(char *text);

#endif
