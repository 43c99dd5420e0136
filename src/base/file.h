/* Reading files whole, and writing files that appear under their final name only when complete. */
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
    double most_bytes;                               /* the largest size that is accepted */
    bool is_text;                                    /* a text: without zero bytes */
    bool (*begins)(const char *start, size_t count); /* returns true if a file of this kind may
                                                      * start with these bytes; NULL: any may */
} FileForm;

/* Reads a whole file. In a text, the byte order mark is removed, and each line end (LF, CR or CRLF)
 * becomes LF.
 *
 * path     "-" is standard input.
 * bytes    receives the content, followed by a zero byte; the caller frees it with free().
 * size     receives the number of bytes, without the zero byte.
 * Errors   STATUS_INPUT if the file is missing, is a folder, or is not of this form; the sentence
 *          names its size, its first bytes, or the position of a zero byte in a text. STATUS_IO if
 *          reading fails. STATUS_MEMORY, naming the file. */
MUST_CHECK Status file_read(const char *path, const FileForm *form, char **bytes, size_t *size,
                            Err *err);
/* The bytes of a file in memory. */
typedef struct MemoryFile {
    const char *name; /* stands for the path */
    const void *bytes;
    size_t size;
} MemoryFile;
/* Copies the bytes of a file in memory into *bytes (owned), checked and changed as file_read does
 * with a file. Errors: those of file_read. */
MUST_CHECK Status file_read_memory(const MemoryFile *file, const FileForm *form, char **bytes,
                                   size_t *size, Err *err);
/* Adds the size and the bytes of a file to `hash`. Errors: those of file_read. */
MUST_CHECK Status file_hash(const char *path, Hash *hash, Err *err);
/* Converts bytes in memory to a text, in place, like file_read. `path` and `form` are for the error
 * sentence. Errors: STATUS_INPUT for a zero byte. */
MUST_CHECK Status file_to_text(const char *path, const FileForm *form, char *bytes, size_t *size,
                               Err *err);

/* Returns STATUS_INPUT unless `path` is a regular file: opening a pipe or device may block forever.
 */
MUST_CHECK Status file_check_regular(const char *path, Err *err);

/* A file that is being written.
 *
 * The bytes go to a temporary file in the same folder, which outfile_commit renames. A signal that
 * ends the program removes the temporary file. Standard output ("-"), devices and pipes are written
 * directly. A file that replaces another one gets its permissions and, if the system allows it, its
 * owner. A symbolic link stays; its target is written, also if the target does not exist yet. Other
 * hard links to a replaced file keep the old content. */
typedef struct OutFile {
    FILE *stream;
    char *path;      /* final name */
    char *temporary; /* path of the temporary file; NULL if the file is written directly */
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
MUST_CHECK Status outfile_check_room(const OutFile *file, double bytes, Err *err);

/* Writes all of `bytes` to `path` through an OutFile. */
MUST_CHECK Status file_write(const char *path, const void *bytes, size_t size, Err *err);
/* Writes the string of `text` to `path`; returns STATUS_MEMORY if `text` has failed. */
MUST_CHECK Status file_write_text(const char *path, const Text *text, Err *err);

/* Appends the content of a file to `text`. */
typedef Status PutContent(const void *context, Text *text, Err *err);
/* Writes what `put` appends to `path` through an OutFile, in parts, so that the content need not
 * fit into memory. Errors: those of `put`; STATUS_IO, which names the file; STATUS_MEMORY. */
MUST_CHECK Status file_write_parts(const char *path, PutContent *put, const void *context,
                                   Err *err);

/* Finds the file that writing to `path` would write: follows symbolic links in the last component.
 * The caller frees *out. Errors: STATUS_IO if the links form a circle; STATUS_MEMORY. */
MUST_CHECK Status file_resolve(const char *path, char **out, Err *err);

/* Makes an empty temporary folder beside `path`, in which another program may write. The caller
 * ends with file_forget(*folder), which removes the folder with its files; a signal that ends the
 * program does so, too. Errors: STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status file_temporary_folder(const char *path, char **folder, Err *err);
/* Registers `name` for clean-up: file_forget, or a signal that ends the program, removes the file
 * if it exists. Takes ownership of `name`, which is freed with free(), unless it fails: STATUS_IO
 * when too many are registered. */
MUST_CHECK Status file_remove_on_signal(char *name, Err *err);
/* Gives the temporary file its final name, as an OutFile does, and frees `temporary`, also on
 * failure. */
MUST_CHECK Status file_rename(char *temporary, const char *path, Err *err);
/* Removes and frees a temporary name. NULL is allowed. */
void file_forget(char *temporary);

/* Makes a folder and its missing parents; does nothing if it exists. Errors: STATUS_IO,
 * STATUS_MEMORY. */
MUST_CHECK Status file_make_folder(const char *path, Err *err);

/* Installs handlers that remove temporary files when SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE,
 * SIGXCPU or SIGXFSZ ends the program. Signals that the parent process ignored stay ignored. Only
 * main calls it, once. The table of temporary names is a global: a handler can reach nothing else.
 */
void file_clean_up_on_signals(void);
/* Registers a process group, at most 32 at a time: a signal that ends the program then kills the
 * group first, so that the group makes no more files. file_spare_on_signal cancels it. */
void file_kill_on_signal(pid_t group);
void file_spare_on_signal(pid_t group);
/* Opens /dev/null in place of standard streams that the parent process has closed, so that no file
 * opened later gets their descriptors; using such a stream fails. Only main calls it, before any
 * file is opened. */
void file_hold_standard_streams(void);

/* Returns the part of the last component of `path` after its last '.', "" if there is none;
 * borrowed from `path`. */
const char *file_extension(const char *path);
/* Replaces the extension of `path`, with its '.', by `suffix`. The caller frees *out. */
MUST_CHECK Status file_with_suffix(const char *path, const char *suffix, char **out, Err *err);
/* Joins a folder and a name: "folder/name". The caller frees *out. */
MUST_CHECK Status file_join(const char *folder, const char *name, char **out, Err *err);
/* Sets *out to the path of `name` in the folder that `path` is in; with "", to that folder with its
 * slash, or "" if `path` names none. */
MUST_CHECK Status file_beside(const char *path, const char *name, char **out, Err *err);
/* Returns the last component of `path`; borrowed from `path`. */
const char *file_name(const char *path);
/* Returns the size of a file in bytes; 0 if there is no such file. */
double file_bytes(const char *path);

#endif
