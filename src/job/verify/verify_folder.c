/* Locks the output folder of a verification, and removes the files of an earlier verification. A
 * lock on the folder itself (flock) keeps two verifications apart. It ends with the process. */
#include "job/verify/verify_folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

/* All files that a verification writes. The verdict is the first that is removed, so that an
 * interrupted verification leaves none. */
static const char *const left[] = {
    "report.html",         "report.json",      "junit.xml",         "diff.png",
    "scene.pov",           "scene.inc",        "ids.pov",           "ids.inc",
    "povray.png",          "povray.depth.png", "povray.normal.png", "povray.id.png",
    "povray.depth-id.png", "povray.alpha.png", "povray.depth.pfm",  "povray.normal.pfm",
    "povray.id.ppm",       "native.png",       "native.depth.pfm",  "native.normal.pfm",
    "native.id.ppm",       "exact.png",        "exact.depth.pfm",   "exact.normal.pfm",
    "exact.id.ppm",        "scene.tachyon",    "tachyon.depth.ppm", "tachyon.id.ppm"};

/* Beginnings of the names of files that tiles leave. */
static const char *const left_of_tiles[] = {
    "scene.tile-",         "ids.tile-",       "povray.tile-",         "povray.depth.tile-",
    "povray.normal.tile-", "povray.id.tile-", "povray.depth-id.tile-"};

/* Calls `what` with the path of each file in `left`. */
static Status for_all_files(const VerifyFolder *folder, Files *files,
                            Status (*what)(Files *files, const char *path, Err *err), Err *err)
{
    for (size_t i = 0; i < sizeof left / sizeof *left; i++) {
        char *path = NULL;
        TRY(file_join(folder->path, left[i], &path, err));
        Status status = what(files, path, err);
        free(path);
        TRY(status);
    }
    return STATUS_OK;
}

static Status note_file(Files *files, const char *path, Err *err)
{
    return files_add_output(files, "-o", path, err);
}

static Status remove_file(Files *files, const char *path, Err *err)
{
    (void)files;
    if (unlink(path) == 0 || errno == ENOENT)
        return STATUS_OK;
    return err_set(err, STATUS_IO, "%s: cannot be removed: %s", path, strerror(errno));
}

static bool is_of_tile(const char *name)
{
    for (size_t i = 0; i < sizeof left_of_tiles / sizeof *left_of_tiles; i++)
        if (strncmp(name, left_of_tiles[i], strlen(left_of_tiles[i])) == 0)
            return true;
    return false;
}

/* Removes the files of tiles, whose number is not known. */
static Status remove_tiles(const VerifyFolder *folder, Err *err)
{
    DIR *entries = opendir(folder->path);
    Status status = STATUS_OK;
    if (!entries)
        return err_set(err, STATUS_IO, "%s: cannot be read: %s", folder->path, strerror(errno));
    for (const struct dirent *entry; status == STATUS_OK && (entry = readdir(entries));) {
        char *path = NULL;
        if (!is_of_tile(entry->d_name))
            continue;
        status = file_join(folder->path, entry->d_name, &path, err);
        if (status == STATUS_OK)
            status = remove_file(NULL, path, err);
        free(path);
    }
    closedir(entries);
    return status;
}

Status verifyfolder_claim(VerifyFolder *folder, Files *files, Err *err)
{
    if (folder->lock >= 0)
        return STATUS_OK;
    folder->lock = open(folder->path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder->lock < 0)
        return errno == ENOENT ? STATUS_OK
                               : err_set(err, STATUS_IO, "%s: cannot be written to: %s",
                                         folder->path, strerror(errno));
    if (flock(folder->lock, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        return err_set(err, STATUS_IO, "%s: another verification is writing to this folder",
                       folder->path);
    TRY(for_all_files(folder, files, note_file, err));
    TRY(for_all_files(folder, files, remove_file, err));
    return remove_tiles(folder, err);
}

void verifyfolder_release(VerifyFolder *folder)
{
    if (folder->lock >= 0)
        close(folder->lock);
    folder->lock = -1;
}
