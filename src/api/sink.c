/* Passes files to a callback of the caller, the sink, in blocks. Between two blocks the callback
 * may stop the call. Jobs write files, so their files go to a temporary folder first. */
#include "api/sink.h"

#include "base/base.h"
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

static Status refused(const char *name, Err *err)
{
    return err_set(err, STATUS_IO, "%s: the sink refused the bytes", name);
}

static Status check_sink(const Sink *sink, Err *err)
{
    return sink->take ? STATUS_OK : err_set(err, STATUS_USAGE, "sink is NULL");
}

Status sink_give(const Sink *sink, const char *name, const void *bytes, size_t size, Err *err)
{
    TRY(check_sink(sink, err));
    locale_t own = callback_begin(sink->caller_locale);
    const int stop = sink->take(sink->user, name, bytes, size);
    callback_end(own);
    return stop ? refused(name, err) : STATUS_OK;
}

static Status pass_stream(const Sink *sink, const char *name, FILE *stream, Err *err)
{
    enum { BLOCK = 1 << 16 }; /* bytes; larger: fewer calls, more memory on the stack */
    char block[BLOCK];
    size_t count;
    bool is_first = true; /* an empty file is passed, too */
    while ((count = fread(block, 1, BLOCK, stream)) > 0 || is_first) {
        is_first = false;
        TRY(sink_give(sink, name, block, count, err));
    }
    return ferror(stream) ? err_set(err, STATUS_IO, "%s: reading failed", name) : STATUS_OK;
}

static Status pass_file(const Sink *sink, const char *folder, const char *name, Err *err)
{
    char *path = NULL;
    TRY(file_join(folder, name, &path, err));
    FILE *stream = fopen(path, "rb");
    Status status = stream
                        ? pass_stream(sink, name, stream, err)
                        : err_set(err, STATUS_IO, "%s: cannot be read: %s", path, strerror(errno));
    if (stream)
        fclose(stream);
    free(path);
    return status;
}

/* Passes the bytes of all files in a folder to the sink, in the order of the files' names. */
static Status pass_folder(const Sink *sink, const char *folder, Err *err)
{
    struct dirent **entries = NULL;
    const int n = scandir(folder, &entries, NULL, alphasort);
    Status status = STATUS_OK;
    if (n < 0)
        return mem_out_of("to list", folder, err);
    for (int i = 0; i < n; i++) {
        const char *name = entries[i]->d_name;
        if (strcmp(name, ".") != 0 && strcmp(name, "..") != 0)
            TRY_GOTO(pass_file(sink, folder, name, err));
    }
done:
    for (int i = 0; i < n; i++)
        free(entries[i]);
    free(entries);
    return status;
}

static Status check_name(const char *name, Err *err)
{
    TRY(path_check(name, "name", err));
    return strchr(name, '/')
               ? err_set(err, STATUS_USAGE, "name is '%s'; it must have no folder", name)
               : STATUS_OK;
}

Status sink_files(const Sink *sink, const char *name, SinkMaker *make, const void *context,
                  Err *err)
{
    char *folder = NULL, *path = NULL;
    Status status = STATUS_OK;
    TRY(check_name(name, err));
    TRY(check_sink(sink, err));
    TRY(file_temporary_folder("/tmp/", &folder, err));
    TRY_GOTO(file_join(folder, name, &path, err));
    TRY_GOTO(make(context, path, err));
    status = pass_folder(sink, folder, err);
done:
    file_discard_temporary(folder);
    free(path);
    return status;
}
