/* The parts that all functions of the library share: handles with a type, checks of arguments, and
 * the begin and end of a call. */
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
    uint64_t magic; /* a number that identifies the kind; another number after handle_free */
} Handle;

/* Allocates a zeroed struct of `size` bytes whose first member is a Handle, and stores the pointer
 * in *out. Release it with handle_free. Errors: STATUS_MEMORY. */
MUST_CHECK Status handle_new(void *out, HandleKind kind, size_t size, Err *err);
/* Returns true if `handle` is of this kind and was not freed. Returns false for NULL. */
bool handle_is(const void *handle, HandleKind kind);
/* Checks that `handle` is of this kind. `name` is the parameter's name in errors. Errors:
 * STATUS_USAGE. */
MUST_CHECK Status handle_check(const void *handle, HandleKind kind, const char *name, Err *err);
/* Frees the memory of a handle whose content has been released. A debug build keeps the memory, so
 * that later use of the handle is detected. */
void handle_free(void *handle);

/* Checks that an argument other than a handle is not NULL. Errors: STATUS_USAGE. */
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
    corcast_error *error;  /* receives the error; NULL: it is not stored */
    locale_t before;       /* the locale of the caller's thread */
    const char *templates; /* the folder of an outer call; NULL: none */
    Err err;
} Call;

/* Begins a call: sets the locale "C". Every call must end with call_end. */
Call call_begin(corcast_error *error);
/* Ends a call: restores the locale, and stores the status and the sentence in the caller's error.
 * Returns the corcast_status of `status`. */
int call_end(Call *call, Status status);

/* Called before and after each callback. callback_begin sets the caller's locale and returns the
 * library's locale; callback_end sets the library's locale again. */
locale_t callback_begin(locale_t before);
void callback_end(locale_t own);

#endif
