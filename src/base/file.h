/* Reads whole files, and writes files that get their final names only when they are complete.
 * file_read reads; outfile_open and outfile_commit, or file_write in one call, write. */
#ifndef CORCAST_BASE_FILE_H
#define CORCAST_BASE_FILE_H

#include "base/hash.h"
#include "base/text.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/types.h>

/* The kind of file that a reader accepts. */
typedef struct FileForm {
    const char *name;                                /* "an SWC file" */
    double most_bytes;                               /* maximum size in bytes */
    bool is_text;                                    /* the file is text: it has no zero bytes */
    bool (*begins)(const char *start, size_t count); /* returns true if a file of this kind may
                                                      * start with these bytes; NULL: any may */
} FileForm;

/* Reads a whole file. If the form is text, removes the byte order mark, and converts each line end
 * (LF, CR or CRLF) to LF.
 *
 * path     "-" is standard input.
 * bytes    receives the content, followed by a zero byte; the caller frees it with free().
 * size     receives the number of bytes, without the zero byte.
 * Errors   STATUS_INPUT if the file is missing, is a folder, or is not of this form. STATUS_IO if
 *          reading fails. STATUS_MEMORY, naming the file. */
MUST_CHECK Status file_read(const char *path, const FileForm *form, char **bytes, size_t *size,
                            Err *err);
/* A file in memory. Pointers are borrowed. */
typedef struct MemoryFile {
    const char *name; /* used in place of a path */
    const void *bytes;
    size_t size;
} MemoryFile;
/* Does the same as file_read with a file in memory: copies its bytes to *bytes, which the caller
 * frees. Errors: those of file_read. */
MUST_CHECK Status file_read_memory(const MemoryFile *file, const FileForm *form, char **bytes,
                                   size_t *size, Err *err);
/* Adds the size and the bytes of a file to `hash`. Errors: those of file_read. */
MUST_CHECK Status file_hash(const char *path, Hash *hash, Err *err);
/* Removes the byte order mark and converts line ends, as file_read does, in place. *size is in and
 * out. `path` and `form` are for the error sentence. Errors: STATUS_INPUT for a zero byte. */
MUST_CHECK Status file_to_text(const char *path, const FileForm *form, char *bytes, size_t *size,
                               Err *err);

/* Returns STATUS_INPUT unless `path` is a regular file: opening a pipe or device may block forever.
 */
MUST_CHECK Status file_check_regular(const char *path, Err *err);

/* A file that is being written.
 *
 * The bytes go to a temporary file in the same folder, which outfile_commit renames. If a signal
 * ends the program, the temporary file is removed [file_clean_up_on_signals]. Standard output
 * ("-"), devices and pipes are written directly. A file that replaces another file gets the
 * permissions of the old file and, if the system allows it, its owner. If `path` is a symbolic
 * link, its target is written, also if the target does not exist yet. Other hard links to a
 * replaced file keep the old content. */
typedef struct OutFile {
    FILE *stream;    /* for writing by the caller */
    char *path;      /* final name; owned */
    char *temporary; /* path of the temporary file; NULL if the file is written directly; owned */
} OutFile;

/* Checks that outfile_open could open `path`, without writing. Errors: STATUS_IO if the folder is
 * missing, permission is missing, `path` is a folder, or symbolic links form a circle. */
MUST_CHECK Status outfile_check(const char *path, Err *err);

/* Opens a file for writing. End with exactly one of outfile_commit and outfile_discard. After an
 * error *file is unchanged and needs neither. Errors: those of outfile_check; STATUS_MEMORY. */
MUST_CHECK Status outfile_open(OutFile *file, const char *path, Err *err);
/* Writes the rest of the stream, and gives the file its final name. Releases `file`, also on
 * failure. Errors: STATUS_IO, naming the file. */
MUST_CHECK Status outfile_commit(OutFile *file, Err *err);
/* Removes the temporary file, and releases `file`. A zeroed OutFile is allowed. */
void outfile_discard(OutFile *file);
/* Commits n files, all or none: if a file cannot get its final name, the files that had the names
 * before are restored. On a file system without hard links they are restored only if the first file
 * fails. Releases all files, also on failure. Errors: STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status outfiles_commit(OutFile *files, size_t n, Err *err);

/* Returns STATUS_IO if the disk of `file` has fewer than `bytes` left; STATUS_OK for standard
 * output, devices and pipes. */
MUST_CHECK Status outfile_check_space(const OutFile *file, double bytes, Err *err);

/* Writes all of `bytes` to `path` through an OutFile. */
MUST_CHECK Status file_write(const char *path, const void *bytes, size_t size, Err *err);
/* Writes the string of `text` to `path`; returns STATUS_MEMORY if `text` has failed. */
MUST_CHECK Status file_write_text(const char *path, const Text *text, Err *err);

/* Appends the content of a file to `text`. */
typedef Status PutContent(const void *context, Text *text, Err *err);
/* Writes to `path` the content that `put` appends, through an OutFile. The content is written in
 * parts, so it need not fit into memory. Errors: those of `put`; STATUS_IO, which names the file;
 * STATUS_MEMORY. */
MUST_CHECK Status file_write_parts(const char *path, PutContent *put, const void *context,
                                   Err *err);

/* Finds the file that writing to `path` would write: follows symbolic links in the last component.
 * The caller frees *out. Errors: STATUS_IO if the links form a circle; STATUS_MEMORY. */
MUST_CHECK Status file_resolve(const char *path, char **out, Err *err);

/* Makes an empty temporary folder beside `path`, in which another program may write. The caller
 * ends with file_discard_temporary(*folder), which removes the folder with its files; a signal that
 * ends the program does so, too. Errors: STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status file_temporary_folder(const char *path, char **folder, Err *err);
/* Registers the temporary file `name`: if a signal ends the program, the file is removed. Takes
 * ownership of `name`, which must be allocated by malloc, on success. End with file_rename or
 * file_discard_temporary. Errors: STATUS_IO if too many files are registered. */
MUST_CHECK Status file_remove_on_signal(char *name, Err *err);
/* Renames a registered temporary file to `path`, as outfile_commit does. Frees `temporary`, also on
 * failure. Errors: STATUS_IO. */
MUST_CHECK Status file_rename(char *temporary, const char *path, Err *err);
/* Removes a registered temporary file or folder, if it exists, and frees its name. NULL is allowed.
 */
void file_discard_temporary(char *temporary);

/* Makes a folder and its missing parents; does nothing if it exists. Errors: STATUS_IO,
 * STATUS_MEMORY. */
MUST_CHECK Status file_make_folder(const char *path, Err *err);

/* Installs signal handlers that remove temporary files when SIGINT, SIGTERM, SIGHUP, SIGQUIT,
 * SIGPIPE, SIGXCPU or SIGXFSZ ends the program. Signals that the parent process ignored stay
 * ignored. Only main calls it, once. The table of temporary names is a global variable, because a
 * signal handler has no argument through which it could reach other data. */
void file_clean_up_on_signals(void);
/* Registers a process group, up to 32 at a time: a signal that ends the program then kills the
 * group first, so that the group makes no more files. file_spare_on_signal cancels the
 * registration. */
void file_kill_on_signal(pid_t group);
void file_spare_on_signal(pid_t group);
/* Opens /dev/null in place of standard streams that the parent process has closed, so that no file
 * opened later gets their descriptors; using such a stream fails. Only main calls it, before any
 * file is opened. */
void file_hold_standard_streams(void);

/* Returns the part of the last component of `path` after its last '.', "" if there is none;
 * borrowed from `path`. */
const char *file_extension(const char *path);
/* The next three functions make a path in *out, which the caller frees. Errors: STATUS_MEMORY. */
/* Replaces the extension of `path`, with its '.', by `suffix`. */
MUST_CHECK Status file_with_suffix(const char *path, const char *suffix, char **out, Err *err);
/* Joins a folder and a name: "folder/name". */
MUST_CHECK Status file_join(const char *folder, const char *name, char **out, Err *err);
/* Makes the path of `name` in the folder of `path`: "a/b.swc" and "c" give "a/c". If `name` is "",
 * the result is the folder with a final '/', or "" if `path` has no folder. */
MUST_CHECK Status file_beside(const char *path, const char *name, char **out, Err *err);
/* Returns the last component of `path`; borrowed from `path`. */
const char *file_name(const char *path);
/* Returns the size of a file in bytes; 0 if there is no such file. */
double file_bytes(const char *path);

#endif
