/* What all functions of the library share: handles that know their type, and the beginning and end
 * of a call. */
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
    uint64_t magic; /* a number of the kind; another one after handle_free */
} Handle;

/* Allocates a zeroed handle of `size` bytes, whose first member is a Handle, in *out (owned;
 * handle_free). Errors: STATUS_MEMORY. */
MUST_CHECK Status handle_new(void *out, HandleKind kind, size_t size, Err *err);
/* Returns true if `handle` is of this kind and was not freed. NULL is of no kind. */
bool handle_is(const void *handle, HandleKind kind);
/* Checks an argument. `name` is the parameter's. Errors: STATUS_USAGE. */
MUST_CHECK Status handle_check(const void *handle, HandleKind kind, const char *name, Err *err);
/* Frees the memory of a handle whose content has been released. A debug build keeps the memory, so
 * that later use of the handle is found. */
void handle_free(void *handle);

/* Checks that an argument other than a handle is not NULL. Errors: STATUS_USAGE. */
MUST_CHECK Status argument_check(const void *argument, const char *name, Err *err);
/* Checks that a path is a name, and not "-", a standard stream. Errors: STATUS_USAGE. */
MUST_CHECK Status path_check(const char *path, const char *name, Err *err);

struct corcast_error {
    Handle handle;
    Err err;
    Status status;
};

/* A call of the library. During it the thread has the locale "C": numbers in files have a '.'. */
typedef struct Call {
    corcast_error *error;  /* NULL: nobody wants the sentence */
    locale_t before;       /* the locale of the caller's thread */
    const char *templates; /* the folder of an outer call; NULL: none */
    Err err;
} Call;

/* Begins a call. Every call ends with call_end. */
Call call_begin(corcast_error *error);
/* Ends a call: stores status and sentence in the caller's error. Returns the corcast_status. */
int call_end(Call *call, Status status);

/* Surround each callback. callback_begin restores the caller's locale and returns the library's
 * own; callback_end sets the library's own locale again. */
locale_t callback_begin(locale_t before);
void callback_end(locale_t own);

#endif
