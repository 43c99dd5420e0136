/* Whole-file reading, and writing that never leaves half a file under the final name. */
#ifndef CORCAST_BASE_FILE_H
#define CORCAST_BASE_FILE_H

#include "base/hash.h"
#include "base/text.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/types.h>

/* What a file that is read whole may be. */
typedef struct FileForm {
    const char *name;                                /* "an SWC file" */
    double most_bytes;                               /* a larger one is refused */
    bool is_text;                                    /* it holds no zero byte */
    bool (*begins)(const char *start, size_t count); /* whether one may begin so; NULL: anyhow */
} FileForm;

/* Reads all of `path` ("-": standard input) into *bytes (owned), zero-terminated; *size does not
 * count that zero. Of a text the byte order mark is left out, and every line end (LF, CR or CRLF)
 * is LF. STATUS_INPUT when the file is missing, a folder, or not of its form: the sentence names
 * its size, its first bytes or the first zero byte of a text; STATUS_IO when it cannot be read;
 * STATUS_MEMORY naming the file. */
MUST_CHECK Status file_read(const char *path, const FileForm *form, char **bytes, size_t *size,
                            Err *err);
/* Copies what the bytes of a file in memory are into *bytes, as file_read does for a file. `name`
 * is for the sentences. Errors: as file_read. */
MUST_CHECK Status file_read_memory(const void *from, size_t from_size, const char *name,
                                   const FileForm *form, char **bytes, size_t *size, Err *err);
/* Adds the size and the bytes of a file to `hash`. Errors as file_read. */
MUST_CHECK Status file_hash(const char *path, Hash *hash, Err *err);
/* Makes a text of what was read as bytes, as file_read does; `path` and `form` are for the
 * sentence. */
MUST_CHECK Status file_to_text(const char *path, const FileForm *form, char *bytes, size_t *size,
                               Err *err);

/* STATUS_INPUT unless `path` is a regular file: opening a pipe or a device may block for ever. */
MUST_CHECK Status file_check_regular(const char *path, Err *err);

/* A file being written. What is written to `stream` goes to a temporary neighbour and takes the
 * final name only in outfile_commit; a signal that ends the program removes the neighbour. "-" is
 * standard output; a device or pipe is written directly. What is written over a file takes its
 * permissions and, where the system lets it, its owner; a symbolic link stays and its target is
 * written, also where that is not there yet. Other hard links of the file keep what they hold. */
typedef struct OutFile {
    FILE *stream;
    char *path;      /* final name */
    char *temporary; /* NULL when written directly */
} OutFile;

/* STATUS_IO when outfile_open would refuse `path`: no folder, no permission, a folder itself, a
 * link that leads to itself. Writes nothing. */
MUST_CHECK Status outfile_check(const char *path, Err *err);

/* Opens *file for writing to `path`. STATUS_IO as outfile_check. Every opened file ends with
 * exactly one of outfile_commit, which gives it its final name, and outfile_discard, which removes
 * it; both release `file`, also on failure. */
MUST_CHECK Status outfile_open(OutFile *file, const char *path, Err *err);
MUST_CHECK Status outfile_commit(OutFile *file, Err *err);
void outfile_discard(OutFile *file);
/* Commits n files, all or none: what stood under their names before stands there again when one of
 * them cannot take its name (where the file system has no hard links, only if that is the first).
 * Releases all of them, also on failure. */
MUST_CHECK Status outfiles_commit(OutFile *files, size_t n, Err *err);

/* STATUS_IO when the disk that `file` goes to has fewer than `bytes` left; always STATUS_OK for
 * what is no file. */
MUST_CHECK Status outfile_check_room(const OutFile *file, double bytes, Err *err);

/* Writes all of `bytes` to `path` through an OutFile. */
MUST_CHECK Status file_write(const char *path, const void *bytes, size_t size, Err *err);
/* Likewise the characters of `text`, or STATUS_MEMORY when it failed. */
MUST_CHECK Status file_write_text(const char *path, const Text *text, Err *err);

/* The file that writing to `path` writes, in *out (owned): the path with symbolic links of its last
 * component followed. STATUS_IO when they lead in a circle. */
MUST_CHECK Status file_resolve(const char *path, char **out, Err *err);

/* A new empty folder beside `path`, for another program to write to, in *folder (owned).
 * file_forget, or a signal that ends the program, removes it with all files in it. */
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

/* Makes a folder and its missing parents. */
MUST_CHECK Status file_make_folder(const char *path, Err *err);

/* Removes temporary files when SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXCPU or SIGXFSZ ends
 * the program; signals that the caller ignores stay ignored. main calls it once; the table of
 * temporary names is a global, because a handler reaches nothing else. */
void file_clean_up_on_signals(void);
/* Has a signal that ends the program kill this process group first, so that it makes no more files;
 * at most eight at a time. The other takes it out again. */
void file_kill_on_signal(pid_t group);
void file_spare_on_signal(pid_t group);
/* Occupies standard streams that the caller has closed, so that no file opened later takes their
 * place; using them fails. main calls it once, before any file is opened. */
void file_hold_standard_streams(void);

/* The text after the last '.' of the last component of `path`, "" when there is none. */
const char *file_extension(const char *path);
/* `path` without that '.' and extension, and with `suffix` appended, in *out (owned). */
MUST_CHECK Status file_with_suffix(const char *path, const char *suffix, char **out, Err *err);
/* folder/name in *out (owned). */
MUST_CHECK Status file_join(const char *folder, const char *name, char **out, Err *err);
/* The last component of `path`. Borrowed. */
const char *file_name(const char *path);
/* The size of the file in bytes; 0 when there is none. */
double file_bytes(const char *path);

#endif
