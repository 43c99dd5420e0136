/* ZIP archives, the container of 3MF. Private to the module emit. */
#ifndef CORCAST_EMIT_ZIP_H
#define CORCAST_EMIT_ZIP_H

#include "base/base.h"

typedef struct ZipEntry {
    const char *name;
    /* Appends the content of the entry. Receives `context`. */
    Status (*put)(Text *out, void *context, Err *err);
    void *context;
} ZipEntry;

enum { ZIP_MOST_ENTRIES = 8 };

/* Appends an archive of `n` entries, which are compressed while they are made. Their date is 1
 * January 1980, so that the same entries give the same bytes. Errors: STATUS_INFEASIBLE if the
 * archive has 4 GB or more, STATUS_MEMORY, and those of the entries. */
MUST_CHECK Status zip_put(const ZipEntry *entries, size_t n, Text *out, Err *err);

#endif
