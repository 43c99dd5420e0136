/* The steps that operations which write files have in common: estimate the cost, refuse what the
 * machine cannot hold, work, write the result and the files beside it, and give all files their
 * names together. The functions are called in the order of this header. */
#ifndef CORCAST_JOB_WORK_H
#define CORCAST_JOB_WORK_H

#include "base/base.h"
#include "options/files.h"
#include "options/options.h"
#include "options/talk.h"

/* The expected cost of an operation. */
typedef struct WorkCost {
    double memory; /* bytes */
    double disk;   /* bytes of the first file; 0: not checked */
} WorkCost;

/* The long step of an operation. `job` is the operation's own data. */
typedef struct Work {
    const char *step;   /* named in progress reports: "triangulating" */
    const char *result; /* named by the error if memory is too small: "the mesh" */
    /* Returns the expected cost, and reports it as a note. */
    WorkCost (*estimate)(const void *job, const Talk *talk);
    /* Does the work. Reports progress with progress_report [options/talk.h]. */
    Status (*make)(void *job, Progress *progress, Err *err);
} Work;

/* Records in `noted` that the files will be written, except files without a role (FileSlot.role).
 * Errors: as files_write. */
MUST_CHECK Status work_note_files(const FileSet *files, Files *noted, Err *err);

/* Estimates, checks memory and disk, and does the work.
 *
 * job      passed to Work.estimate and Work.make.
 * files    must be open; their disk is checked. NULL: nothing is written.
 * Errors   STATUS_MEMORY or STATUS_IO if the machine or the disk is too small, before the work; and
 *          those of Work.make. */
MUST_CHECK Status work_make(const Work *work, void *job, const FileSet *files, const Talk *talk,
                            Err *err);

/* Appends the content of an operation's files to the texts of `files`. `command` is the command
 * line for provenance. */
typedef Status WorkPut(const void *job, const char *command, FileSlot files[], Err *err);

/* Opens the files unless they are open, fills them, and gives all of them their final names, or
 * none. Errors: those of command_line_text, fileset_open, `put` and fileset_commit; a failure of
 * input or output names the file. */
MUST_CHECK Status work_write(FileSet *files, WorkPut *put, const void *job, const Parsed *parsed,
                             Err *err);

/* Appends a JSON document, indented, with a final newline, and releases `object`. The text fails if
 * `object` is NULL or memory runs out. */
void work_put_json(FileSlot *file, json_t *object);

#endif
