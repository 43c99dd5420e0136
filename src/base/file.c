/* Temporary names stand in a fixed table because the signal handler may call nothing but
 * async-signal-safe functions: it walks the table and unlinks. A slot is claimed by storing the
 * pointer and given up by storing NULL, each one atomic store. */
#include "base/file.h"

#include "base/memory.h"
#include "base/text.h"
#include <errno.h>
#include <limits.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

enum { MAX_TEMPORARIES = 64 };
static _Atomic(char *) temporaries[MAX_TEMPORARIES];

Status file_remove_on_signal(char *name, Err *err)
{
    for (int i = 0; i < MAX_TEMPORARIES; i++) {
        char *empty = NULL;
        if (atomic_compare_exchange_strong(&temporaries[i], &empty, name))
            return STATUS_OK;
    }
    return err_set(err, STATUS_IO, "more than %d files are being written at once", MAX_TEMPORARIES);
}

static void give_up(char *name)
{
    for (int i = 0; i < MAX_TEMPORARIES; i++) {
        char *expected = name;
        if (atomic_compare_exchange_strong(&temporaries[i], &expected, NULL))
            return;
    }
}

static void remove_temporaries(int signal_number)
{
    for (int i = 0; i < MAX_TEMPORARIES; i++) {
        char *name = atomic_load(&temporaries[i]);
        if (name)
            unlink(name);
    }
    raise(signal_number); /* SA_RESETHAND: the default action ends the program */
}

void file_clean_up_on_signals(void)
{
    struct sigaction action = {.sa_handler = remove_temporaries, .sa_flags = (int)SA_RESETHAND};
    sigemptyset(&action.sa_mask);
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++)
        sigaction(signals[i], &action, NULL);
}

static Status read_stream(FILE *stream, const char *name, char **bytes, size_t *size, Err *err)
{
    Text all = TEXT_INIT;
    char block[1 << 16];
    size_t count;
    while ((count = fread(block, 1, sizeof block, stream)) > 0)
        text_append(&all, block, count);
    Status status = text_check(&all, err);
    if (status == STATUS_OK && ferror(stream))
        status = err_set(err, STATUS_IO, "%s: reading failed: %s", name, strerror(errno));
    if (status == STATUS_OK && !all.chars)
        status = mem_calloc(&all.chars, 1, 1, "bytes of text", err);
    if (status != STATUS_OK) {
        text_release(&all);
        return status;
    }
    *bytes = all.chars;
    *size = all.length;
    return STATUS_OK;
}

Status file_read(const char *path, char **bytes, size_t *size, Err *err)
{
    if (strcmp(path, "-") == 0)
        return read_stream(stdin, "standard input", bytes, size, err);
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return err_set(err, errno == ENOENT || errno == ENOTDIR ? STATUS_INPUT : STATUS_IO,
                       "%s: cannot be read: %s", path, strerror(errno));
    struct stat about;
    Status status;
    if (fstat(fileno(stream), &about) == 0 && S_ISDIR(about.st_mode))
        status = err_set(err, STATUS_INPUT, "%s: is a folder, not a file", path);
    else
        status = read_stream(stream, path, bytes, size, err);
    fclose(stream);
    return status;
}

const char *file_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

const char *file_extension(const char *path)
{
    const char *name = file_name(path);
    const char *dot = strrchr(name, '.');
    return dot && dot != name ? dot + 1 : "";
}

static Status format_owned(char **out, Err *err, const char *format, ...) PRINTF_LIKE(3, 4);
static Status format_owned(char **out, Err *err, const char *format, ...)
{
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    char *text = NULL;
    Status status = mem_calloc(&text, (size_t)length + 1, 1, "bytes of text", err);
    if (status == STATUS_OK)
        vsnprintf(text, (size_t)length + 1, format, again);
    va_end(again);
    if (status == STATUS_OK)
        *out = text;
    return status;
}

Status file_with_suffix(const char *path, const char *suffix, char **out, Err *err)
{
    const char *extension = file_extension(path);
    size_t stem = *extension ? (size_t)(extension - 1 - path) : strlen(path);
    return format_owned(out, err, "%.*s%s", (int)stem, path, suffix);
}

Status file_join(const char *folder, const char *name, char **out, Err *err)
{
    size_t length = strlen(folder);
    const char *slash = length && folder[length - 1] == '/' ? "" : "/";
    return format_owned(out, err, "%s%s%s", folder, slash, name);
}

Status file_temporary(const char *path, char **temporary, Err *err)
{
    const char *extension = file_extension(path);
    const char *dot = *extension ? extension - 1 : "";
    char *name = NULL;
    TRY(format_owned(&name, err, "%.*s.%s.XXXXXX%s", (int)(file_name(path) - path), path,
                     file_name(path), dot));
    int handle = mkstemps(name, (int)strlen(dot));
    if (handle < 0) {
        Status status = err_set(err, STATUS_IO, "%s: cannot be written: %s", path, strerror(errno));
        free(name);
        return status;
    }
    mode_t mask = umask(0);
    umask(mask);
    fchmod(handle, 0666 & ~mask);
    close(handle);
    Status status = file_remove_on_signal(name, err);
    if (status != STATUS_OK) {
        unlink(name);
        free(name);
        return status;
    }
    *temporary = name;
    return STATUS_OK;
}

Status file_rename(char *temporary, const char *path, Err *err)
{
    Status status = STATUS_OK;
    if (rename(temporary, path) != 0) {
        status = err_set(err, STATUS_IO, "%s: cannot be written: %s", path, strerror(errno));
        unlink(temporary);
    }
    give_up(temporary);
    free(temporary);
    return status;
}

void file_forget(char *temporary)
{
    if (!temporary)
        return;
    unlink(temporary);
    give_up(temporary);
    free(temporary);
}

/* A symbolic link keeps pointing where it did: its target is what gets written. */
static Status final_path(const char *path, char **out, Err *err)
{
    char *resolved = realpath(path, NULL);
    if (resolved) {
        *out = resolved;
        return STATUS_OK;
    }
    return mem_strdup(out, path, err);
}

Status outfile_open(OutFile *file, const char *path, Err *err)
{
    OutFile opened = {0};
    Status status = STATUS_OK;
    if (strcmp(path, "-") == 0) {
        TRY(mem_strdup(&opened.path, path, err));
        opened.stream = stdout;
        *file = opened;
        return STATUS_OK;
    }
    TRY(final_path(path, &opened.path, err));
    struct stat about;
    bool exists = stat(opened.path, &about) == 0;
    if (exists && S_ISDIR(about.st_mode)) {
        status = err_set(err, STATUS_IO, "%s: cannot be written: it is a folder", path);
    } else if (exists && !S_ISREG(about.st_mode)) {
        opened.stream = fopen(opened.path, "wb");
    } else {
        status = file_temporary(opened.path, &opened.temporary, err);
        if (status == STATUS_OK)
            opened.stream = fopen(opened.temporary, "wb");
    }
    if (status == STATUS_OK && !opened.stream)
        status = err_set(err, STATUS_IO, "%s: cannot be written: %s", path, strerror(errno));
    if (status != STATUS_OK) {
        file_forget(opened.temporary);
        free(opened.path);
        return status;
    }
    *file = opened;
    return STATUS_OK;
}

Status outfile_commit(OutFile *file, Err *err)
{
    Status status = STATUS_OK;
    bool broken = fflush(file->stream) != 0 || ferror(file->stream);
    if (file->stream != stdout)
        broken = fclose(file->stream) != 0 || broken;
    if (broken)
        status = err_set(err, STATUS_IO, "%s: writing failed: %s",
                         strcmp(file->path, "-") ? file->path : "standard output", strerror(errno));
    if (file->temporary) {
        if (status == STATUS_OK)
            status = file_rename(file->temporary, file->path, err);
        else
            file_forget(file->temporary);
    }
    free(file->path);
    *file = (OutFile){0};
    return status;
}

void outfile_discard(OutFile *file)
{
    if (file->stream && file->stream != stdout)
        fclose(file->stream);
    file_forget(file->temporary);
    free(file->path);
    *file = (OutFile){0};
}

Status outfile_check_room(const OutFile *file, double bytes, Err *err)
{
    struct statvfs disk;
    if (!file->temporary || fstatvfs(fileno(file->stream), &disk) != 0)
        return STATUS_OK;
    double left = (double)disk.f_bavail * (double)disk.f_frsize;
    if (bytes <= left)
        return STATUS_OK;
    return err_set(err, STATUS_IO, "%s: needs %.1f GB, and its disk has %.1f GB left", file->path,
                   bytes * 1e-9, left * 1e-9);
}

Status file_write(const char *path, const void *bytes, size_t size, Err *err)
{
    OutFile file;
    TRY(outfile_open(&file, path, err));
    fwrite(bytes, 1, size, file.stream);
    return outfile_commit(&file, err);
}

Status file_make_folder(const char *path, Err *err)
{
    char *partial = NULL;
    TRY(mem_strdup(&partial, path, err));
    Status status = STATUS_OK;
    for (char *at = partial + 1;; at++) {
        if (*at != '/' && *at != '\0')
            continue;
        char end = *at;
        *at = '\0';
        if (mkdir(partial, 0777) != 0 && errno != EEXIST) {
            status =
                err_set(err, STATUS_IO, "%s: the folder cannot be made: %s", path, strerror(errno));
            break;
        }
        *at = end;
        if (!end)
            break;
    }
    struct stat about;
    if (status == STATUS_OK && (stat(path, &about) != 0 || !S_ISDIR(about.st_mode)))
        status =
            err_set(err, STATUS_IO, "%s: the folder cannot be made: a file has that name", path);
    free(partial);
    return status;
}
