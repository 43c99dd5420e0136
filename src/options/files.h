/* Registers the files that a command reads and writes, so that no file is overwritten by mistake.
 * Also lists the files of a folder (files_visit).
 *
 * Files are compared by identity, not by the spelling of their paths: an existing file by its
 * device and inode, a missing file by its folder and name. Links to a file are therefore
 * recognized. Devices and pipes may be used any number of times.
 *
 *     Files files = {0};
 *     TRY(files_add_input(&files, "the input", "tree.swc", err));
 *     TRY(files_add_output(&files, "-o", "./tree.swc", err)); // fails with STATUS_USAGE
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

/* Register a file that the command reads or writes. A file that does not exist is not an error.
 *
 * role    purpose of the file, for error sentences: "--json", "-o", "the input"; copied.
 * path    "-" is standard input or standard output; copied.
 * Errors  STATUS_USAGE if a file is written twice, or read and written; STATUS_IO if an output
 *         cannot be written [outfile_check, base/file.h]; STATUS_MEMORY. */
MUST_CHECK Status files_add_input(Files *files, const char *role, const char *path, Err *err);
MUST_CHECK Status files_add_output(Files *files, const char *role, const char *path, Err *err);
void files_release(Files *files);

/* Receives one file. `user` is the argument of files_visit. `named` is true if `path` is the
 * argument of files_visit, and false if it is a file in that folder. `path` is borrowed during the
 * call. */
typedef Status FileVisit(void *user, const char *path, bool named, Err *err);

/* Calls `visit` for `path`. If `path` is a folder, instead calls `visit` for each file in the
 * folder that has one of the extensions, sorted by name, without subfolders. Stops at the first
 * failure of `visit`.
 *
 * extensions  a list that ends with NULL.
 * user        passed to `visit`.
 * Errors      the errors of `visit`; STATUS_INPUT if a folder cannot be read; STATUS_MEMORY. */
MUST_CHECK Status files_visit(const char *path, const char *const *extensions, FileVisit *visit,
                              void *user, Err *err);

#endif
