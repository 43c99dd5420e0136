/* Writes ZIP archives, the container of 3MF. Private to the module emit. */
#ifndef CORCAST_EMIT_ZIP_H
#define CORCAST_EMIT_ZIP_H

#include "tmpl/tmpl.h"

/* A file in the archive. All pointers are borrowed. */
typedef struct ZipEntry {
    const char *name;    /* its path in the archive */
    TmplPut *put;        /* appends the content of the entry */
    const void *context; /* passed to `put` */
} ZipEntry;

enum {
    ZIP_MAX_ENTRIES = 8
}; /* maximum number of entries, more than any archive of the module has */

/* Appends a ZIP archive of `n` <= ZIP_MAX_ENTRIES entries to `out`. Each entry is compressed while
 * its callback produces it. Every entry is dated 1 January 1980, so equal entries give equal bytes.
 *
 * Errors   STATUS_INFEASIBLE if the archive would have 4 GB or more; STATUS_MEMORY; any error of an
 *          entry's callback. After an error `out` may contain a part of the archive. */
MUST_CHECK Status zip_put(const ZipEntry *entries, size_t n, Text *out, Err *err);

#endif
