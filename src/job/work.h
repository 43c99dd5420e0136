/* The steps that operations which write files have in common: estimate the cost, refuse what the
 * machine cannot hold, work, write the result and the files beside it, and give all files their
 * names together. */
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

/* Receives files in memory, in place of the file system. */
typedef struct FileTaker {
    /* Takes one file. `name` is the path that the file would have. All arguments are borrowed.
     * Returns false to refuse the file, which ends the operation. */
    bool (*take)(void *user, const char *name, const void *bytes, size_t size);
    void *user;
} FileTaker;

/* A file that an operation writes. */
typedef struct ResultFile {
    const char *role; /* what the file holds, for messages: "the manifest"; NULL: the option that
                       * names the file has been noted already. Borrowed. */
    char *path;       /* owned; NULL: the file is not written */
    Text text;        /* receives the content */
    FILE *stream;     /* where the text goes, for content that does not pass through it; borrowed */
    char *bytes;      /* the content, for a FileTaker; owned */
    size_t size;      /* of `bytes` */
} ResultFile;

enum { MAX_RESULT_FILES = 8 };

/* All files that an operation writes; the first one is its result. Zeroed: none. Must not be moved
 * after resultfiles_open. Release with resultfiles_release. */
typedef struct ResultFiles {
    ResultFile at[MAX_RESULT_FILES];
    OutFile open[MAX_RESULT_FILES]; /* the files of `at` that are written, in the same order */
    size_t n_open;
    const FileTaker *taker; /* NULL: the files go to the file system; borrowed */
} ResultFiles;

/* Notes the files as written, except those without a role. Does nothing if there is a taker. Errors
 * as files_write. */
MUST_CHECK Status resultfiles_note(const ResultFiles *files, Files *noted, Err *err);

/* Opens the files. A text for standard output is held back until all is written. Errors as
 * outfile_open, STATUS_MEMORY. */
MUST_CHECK Status resultfiles_open(ResultFiles *files, Err *err);

/* Estimates, checks memory and disk, and does the work.
 *
 * files    are open, and their disk is checked; NULL: nothing is written.
 * Errors   STATUS_MEMORY or STATUS_IO if the machine or the disk is too small, before the work; and
 *          those of Work.make. */
MUST_CHECK Status work_make(const Work *work, void *job, const ResultFiles *files, const Talk *talk,
                            Err *err);

/* Appends the content of an operation's files to the texts of `files`. `command` is the command
 * line for provenance; NULL if the caller of resultfiles_write has specified none. */
typedef Status ResultPut(const void *job, const char *command, ResultFile files[], Err *err);

/* Opens the files unless they are open, fills them, and gives all of them their final names, or
 * none. An error of input or output names the file. `parsed` has the command line; NULL: `put`
 * needs none. Errors: those of resultfiles_open and of `put`; STATUS_IO if writing fails or the
 * taker refuses a file; STATUS_MEMORY. */
MUST_CHECK Status resultfiles_write(ResultFiles *files, ResultPut *put, const void *job,
                                    const Parsed *parsed, Err *err);

/* Removes files that have no final name yet, and frees everything. */
void resultfiles_release(ResultFiles *files);

/* Appends a JSON document, indented, with a final newline, and releases `object`. The text fails if
 * `object` is NULL or memory runs out. */
void resultfile_json(ResultFile *file, json_t *object);

#endif
