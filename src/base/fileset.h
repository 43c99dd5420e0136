/* Several files that are written together: all of them get their final names, or none of them. Set
 * the paths in FileSet.at, call fileset_open, write the texts, then call fileset_commit. */
#ifndef CORCAST_BASE_FILESET_H
#define CORCAST_BASE_FILESET_H

#include "base/file.h"
#include "base/text.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* A file that an operation writes. */
typedef struct FileSlot {
    const char *role; /* the content of the file, for messages: "the manifest"; NULL: the caller has
                       * registered the path as an output already, so that fileset_open does not.
                       * Borrowed */
    char *path;       /* owned; "-": standard output; NULL: the file is not written */
    Text text;        /* receives the content */
    FILE *stream;     /* set by fileset_open: the stream of `text`, for content that is written
                       * directly; borrowed */
} FileSlot;

enum { MAX_FILE_SLOTS = 8 };

/* All files that an operation writes; the first one is its result. Zeroed: none. Must not be moved
 * after fileset_open. Release with fileset_release. */
typedef struct FileSet {
    FileSlot at[MAX_FILE_SLOTS];
    OutFile open[MAX_FILE_SLOTS]; /* the files of `at` that are written, in the same order */
    size_t n_open;
} FileSet;

/* Opens the files. A text for standard output is stored in memory until fileset_commit. Errors:
 * those of outfile_open; STATUS_MEMORY. */
MUST_CHECK Status fileset_open(FileSet *files, Err *err);

/* If `status` is STATUS_IO, puts the name of the file that could not be written in front of the
 * error. Returns `status`. */
MUST_CHECK Status fileset_name_failure(const FileSet *files, Status status, Err *err);

/* Writes the rest of all texts, and gives all files their final names, or none. Errors: STATUS_IO,
 * naming the file, if writing fails; STATUS_MEMORY. */
MUST_CHECK Status fileset_commit(FileSet *files, Err *err);

/* Removes files that have no final name yet, and frees everything. Call it also after an error of
 * fileset_open. */
void fileset_release(FileSet *files);

#endif
