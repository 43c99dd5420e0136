/* ZIP archives, which 3MF is; private to the room emit. */
#ifndef CORCAST_EMIT_ZIP_H
#define CORCAST_EMIT_ZIP_H

#include "base/base.h"

typedef struct ZipEntry {
    const char *name;
    /* Appends what it holds, handed `context`. */
    Status (*put)(Text *out, void *context, Err *err);
    void *context;
} ZipEntry;

enum { ZIP_MOST_ENTRIES = 8 };

/* Appends an archive of them, deflated as they are made, dated 1 January 1980 so that the same
 * entries give the same bytes. STATUS_INFEASIBLE when there are 4 GB, STATUS_MEMORY, and what the
 * entries return. */
MUST_CHECK Status zip_put(const ZipEntry *entries, size_t n, Text *out, Err *err);

#endif
