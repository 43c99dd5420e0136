/* Runs an operation that makes something and writes it to files: checks memory and disk space,
 * makes the result, and writes all files or none. The steps are the same for every operation; what
 * differs comes from functions of the operation. */
#include "job/work.h"

#include "options/output.h"
#include <stdlib.h>

Status work_note_files(const FileSet *files, Files *noted, Err *err)
{
    for (const FileSlot *file = files->at; file < &files->at[MAX_FILE_SLOTS]; file++)
        if (file->path && file->role)
            TRY(files_add_output(noted, file->role, file->path, err));
    return STATUS_OK;
}

Status work_make(const Work *work, void *job, const FileSet *files, const Talk *talk, Err *err)
{
    Progress progress;
    const WorkCost cost = work->estimate(job, talk);
    TRY(mem_check(cost.memory, work->result, err));
    if (files)
        TRY(outfile_check_space(&files->open[0], cost.disk, err));
    progress_start(&progress, work->step, talk);
    Status status = work->make(job, &progress, err);
    progress_end(&progress);
    return files ? fileset_name_failure(files, status, err) : status;
}

Status work_write(FileSet *files, WorkPut *put, const void *job, const Parsed *parsed, Err *err)
{
    char *command = NULL;
    Status status;
    TRY_GOTO(command_line_text(parsed, &command, err));
    if (files->n_open == 0)
        TRY_GOTO(fileset_open(files, err));
    TRY_GOTO(fileset_name_failure(files, put(job, command, files->at, err), err));
    status = fileset_commit(files, err);
done:
    free(command);
    return status;
}

void work_put_json(FileSlot *file, json_t *object)
{
    text_json(&file->text, object, 2);
    text_puts(&file->text, "\n");
}
