/* Files are written under temporary names, and get their final names together when all of them are
 * complete. After a failure the user's files are therefore unchanged. Text for standard output is
 * held back until then, so that its reader gets all or nothing. */
#include "job/work.h"

#include "options/output.h"
#include <stdlib.h>

Status resultfiles_note(const ResultFiles *files, Files *noted, Err *err)
{
    for (const ResultFile *file = files->at; file < &files->at[MAX_RESULT_FILES]; file++)
        if (file->path && file->role && !files->taker)
            TRY(files_write(noted, file->role, file->path, err));
    return STATUS_OK;
}

static Status open_in_memory(ResultFile *file, OutFile *open, Err *err)
{
    TRY(mem_strdup(&open->path, file->path, err));
    open->stream = open_memstream(&file->bytes, &file->size);
    return open->stream ? STATUS_OK : mem_out_of("for", file->path, err);
}

Status resultfiles_open(ResultFiles *files, Err *err)
{
    for (ResultFile *file = files->at; file < &files->at[MAX_RESULT_FILES]; file++) {
        if (!file->path)
            continue;
        OutFile *open = &files->open[files->n_open++];
        TRY(files->taker ? open_in_memory(file, open, err) : outfile_open(open, file->path, err));
        file->stream = open->stream;
        file->text = open->stream == stdout ? TEXT_INIT : TEXT_TO(open->stream);
    }
    return STATUS_OK;
}

/* Adds the name of the file that could not be written to an error of input or output. Returns
 * `status`. */
static Status with_path(Status status, const ResultFiles *files, Err *err)
{
    size_t i = 0;
    while (i + 1 < files->n_open && !ferror(files->open[i].stream))
        i++;
    if (status == STATUS_IO)
        err_prefix(err, "%s: ", files->open[i].path);
    return status;
}

Status work_make(const Work *work, void *job, const ResultFiles *files, const Talk *talk, Err *err)
{
    Progress progress;
    const WorkCost cost = work->estimate(job, talk);
    TRY(mem_check(cost.memory, work->result, err));
    if (files)
        TRY(outfile_check_room(&files->open[0], cost.disk, err));
    progress_start(&progress, work->step, talk);
    Status status = work->make(job, &progress, err);
    progress_end(&progress);
    return files ? with_path(status, files, err) : status;
}

/* Writes the rest of a text to its file. */
static Status end_text(ResultFile *file, Err *err)
{
    Text held = TEXT_TO(file->stream);
    if (file->text.stream)
        return text_flush(&file->text, err);
    text_add(&held, &file->text);
    Status status = text_flush(&held, err);
    text_release(&held);
    return status;
}

static Status fill(ResultFiles *files, ResultPut *put, const void *job, const char *command,
                   Err *err)
{
    TRY(put(job, command, files->at, err));
    for (size_t i = 0; i < MAX_RESULT_FILES; i++)
        if (files->at[i].path)
            TRY(end_text(&files->at[i], err));
    return STATUS_OK;
}

/* Ends the streams in memory, and passes what they hold to the taker. */
static Status hand_over(ResultFiles *files, Err *err)
{
    const FileTaker *taker = files->taker;
    for (size_t i = 0, n = 0; i < MAX_RESULT_FILES; i++) {
        ResultFile *file = &files->at[i];
        if (!file->path)
            continue;
        FILE *stream = files->open[n].stream;
        files->open[n++].stream = NULL;
        if (fclose(stream) != 0 || !file->bytes)
            return mem_out_of("for", file->path, err);
    }
    for (const ResultFile *file = files->at; file < &files->at[MAX_RESULT_FILES]; file++)
        if (file->path && !taker->take(taker->user, file->path, file->bytes, file->size))
            return err_set(err, STATUS_IO, "%s: refused by the caller", file->path);
    return STATUS_OK;
}

Status resultfiles_write(ResultFiles *files, ResultPut *put, const void *job, const Parsed *parsed,
                         Err *err)
{
    char *command = NULL;
    Status status;
    if (parsed)
        TRY_GOTO(command_line_text(parsed, &command, err));
    if (files->n_open == 0)
        TRY_GOTO(resultfiles_open(files, err));
    TRY_GOTO(with_path(fill(files, put, job, command, err), files, err));
    status =
        files->taker ? hand_over(files, err) : outfiles_commit(files->open, files->n_open, err);
done:
    free(command);
    return status;
}

void resultfiles_release(ResultFiles *files)
{
    for (size_t i = 0; i < files->n_open; i++)
        outfile_discard(&files->open[i]);
    for (size_t i = 0; i < MAX_RESULT_FILES; i++) {
        text_release(&files->at[i].text);
        free(files->at[i].path);
        free(files->at[i].bytes);
    }
    *files = (ResultFiles){0};
}

void resultfile_json(ResultFile *file, json_t *object)
{
    text_json(&file->text, object, 2);
    text_puts(&file->text, "\n");
}
