/* The parts that all functions of the public C library [corcast.h] share: typed handles, checks of
 * arguments, and the start and end of a call. Every public function has this form:
 *
 *     Call call = call_begin(error);
 *     Status status = handle_check(tree, HANDLE_TREE, "tree", &call.err);
 *     if (status == STATUS_OK) status = ...;
 *     return call_end(&call, status); */
#ifndef CORCAST_API_HANDLE_H
#define CORCAST_API_HANDLE_H

#include "base/base.h"
#include "corcast.h"
#include <locale.h>
#include <stdint.h>

typedef enum HandleKind {
    HANDLE_ERROR,
    HANDLE_OPTIONS,
    HANDLE_REPORT,
    HANDLE_TREE,
    HANDLE_SCENE,
    HANDLE_IMAGE,
    HANDLE_MESH
} HandleKind;

/* The first member of every handle. */
typedef struct Handle {
    uint64_t magic; /* a number that identifies the kind; handle_free changes it */
} Handle;

/* Allocates a zeroed struct of `size` bytes whose first member is a Handle. `out` is the address of
 * a pointer to the struct, which receives the pointer. Release it with handle_free. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status handle_new(void *out, HandleKind kind, size_t size, Err *err);
/* Returns true if `handle` points to a handle of this kind. Returns false for NULL. A freed handle
 * is detected reliably only in a debug build, because its memory may be used again. */
bool handle_is(const void *handle, HandleKind kind);
/* Checks that `handle` is of this kind, by handle_is. `name` is the parameter's name in error
 * sentences. Errors: STATUS_USAGE. */
MUST_CHECK Status handle_check(const void *handle, HandleKind kind, const char *name, Err *err);
/* Frees the memory of a handle, after its content has been released. `handle` must not be NULL. A
 * debug build (CORCAST_DEBUG) keeps the memory and marks it, so that every later use of the handle
 * is detected. */
void handle_free(void *handle);

/* Checks that an argument other than a handle is not NULL. `name` is as for handle_check. Errors:
 * STATUS_USAGE. */
MUST_CHECK Status argument_check(const void *argument, const char *name, Err *err);
/* Checks that a path is not NULL, "", or "-", which names a standard stream on the command line.
 * Errors: STATUS_USAGE. */
MUST_CHECK Status path_check(const char *path, const char *name, Err *err);

struct corcast_error {
    Handle handle;
    Err err;
    Status status;
};

/* A call of the library. During the call the thread has the locale "C", so that numbers have a '.'
 * as the decimal point. */
typedef struct Call {
    /* the caller's error, which receives status and sentence; NULL: not wanted */
    corcast_error *error;
    locale_t caller_locale; /* the locale that the caller's thread had before */
    const char *templates; /* the templates folder of this thread before the call; call_end restores
                            * it. NULL, unless the call is made in a callback of another call */
    Err err;
} Call;

/* Begins a call: sets the locale "C". Cannot fail. If `error` is not a valid handle, the error is
 * not stored. Every call must end with call_end. */
Call call_begin(corcast_error *error);
/* Ends a call: restores locale and templates folder, and stores the status and the sentence in the
 * caller's error. Returns `status` as the public corcast_status. */
int call_end(Call *call, Status status);

/* Must be called before and after each callback into the caller's program. callback_begin sets the
 * locale of Call.caller_locale and returns the library's locale. Pass the result to callback_end,
 * which sets it again. */
locale_t callback_begin(locale_t caller_locale);
void callback_end(locale_t library_locale);

#endif
