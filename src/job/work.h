/* The steps that all operations that write files share: estimate the cost, check that memory and
 * disk suffice, do the work, write the files, and rename all of them together to their final names.
 * The functions are called in this order; `put_content` is a WorkPut:
 *
 *     TRY(work_note_files(&files, &parsed->files, err));
 *     TRY(fileset_open(&files, err));
 *     TRY(work_make(&work, &job, &files, talk, err));
 *     TRY(work_write(&files, put_content, &job, parsed, err)); */
#ifndef CORCAST_JOB_WORK_H
#define CORCAST_JOB_WORK_H

#include "base/base.h"
#include "options/files.h"
#include "options/options.h"
#include "options/talk.h"

/* The expected cost of an operation. */
typedef struct WorkCost {
    double memory; /* bytes */
    double disk;   /* bytes of the first file of the FileSet; 0: not checked */
} WorkCost;

/* The long step of an operation. `job` is the operation's own data. */
typedef struct Work {
    const char *step; /* name of the step in progress reports: "triangulating" */
    /* name of the result in the error sentence if memory is too small: "the mesh" */
    const char *result;
    /* Returns the expected cost of the work. Sends it to `talk` as a note. */
    WorkCost (*estimate)(const void *job, const Talk *talk);
    /* Does the work. Must call progress_report [options/talk.h] with `progress` as its context. */
    Status (*make)(void *job, Progress *progress, Err *err);
} Work;

/* Registers the files in `noted`, so that another use of one of them is detected. Leaves out files
 * without a role (FileSlot.role is NULL): they are registered already. Errors: STATUS_USAGE if a
 * file is also read or written otherwise; STATUS_IO if a file cannot be written; STATUS_MEMORY. */
MUST_CHECK Status work_note_files(const FileSet *files, Files *noted, Err *err);

/* Estimates the cost, checks that memory and disk suffice, and does the work.
 *
 * job     passed to Work.estimate and Work.make.
 * files   must be open. The first file's disk must have WorkCost.disk free bytes. NULL: nothing is
 *         written.
 * Errors  STATUS_MEMORY or STATUS_IO, before the work, if the machine's memory or the disk is too
 *         small; the errors of Work.make. */
MUST_CHECK Status work_make(const Work *work, void *job, const FileSet *files, const Talk *talk,
                            Err *err);

/* Makes the content of each slot that has a path: appends it to FileSlot.text or, if the slot has a
 * stream, writes it to FileSlot.stream.
 *
 * job      the operation's own data.
 * command  the command line, which files store as their provenance.
 * files    FileSet.at, MAX_FILE_SLOTS elements.
 * Errors   any status. The sentence of STATUS_IO need not name the file: work_write adds the name.
 */
typedef Status WorkPut(const void *job, const char *command, FileSlot files[], Err *err);

/* Opens the files unless they are open, fills them by `put`, and renames them to their final names.
 * After an error no file is renamed. Errors: those of `put`; STATUS_IO, with the file's name, if a
 * file cannot be written; STATUS_MEMORY. */
MUST_CHECK Status work_write(FileSet *files, WorkPut *put, const void *job, const Parsed *parsed,
                             Err *err);

/* Appends a JSON document, indented by two blanks, with a final newline. Releases `object`. If
 * `object` is NULL or memory runs out, file->text records the failure. */
void work_put_json(FileSlot *file, json_t *object);

#endif
