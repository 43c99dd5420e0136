/* Reads whole files, and writes files so that a run that fails changes none.
 *
 * A file is written under a temporary name beside its final name, and renamed when it is complete.
 * A run that fails or is killed therefore leaves the old file unchanged.
 *
 * Temporary names are in a fixed table, because a signal handler may call only async-signal-safe
 * functions: it walks the table and unlinks the files. A slot is claimed by storing the pointer and
 * released by storing NULL, each one atomic store.
 *
 * Large files are read in slices in parallel, up to the size that the file system states, as long
 * as bytes arrive and contain no fault. A second, sequential loop reads the rest block by block. It
 * is the only code that refuses anything. */
#include "base/file.h"

#include "base/memory.h"
#include "base/number.h"
#include "base/system.h"
#include "base/threads.h"
#include <assert.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/wait.h>
#include <unistd.h>

/* Maximum number of temporary files that are open at once, and of process groups that run at once.
 * The program needs a few of each; more are refused or, for process groups, not killed on a signal.
 */
enum { MAX_TEMPORARIES = 64, MAX_GROUPS = 32 };
static _Atomic(char *) temporaries[MAX_TEMPORARIES];
static _Atomic pid_t groups[MAX_GROUPS]; /* to be killed; 0: none */

Status file_remove_on_signal(char *name, Err *err)
{
    for (int i = 0; i < MAX_TEMPORARIES; i++) {
        char *empty = NULL;
        if (atomic_compare_exchange_strong(&temporaries[i], &empty, name))
            return STATUS_OK;
    }
    return err_set(err, STATUS_IO, "more than %d files are being written at once", MAX_TEMPORARIES);
}

/* Removes a name from the table of temporary names. */
static void forget_temporary(char *name)
{
    for (int i = 0; i < MAX_TEMPORARIES; i++) {
        char *expected = name;
        if (atomic_compare_exchange_strong(&temporaries[i], &expected, NULL))
            return;
    }
}

/* Removes a temporary folder and the files in it: a program that was given the folder may have
 * written more files than expected. Calls only functions that a signal handler may call. */
static void remove_folder(const char *name)
{
    int folder = open(name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (folder < 0)
        return;
    system_unlink_files(folder);
    close(folder);
    rmdir(name);
}

/* The signal handler: kills the registered process groups, removes the temporary files and folders,
 * and ends the program. */
static void remove_temporaries(int signal_number)
{
    for (int i = 0; i < MAX_GROUPS; i++) {
        pid_t group = atomic_load(&groups[i]);
        if (group > 0 && kill(-group, SIGKILL) == 0)
            waitpid(group, NULL, 0);
    }
    for (int i = 0; i < MAX_TEMPORARIES; i++) {
        char *name = atomic_load(&temporaries[i]);
        if (name)
            unlink(name);
    }
    for (int i = 0; i < MAX_TEMPORARIES; i++) {
        char *name = atomic_load(&temporaries[i]);
        if (name)
            remove_folder(name);
    }
    raise(signal_number); /* SA_RESETHAND: the default action ends the program */
}

/* Replaces the process group `before` in the table by `now`. */
static void replace_group(pid_t before, pid_t now)
{
    int i = 0;
    for (pid_t expected = before;
         i < MAX_GROUPS && !atomic_compare_exchange_strong(&groups[i], &expected, now); i++)
        expected = before;
    assert(i < MAX_GROUPS);
}

void file_kill_on_signal(pid_t group)
{
    replace_group(0, group);
}

void file_spare_on_signal(pid_t group)
{
    replace_group(group, 0);
}

void file_clean_up_on_signals(void)
{
    struct sigaction action = {.sa_handler = remove_temporaries, .sa_flags = (int)SA_RESETHAND};
    sigemptyset(&action.sa_mask);
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXCPU, SIGXFSZ};
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) {
        struct sigaction before;
        if (sigaction(signals[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(signals[i], &action, NULL);
    }
}

/* open() takes the lowest free number, and a stream open the wrong way round fails when it
 * is used. */
void file_hold_standard_streams(void)
{
    for (int handle = STDIN_FILENO; handle <= STDERR_FILENO; handle++)
        if (fcntl(handle, F_GETFD) < 0 &&
            open("/dev/null", handle == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0)
            return;
}

/* Converts every line end to LF. Removes a byte order mark, and the Control-Z that CP/M and DOS
 * wrote at the end of a text, with the blanks after it. */
static void tidy_lines(char *bytes, size_t *size)
{
    enum { CONTROL_Z = 0x1a };
    static const char byte_order_mark[] = "\xef\xbb\xbf";
    char *from = bytes, *to = bytes, *end = bytes + *size;
    if (strncmp(bytes, byte_order_mark, 3) == 0)
        from += 3;
    for (;;) {
        char *cr = memchr(from, '\r', (size_t)(end - from));
        size_t run = (size_t)((cr ? cr : end) - from);
        if (to != from)
            memmove(to, from, run);
        to += run;
        if (!cr)
            break;
        *to++ = '\n';
        from = cr + 1;
        from += *from == '\n';
    }
    char *last = to;
    while (last > bytes && strchr(" \t\n", last[-1]))
        last--;
    while (last > bytes && last[-1] == CONTROL_Z)
        to = --last;
    *to = '\0';
    *size = (size_t)(to - bytes);
}

Status file_to_text(const char *path, const FileForm *form, char *bytes, size_t *size, Err *err)
{
    const char *zero = memchr(bytes, '\0', *size);
    if (zero)
        *size = (size_t)(zero - bytes);
    tidy_lines(bytes, size);
    if (!zero)
        return STATUS_OK;
    size_t line = 1;
    for (const char *at = bytes; (at = strchr(at, '\n')); at++)
        line++;
    return err_set(err, STATUS_INPUT, "%s:%zu: a zero byte; %s is plain text", path, line,
                   form->name);
}

static Status check_size(const char *name, const FileForm *form, double bytes, Err *err)
{
    char most[BYTES_TEXT_SIZE];
    if (bytes <= form->most_bytes)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "%s: is larger than %s, the most that %s may have", name,
                   bytes_text(form->most_bytes, most), form->name);
}

/* Number of bytes that are read at a time where the size of the file is unknown. */
enum { BLOCK = 1 << 16 };

/* The bytes of a stream, with space for a zero after them. */
typedef struct Bytes {
    char *at; /* owned */
    size_t n, capacity;
} Bytes;

/* Puts the file's name in front of the sentence of memory that ran out. */
static Status named(const char *name, Status status, Err *err)
{
    if (status == STATUS_MEMORY)
        err_prefix(err, "%s: ", name);
    return status;
}

/* Sets the size of a regular file in bytes; 0 for a pipe or device, whose size is unknown. */
static Status find_size(FILE *stream, const char *name, const FileForm *form, size_t *size,
                        Err *err)
{
    struct stat about;
    bool is_file = fstat(fileno(stream), &about) == 0 && S_ISREG(about.st_mode);
    *size = is_file ? (size_t)about.st_size : 0;
    return check_size(name, form, (double)*size, err);
}

static Status reserve(Bytes *all, size_t n, const char *name, Err *err)
{
    return named(name, mem_reserve(&all->at, &all->capacity, n + BLOCK + 1, 1, "bytes", err), err);
}

/* Minimum size of a slice, 4 MB, which takes far longer to read than a thread takes to start; and
 * maximum number of slices, which is that of threads. */
enum { SLICE = 1 << 22, MOST_SLICES = 256 };

/* Bytes of a file that threads read in slices of equal size. */
typedef struct Slices {
    int handle;
    char *bytes; /* receives all bytes */
    off_t from;  /* offset of the first byte in the file */
    size_t n, slice;
    bool is_text;
    size_t sound[MOST_SLICES]; /* per slice: number of bytes read; 0 for a text with a zero byte */
} Slices;

static void read_slice(size_t index, int worker, void *context)
{
    (void)worker;
    Slices *slices = context;
    size_t begin = index * slices->slice, left = slices->n - begin, n = 0;
    size_t most = left < slices->slice ? left : slices->slice;
    char *bytes = slices->bytes + begin;
    while (n < most) {
        ssize_t count =
            pread(slices->handle, bytes + n, most - n, slices->from + (off_t)(begin + n));
        if (count <= 0)
            break;
        n += (size_t)count;
    }
    slices->sound[index] = slices->is_text && memchr(bytes, '\0', n) ? 0 : n;
}

/* Reads the rest of a file of `size` bytes, up to the first slice that is incomplete or has a
 * fault, and moves the stream there. */
static void read_slices(FILE *stream, const FileForm *form, Bytes *all, size_t size)
{
    off_t from = ftello(stream);
    if (from < 0 || (size_t)from + SLICE >= size)
        return;
    size_t n = size - (size_t)from, slice = n / MOST_SLICES + 1;
    Slices slices = {.handle = fileno(stream),
                     .bytes = all->at + all->n,
                     .from = from,
                     .n = n,
                     .slice = slice < SLICE ? SLICE : slice,
                     .is_text = form->is_text};
    threads_for((slices.n + slices.slice - 1) / slices.slice, 0, read_slice, &slices);
    size_t k = 0, sound = 0;
    do
        sound += slices.sound[k];
    while (slices.sound[k++] == slices.slice && k < MOST_SLICES);
    if (fseeko(stream, from + (off_t)sound, SEEK_SET) == 0)
        all->n += sound;
}

/* Reads a stream block by block, and refuses it at the first block that does not fit the form.
 * After the first block, memory for the whole file is reserved, so that the bytes need not move
 * when the buffer grows. */
static Status read_blocks(FILE *stream, const char *name, const FileForm *form, Bytes *all,
                          Err *err)
{
    size_t count, size;
    bool has_zero = false;
    TRY(find_size(stream, name, form, &size, err));
    do {
        if (all->n > 0 && size > all->capacity)
            TRY(mem_check((double)size, name, err));
        TRY(reserve(all, all->n > 0 && size > all->n ? size : all->n, name, err));
        if (all->n == BLOCK && size > 0)
            read_slices(stream, form, all, size);
        TRY(reserve(all, all->n, name, err));
        char *block = all->at + all->n;
        count = fread(block, 1, BLOCK, stream);
        block[count] = '\0';
        if (all->n == 0 && form->begins && !form->begins(block, count))
            return err_set(err, STATUS_INPUT, "%s: is not %s", name, form->name);
        all->n += count;
        TRY(check_size(name, form, (double)all->n, err));
        has_zero = form->is_text && memchr(block, '\0', count);
    } while (count > 0 && !has_zero);
    if (ferror(stream))
        return err_set(err, STATUS_IO, "%s: reading failed: %s", name, strerror(errno));
    if (has_zero)
        return file_to_text(name, form, all->at, &all->n, err);
    if (form->is_text)
        tidy_lines(all->at, &all->n);
    return STATUS_OK;
}

/* Reads all bytes of a stream. */
static Status read_stream(FILE *stream, const char *name, const FileForm *form, char **bytes,
                          size_t *size, Err *err)
{
    Bytes all = {0};
    Status status;
    TRY_GOTO(read_blocks(stream, name, form, &all, err));
    *bytes = all.at;
    *size = all.n;
    return STATUS_OK;
done:
    free(all.at);
    return status;
}

Status file_read_memory(const MemoryFile *file, const FileForm *form, char **bytes, size_t *size,
                        Err *err)
{
    FILE *stream = fmemopen((void *)(uintptr_t)file->bytes, file->size, "r");
    if (!stream)
        return mem_out_of("to read", file->name, err);
    Status status = read_stream(stream, file->name, form, bytes, size, err);
    fclose(stream);
    return status;
}

Status file_read(const char *path, const FileForm *form, char **bytes, size_t *size, Err *err)
{
    if (strcmp(path, "-") == 0)
        return read_stream(stdin, "standard input", form, bytes, size, err);
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return err_set(err, errno == ENOENT || errno == ENOTDIR ? STATUS_INPUT : STATUS_IO,
                       "%s: cannot be read: %s", path, strerror(errno));
    struct stat about;
    Status status;
    if (fstat(fileno(stream), &about) == 0 && S_ISDIR(about.st_mode))
        status = err_set(err, STATUS_INPUT, "%s: is a folder, not a file", path);
    else
        status = read_stream(stream, path, form, bytes, size, err);
    fclose(stream);
    return status;
}

Status file_hash(const char *path, Hash *hash, Err *err)
{
    static const FileForm any = {.name = "a file", .most_bytes = 16e9};
    char *bytes = NULL;
    size_t size = 0;
    TRY(file_read(path, &any, &bytes, &size, err));
    hash_add(hash, &size, sizeof size);
    hash_add(hash, bytes, size);
    free(bytes);
    return STATUS_OK;
}

Status file_check_regular(const char *path, Err *err)
{
    struct stat about;
    if (stat(path, &about) != 0)
        return err_set(err, STATUS_INPUT, "%s: cannot be read: %s", path, strerror(errno));
    if (S_ISREG(about.st_mode))
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "%s: is a %s, not a file", path,
                   S_ISDIR(about.st_mode) ? "folder" : "pipe or a device");
}

double file_bytes(const char *path)
{
    struct stat about;
    return stat(path, &about) == 0 ? (double)about.st_size : 0;
}

/* The name of a temporary file or folder. It is short, so it fits in any file system. */
static const char temporary_name[] = ".corcast.XXXXXX";

/* Frees `name` on failure. */
static Status keep_temporary(char *name, bool made, const char *path, Err *err)
{
    Status status =
        made ? file_remove_on_signal(name, err)
             : err_set(err, STATUS_IO, "%s: cannot be written: %s", path, strerror(errno));
    if (status != STATUS_OK) {
        if (made)
            remove(name);
        free(name);
    }
    return status;
}

/* Creates an empty file with a temporary name beside `path`. */
static Status temporary_file(const char *path, char **temporary, Err *err)
{
    char *name = NULL;
    TRY(file_beside(path, temporary_name, &name, err));
    int handle = mkstemp(name);
    if (handle >= 0)
        close(handle);
    /* mkstemp lets only the owner read, as long as an old file is to be replaced. A new file gets
     * its permissions by the umask, which the kernel applies: to read the umask is to change it,
     * and that for all threads. */
    struct stat old;
    if (handle >= 0 && stat(path, &old) != 0) {
        unlink(name);
        handle = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (handle >= 0)
            close(handle);
    }
    TRY(keep_temporary(name, handle >= 0, path, err));
    *temporary = name;
    return STATUS_OK;
}

Status file_temporary_folder(const char *path, char **folder, Err *err)
{
    char *name = NULL;
    TRY(file_beside(path, temporary_name, &name, err));
    TRY(keep_temporary(name, mkdtemp(name) != NULL, path, err));
    *folder = name;
    return STATUS_OK;
}

/* Gives the file the owner and the permissions of the file at `path`, if there is one. The owner is
 * set first, because changing it may remove permissions. If not even the group can be set, the
 * group gets no permissions. */
static void take_after(const char *temporary, const char *path)
{
    struct stat old;
    if (stat(path, &old) != 0)
        return;
    bool kept = chown(temporary, old.st_uid, old.st_gid) == 0 ||
                chown(temporary, (uid_t)-1, old.st_gid) == 0;
    chmod(temporary, old.st_mode & (kept ? 0777 : 0707));
}

Status file_rename(char *temporary, const char *path, Err *err)
{
    Status status = STATUS_OK;
    take_after(temporary, path);
    if (rename(temporary, path) != 0) {
        status = err_set(err, STATUS_IO, "%s: cannot be written: %s", path, strerror(errno));
        unlink(temporary);
    }
    forget_temporary(temporary);
    free(temporary);
    return status;
}

void file_discard_temporary(char *temporary)
{
    if (!temporary)
        return;
    if (remove(temporary) != 0)
        remove_folder(temporary);
    forget_temporary(temporary);
    free(temporary);
}

/* Returns true if the path is written directly: a device or a pipe. */
static bool is_direct(const char *path)
{
    struct stat about;
    return stat(path, &about) == 0 && !S_ISREG(about.st_mode) && !S_ISDIR(about.st_mode);
}

/* Devices and pipes stay as they are: links such as /dev/stdout lead to no path. */
Status file_resolve(const char *path, char **out, Err *err)
{
    enum { MAX_LINKS = 40 }; /* as many as Linux follows */
    char *at = NULL, target[PATH_MAX];
    TRY(mem_strdup(&at, path, err));
    for (int links = 0; links < MAX_LINKS; links++) {
        ssize_t length = is_direct(at) ? -1 : readlink(at, target, sizeof target - 1);
        if (length < 0) {
            *out = at;
            return STATUS_OK;
        }
        target[length] = '\0';
        char *next = NULL;
        Status status =
            target[0] == '/' ? mem_strdup(&next, target, err) : file_beside(at, target, &next, err);
        free(at);
        TRY(status);
        at = next;
    }
    free(at);
    return err_set(err, STATUS_IO, "%s: cannot be written: %s", path, strerror(ELOOP));
}

/* Returns true if new files can be made in the folder of `path`; if not, errno has the reason. */
static bool takes_files(const char *path)
{
    char folder[PATH_MAX];
    size_t length = (size_t)(file_name(path) - path);
    errno = ENAMETOOLONG;
    if (length >= sizeof folder)
        return false;
    memcpy(folder, path, length);
    folder[length] = '\0';
    return access(length ? folder : ".", W_OK | X_OK) == 0;
}

/* Returns the errno value why `path`, which is no link, cannot be written; 0 if it can. */
static int reason_against(const char *path)
{
    struct stat about;
    if (stat(path, &about) == 0) {
        if (S_ISDIR(about.st_mode))
            return EISDIR;
        if (access(path, W_OK) != 0)
            return errno;
        if (!S_ISREG(about.st_mode))
            return 0;
    } else if (errno != ENOENT) {
        return errno;
    }
    return takes_files(path) ? 0 : errno;
}

Status outfile_check(const char *path, Err *err)
{
    if (strcmp(path, "-") == 0)
        return STATUS_OK;
    char *final = NULL;
    TRY(file_resolve(path, &final, err));
    int reason = reason_against(final);
    free(final);
    if (reason == 0)
        return STATUS_OK;
    return err_set(err, STATUS_IO, "%s: cannot be written: %s", path,
                   reason == EISDIR ? "it is a folder" : strerror(reason));
}

Status outfile_open(OutFile *file, const char *path, Err *err)
{
    OutFile opened = {0};
    if (strcmp(path, "-") == 0) {
        TRY(mem_strdup(&opened.path, path, err));
        opened.stream = stdout;
        *file = opened;
        return STATUS_OK;
    }
    TRY(outfile_check(path, err));
    TRY(file_resolve(path, &opened.path, err));
    Status status = STATUS_OK;
    if (!is_direct(opened.path))
        TRY_GOTO(temporary_file(opened.path, &opened.temporary, err));
    opened.stream = fopen(opened.temporary ? opened.temporary : opened.path, "wb");
    if (!opened.stream)
        TRY_GOTO(err_set(err, STATUS_IO, "%s: cannot be written: %s", path, strerror(errno)));
    *file = opened;
    return STATUS_OK;
done:
    file_discard_temporary(opened.temporary);
    free(opened.path);
    return status;
}

/* Closes the stream. Errors: STATUS_IO if some bytes were not written. */
static Status close_stream(OutFile *file, Err *err)
{
    bool broken = fflush(file->stream) != 0 || ferror(file->stream);
    if (file->stream != stdout)
        broken = fclose(file->stream) != 0 || broken;
    file->stream = NULL;
    if (!broken)
        return STATUS_OK;
    return err_set(err, STATUS_IO, "%s: writing failed: %s",
                   strcmp(file->path, "-") ? file->path : "standard output", strerror(errno));
}

/* Gives the file its name. */
static Status take_name(OutFile *file, Err *err)
{
    char *temporary = file->temporary;
    file->temporary = NULL;
    return temporary ? file_rename(temporary, file->path, err) : STATUS_OK;
}

Status outfile_commit(OutFile *file, Err *err)
{
    Status status = STATUS_OK;
    TRY_GOTO(close_stream(file, err));
    status = take_name(file, err);
done:
    outfile_discard(file);
    return status;
}

/* Makes a second name (a hard link) for the file that is at the final path. *spare receives the
 * name, which the caller frees, or NULL if there is no such file. */
static Status keep_old(const OutFile *file, char **spare, Err *err)
{
    if (!file->temporary || access(file->path, F_OK) != 0)
        return STATUS_OK;
    char *name = NULL;
    TRY(temporary_file(file->path, &name, err));
    if (unlink(name) == 0 && link(file->path, name) == 0) {
        *spare = name;
        return STATUS_OK;
    }
    file_discard_temporary(name);
    return STATUS_OK;
}

/* Undoes take_name: gives the old file, whose second name is `spare`, its name back. Frees `spare`.
 */
static void bring_back(const char *path, char *spare)
{
    if (!spare) {
        remove(path);
    } else if (rename(spare, path) == 0) {
        forget_temporary(spare);
        free(spare);
    } else {
        file_discard_temporary(spare);
    }
}

/* Commits the last of the files after the others, so that each can still be undone. */
static Status take_names(OutFile *files, size_t n, Err *err)
{
    char *spare = NULL;
    if (n == 1)
        return take_name(files, err);
    TRY(keep_old(files, &spare, err));
    bool is_new = access(files->path, F_OK) != 0, named = files->temporary;
    Status status;
    TRY_GOTO(take_name(files, err));
    status = take_names(files + 1, n - 1, err);
    if (status != STATUS_OK && named && (spare || is_new)) {
        bring_back(files->path, spare);
        spare = NULL;
    }
done:
    file_discard_temporary(spare);
    return status;
}

Status outfiles_commit(OutFile *files, size_t n, Err *err)
{
    Status status = STATUS_OK;
    for (size_t i = 0; i < n; i++)
        TRY_GOTO(close_stream(&files[i], err));
    status = take_names(files, n, err);
done:
    for (size_t i = 0; i < n; i++)
        outfile_discard(&files[i]);
    return status;
}

void outfile_discard(OutFile *file)
{
    if (file->stream && file->stream != stdout)
        fclose(file->stream);
    file_discard_temporary(file->temporary);
    free(file->path);
    *file = (OutFile){0};
}

Status outfile_check_space(const OutFile *file, double bytes, Err *err)
{
    struct statvfs disk;
    if (!file->temporary || fstatvfs(fileno(file->stream), &disk) != 0)
        return STATUS_OK;
    double left = (double)disk.f_bavail * (double)disk.f_frsize;
    if (bytes <= left)
        return STATUS_OK;
    char needs[BYTES_TEXT_SIZE], has[BYTES_TEXT_SIZE];
    return err_set(err, STATUS_IO, "%s: needs at least %s, and its disk has %s left", file->path,
                   bytes_text(bytes, needs), bytes_text(left, has));
}

Status file_write(const char *path, const void *bytes, size_t size, Err *err)
{
    OutFile file;
    TRY(outfile_open(&file, path, err));
    fwrite(bytes, 1, size, file.stream);
    return outfile_commit(&file, err);
}

Status file_write_text(const char *path, const Text *text, Err *err)
{
    TRY(text_check(text, err));
    return file_write(path, text_chars(text), text->length, err);
}

Status file_write_parts(const char *path, PutContent *put, const void *context, Err *err)
{
    OutFile file;
    TRY(outfile_open(&file, path, err));
    Text text = TEXT_TO(file.stream);
    Status status = STATUS_OK;
    TRY_GOTO(put(context, &text, err));
    status = text_flush(&text, err);
done:
    text_release(&text);
    if (status == STATUS_IO)
        err_prefix(err, "%s: ", strcmp(path, "-") == 0 ? "standard output" : path);
    if (status != STATUS_OK) {
        outfile_discard(&file);
        return status;
    }
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
        if (mkdir(partial, 0777) != 0 && errno != EEXIST)
            TRY_GOTO(err_set(err, STATUS_IO, "%s: the folder cannot be made: %s", path,
                             strerror(errno)));
        *at = end;
        if (!end)
            break;
    }
    struct stat about;
    if (stat(path, &about) != 0 || !S_ISDIR(about.st_mode))
        status =
            err_set(err, STATUS_IO, "%s: the folder cannot be made: a file has that name", path);
done:
    free(partial);
    return status;
}
