/* Writes a set of files and standard output, all of them or none.
 *
 * Files are written under temporary names, and get their final names together when all of them are
 * complete. After a failure the user's files are therefore unchanged. Text for standard output is
 * held back until then, so that its reader gets all or nothing. */
#include "base/fileset.h"

#include <stdlib.h>

Status fileset_open(FileSet *files, Err *err)
{
    for (FileSlot *file = files->at; file < &files->at[MAX_FILE_SLOTS]; file++) {
        if (!file->path)
            continue;
        OutFile *open = &files->open[files->n_open++];
        TRY(outfile_open(open, file->path, err));
        file->stream = open->stream;
        file->text = open->stream == stdout ? TEXT_INIT : TEXT_TO(open->stream);
    }
    return STATUS_OK;
}

Status fileset_name_failure(const FileSet *files, Status status, Err *err)
{
    size_t i = 0;
    while (i < files->n_open && !ferror(files->open[i].stream))
        i++;
    if (status == STATUS_IO && i < files->n_open)
        err_prefix(err, "%s: ", files->open[i].path);
    return status;
}

/* Writes the rest of a text to its file. */
static Status end_text(FileSlot *file, Err *err)
{
    Text held = TEXT_TO(file->stream);
    if (file->text.stream)
        return text_flush(&file->text, err);
    text_add(&held, &file->text);
    Status status = text_flush(&held, err);
    text_release(&held);
    return status;
}

Status fileset_commit(FileSet *files, Err *err)
{
    for (size_t i = 0; i < MAX_FILE_SLOTS; i++)
        if (files->at[i].path)
            TRY(fileset_name_failure(files, end_text(&files->at[i], err), err));
    return outfiles_commit(files->open, files->n_open, err);
}

void fileset_release(FileSet *files)
{
    for (size_t i = 0; i < files->n_open; i++)
        outfile_discard(&files->open[i]);
    for (size_t i = 0; i < MAX_FILE_SLOTS; i++) {
        text_release(&files->at[i].text);
        free(files->at[i].path);
    }
    *files = (FileSet){0};
}
