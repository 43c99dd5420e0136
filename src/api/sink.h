/* Gives the bytes of files to a callback of the caller. Writers of the library need a path: their
 * files are made in a temporary folder in /tmp, passed on, and removed. */
#ifndef CORCAST_API_SINK_H
#define CORCAST_API_SINK_H

#include "api/handle.h"

typedef struct Sink {
    corcast_sink *take; /* may be NULL, which is an error */
    void *user;
    locale_t before; /* the locale of the caller's thread */
} Sink;

/* Passes the `size` bytes of the file `name`.
 * Errors   STATUS_USAGE if sink->take is NULL; STATUS_IO if the callback returns another number
 *          than 0. */
MUST_CHECK Status sink_give(const Sink *sink, const char *name, const void *bytes, size_t size,
                            Err *err);

/* Writes one or more files; the first one is `path`. */
typedef Status SinkMaker(const void *context, const char *path, Err *err);

/* Calls `make` for the file `name` in a temporary folder, and passes all files of that folder in
 * the order of their names.
 *
 * name     must have no folder; its extension decides the format.
 * Errors   STATUS_USAGE for another name or if sink->take is NULL; those of `make`; STATUS_IO if a
 *          file cannot be read again, or if the callback returns another number than 0. */
MUST_CHECK Status sink_files(const Sink *sink, const char *name, SinkMaker *make,
                             const void *context, Err *err);

#endif
