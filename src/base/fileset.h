/* Several files that are written together: all of them get their final names, or none does. */
#ifndef CORCAST_BASE_FILESET_H
#define CORCAST_BASE_FILESET_H

#include "base/file.h"
#include "base/text.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* A file that an operation writes. */
typedef struct FileSlot {
    const char *role; /* what the file holds, for messages: "the manifest"; NULL: the option that
                       * names the file has been noted already. Borrowed. */
    char *path;       /* owned; NULL: the file is not written */
    Text text;        /* receives the content */
    FILE *stream;     /* where the text goes, for content that does not pass through it; borrowed */
} FileSlot;

enum { MAX_FILE_SLOTS = 8 };

/* All files that an operation writes; the first one is its result. Zeroed: none. Must not be moved
 * after fileset_open. Release with fileset_release. */
typedef struct FileSet {
    FileSlot at[MAX_FILE_SLOTS];
    OutFile open[MAX_FILE_SLOTS]; /* the files of `at` that are written, in the same order */
    size_t n_open;
} FileSet;

/* Opens the files. A text for standard output is held back until all is written. Errors as
 * outfile_open, STATUS_MEMORY. */
MUST_CHECK Status fileset_open(FileSet *files, Err *err);

/* Adds the name of the file that could not be written to a failure of input or output
 * (STATUS_IO). Returns `status`. */
MUST_CHECK Status fileset_failed(const FileSet *files, Status status, Err *err);

/* Writes the rest of all texts, and gives all files their final names, or none. Errors: STATUS_IO,
 * naming the file, if writing fails; STATUS_MEMORY. */
MUST_CHECK Status fileset_commit(FileSet *files, Err *err);

/* Removes files that have no final name yet, and frees everything. */
void fileset_release(FileSet *files);

#endif
