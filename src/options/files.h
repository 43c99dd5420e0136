/* Registers the files that a command reads and writes, so that no file is overwritten by mistake.
 *
 * Files are compared by identity, not by spelling: an existing file by its device and inode, a
 * missing one by its folder and name. Links and other spellings of a path are therefore found.
 * Devices and pipes may be used any number of times.
 *
 *     Files files = {0};
 *     TRY(files_read(&files, "the input", "tree.swc", err));
 *     TRY(files_write(&files, "-o", "./tree.swc", err)); // fails with STATUS_USAGE
 *     files_release(&files); */
#ifndef CORCAST_OPTIONS_FILES_H
#define CORCAST_OPTIONS_FILES_H

#include "base/base.h"

typedef struct FileUse FileUse;

/* The registered files. A zeroed Files has none. Release it with files_release. */
typedef struct Files {
    FileUse *uses;
    size_t n, capacity;
} Files;

/* Register a file that the command reads or writes. A missing file is not an error.
 *
 * role    what the file is for, used in error sentences: "--json", "-o", "the input".
 * path    "-" is standard input or standard output.
 * Errors  STATUS_USAGE if a file is written twice, or read and written. STATUS_IO if the file
 *         cannot be written (outfile_check). STATUS_MEMORY. */
MUST_CHECK Status files_read(Files *files, const char *role, const char *path, Err *err);
MUST_CHECK Status files_write(Files *files, const char *role, const char *path, Err *err);
void files_release(Files *files);

/* Receives one file. `named` is true if the caller named the file itself, false if it was found in
 * a folder. `path` is borrowed during the call. */
typedef Status FileVisit(void *user, const char *path, bool named, Err *err);

/* Calls `visit` for `path`. If `path` is a folder, calls `visit` for the files in it that have one
 * of the extensions, sorted by name. Stops at the first failure.
 *
 * extensions  a list that NULL ends.
 * user        passed to `visit`.
 * Errors      of `visit`. STATUS_INPUT if a folder cannot be read. STATUS_MEMORY. */
MUST_CHECK Status files_visit(const char *path, const char *const *extensions, FileVisit *visit,
                              void *user, Err *err);

#endif
