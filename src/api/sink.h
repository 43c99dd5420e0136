/* Passes the bytes of files to a callback of the caller. The writers of the lower modules need a
 * path. Their files are therefore written to a temporary folder in /tmp, passed on, and removed. */
#ifndef CORCAST_API_SINK_H
#define CORCAST_API_SINK_H

#include "api/handle.h"

typedef struct Sink {
    corcast_sink *take; /* the callback; NULL: sink_give and sink_files fail */
    void *user;
    locale_t caller_locale; /* the locale of the caller's thread; set during the callback, because
                             * the library itself runs in its own locale [callback_begin] */
} Sink;

/* Passes the `size` bytes of the file `name` to the callback. The bytes are valid only during the
 * callback.
 *
 * Errors  STATUS_USAGE if sink->take is NULL; STATUS_IO if the callback returns a number other than
 *         0. */
MUST_CHECK Status sink_give(const Sink *sink, const char *name, const void *bytes, size_t size,
                            Err *err);

/* Writes the file `path`, and possibly further files in the same folder. */
typedef Status SinkMaker(const void *context, const char *path, Err *err);

/* Calls `make` for the file `name` in a temporary folder, and passes all files of that folder to
 * the callback, sorted by name. A large file is passed in several calls of the callback. The folder
 * is removed, also after an error.
 *
 * name     must have no folder; its extension selects the format.
 * context  passed to `make`.
 * Errors   STATUS_USAGE if `name` has a folder, or if sink->take is NULL; the errors of `make`;
 *          STATUS_IO if the temporary folder cannot be made, if a file cannot be read again, or if
 *          the callback returns a number other than 0; STATUS_MEMORY. */
MUST_CHECK Status sink_files(const Sink *sink, const char *name, SinkMaker *make,
                             const void *context, Err *err);

#endif
