/* Registers the files that a command reads and writes, and detects conflicts. All files of a
 * command line are in one list, which is searched for each file that is added, because a command
 * line names few files. An existing file is identified by its device and inode. A file that does
 * not exist yet is identified by the device and inode of its folder, and by its name. */
#include "options/files.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef enum FileState { FILE_THERE, FILE_NOT_YET, FILE_ANY } FileState;

struct FileUse {
    char role[32];
    char *path; /* as given; owned */
    char *name; /* FILE_NOT_YET: last component; owned, else NULL */
    bool written;
    FileState state;
    dev_t device; /* of the file, or of the folder that it will be in */
    ino_t inode;
};

static void release_use(FileUse *use)
{
    free(use->path);
    free(use->name);
}

void files_release(Files *files)
{
    for (size_t i = 0; i < files->n; i++)
        release_use(&files->uses[i]);
    free(files->uses);
    *files = (Files){0};
}

static bool is_standard(const FileUse *use)
{
    return strcmp(use->path, "-") == 0;
}

/* Identifies a file that does not exist yet, after resolving links. */
static Status identify_new(FileUse *use, Err *err)
{
    char *final = NULL;
    struct stat about;
    TRY(file_resolve(use->path, &final, err));
    Status status = mem_strdup(&use->name, file_name(final), err);
    final[file_name(final) - final] = '\0';
    if (status == STATUS_OK && stat(*final ? final : ".", &about) == 0) {
        use->state = FILE_NOT_YET;
        use->device = about.st_dev;
        use->inode = about.st_ino;
    }
    free(final);
    return status;
}

/* Finds what identifies the file. Devices, pipes and missing inputs have no identity, so they never
 * conflict. */
static Status identify(FileUse *use, Err *err)
{
    struct stat about;
    use->state = FILE_ANY;
    int found = !is_standard(use) ? stat(use->path, &about)
                                  : fstat(use->written ? STDOUT_FILENO : STDIN_FILENO, &about);
    if (found != 0)
        return use->written ? identify_new(use, err) : STATUS_OK;
    if (S_ISREG(about.st_mode)) {
        use->state = FILE_THERE;
        use->device = about.st_dev;
        use->inode = about.st_ino;
    }
    return STATUS_OK;
}

static bool are_same(const FileUse *a, const FileUse *b)
{
    if (is_standard(a) && is_standard(b))
        return a->written == b->written;
    return a->state == b->state && a->state != FILE_ANY && a->device == b->device &&
           a->inode == b->inode && (a->state == FILE_THERE || strcmp(a->name, b->name) == 0);
}

static Status refuse(const FileUse *a, const FileUse *b, Err *err)
{
    if (is_standard(a) && is_standard(b))
        return err_set(err, STATUS_USAGE, "%s and %s cannot both be standard %s", a->role, b->role,
                       a->written ? "output" : "input");
    if (a->written && b->written)
        return err_set(err, STATUS_USAGE,
                       "%s '%s' and %s '%s' are the same file; write to two files", a->role,
                       a->path, b->role, b->path);
    const FileUse *written = a->written ? a : b, *read = a->written ? b : a;
    return err_set(err, STATUS_USAGE, "%s '%s' would be written over %s '%s'; choose another name",
                   written->role, written->path, read->role, read->path);
}

/* Registers a file, unless it conflicts with a registered one: two uses of one file conflict if one
 * of them writes it, or if it is a standard stream. */
static Status add(Files *files, FileUse *use, Err *err)
{
    TRY(identify(use, err));
    for (size_t i = 0; i < files->n; i++) {
        const FileUse *other = &files->uses[i];
        bool clash = use->written || other->written || is_standard(use);
        if (clash && are_same(other, use))
            return refuse(other, use, err);
    }
    if (use->written)
        TRY(outfile_check(use->path, err));
    TRY(mem_reserve(&files->uses, &files->capacity, files->n + 1, sizeof *files->uses, "files",
                    err));
    files->uses[files->n++] = *use;
    return STATUS_OK;
}

static Status note(Files *files, const char *role, const char *path, bool written, Err *err)
{
    FileUse use = {.written = written};
    snprintf(use.role, sizeof use.role, "%s", role);
    TRY(mem_strdup(&use.path, path, err));
    Status status = add(files, &use, err);
    if (status != STATUS_OK)
        release_use(&use);
    return status;
}

Status files_add_input(Files *files, const char *role, const char *path, Err *err)
{
    return note(files, role, path, false, err);
}

Status files_add_output(Files *files, const char *role, const char *path, Err *err)
{
    return note(files, role, path, true, err);
}

/* ---- folders --------------------------------------------------------------------------------- */

static bool has_extension(const char *name, const char *const *extensions)
{
    while (*extensions && strcmp(file_extension(name), *extensions) != 0)
        extensions++;
    return *extensions && *name != '.';
}

static Status visit_in(const char *folder, const char *name, FileVisit *visit, void *user, Err *err)
{
    char *path = NULL;
    TRY(file_join(folder, name, &path, err));
    Status status = visit(user, path, false, err);
    free(path);
    return status;
}

Status files_visit(const char *path, const char *const *extensions, FileVisit *visit, void *user,
                   Err *err)
{
    struct stat about;
    struct dirent **entries = NULL;
    if (stat(path, &about) != 0 || !S_ISDIR(about.st_mode))
        return visit(user, path, true, err);
    int n = scandir(path, &entries, NULL, alphasort);
    if (n < 0)
        return err_set(err, errno == ENOMEM ? STATUS_MEMORY : STATUS_INPUT,
                       "%s: cannot be read: %s", path, strerror(errno));
    Status status = STATUS_OK;
    for (int i = 0; i < n; i++) {
        if (status == STATUS_OK && has_extension(entries[i]->d_name, extensions))
            status = visit_in(path, entries[i]->d_name, visit, user, err);
        free(entries[i]);
    }
    free(entries);
    return status;
}
