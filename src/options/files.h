/* The files that a command reads and writes: none is written over another of them. */
#ifndef CORCAST_OPTIONS_FILES_H
#define CORCAST_OPTIONS_FILES_H

#include "base/base.h"

typedef struct FileUse FileUse;

/* Zeroed: no files. Release with files_release. */
typedef struct Files {
    FileUse *uses;
    size_t n, capacity;
} Files;

/* Takes note that `path` ("-": standard input or output) is read or written, on behalf of `role`
 * ("--json", "-o", "the input"). Files are told apart as the system does, by what they are where
 * they exist and by folder and name where they do not, so that other spellings and links are seen
 * through; devices and pipes take any number of uses. STATUS_USAGE when a file is written twice, or
 * read and written; STATUS_IO when one to be written cannot be, as outfile_check finds. A file that
 * is missing is not an error here. */
MUST_CHECK Status files_read(Files *files, const char *role, const char *path, Err *err);
MUST_CHECK Status files_write(Files *files, const char *role, const char *path, Err *err);
void files_release(Files *files);

/* Called for a file; `named`: it is not one of a folder's. */
typedef Status FileVisit(void *user, const char *path, bool named, Err *err);

/* Calls `visit` for `path` or, where that is a folder, for its files of these extensions (a list
 * that ends in NULL) in the order of their names, until one fails. STATUS_INPUT when a folder
 * cannot be read. */
MUST_CHECK Status files_visit(const char *path, const char *const *extensions, FileVisit *visit,
                              void *user, Err *err);

#endif
