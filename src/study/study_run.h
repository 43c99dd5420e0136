/* One run of a study: grows and measures a tree, and writes the result as a line of JSON into a
 * file of its own. The name of the file is a hash of all inputs of the tree: program version,
 * command line, and the content of the files that the command line names. The index of the run in
 * the plan is not part of the hash, so existing files stay valid when a plan gets more values.
 *
 * Use: study_grow_run(&params, run, &path, &kept, &err) for each run below plan->runs. */
#ifndef CORCAST_STUDY_STUDY_RUN_H
#define CORCAST_STUDY_STUDY_RUN_H

#include "base/base.h"
#include "study/study_plan.h"

/* All pointers are borrowed. */
typedef struct StudyRunParams {
    const StudyPlan *plan;
    const char *folder; /* an existing folder, for the files */
    bool trees;         /* also write the tree: HASH.swc beside HASH.json */
    int threads;        /* number of threads that grow one tree */
} StudyRunParams;

/* Makes the file of a run, unless a file that was made from the same inputs exists. In an existing
 * file, the number of the run in the plan is updated.
 *
 * run      0 <= run < plan->runs.
 * path     receives the path of the file; release it with free.
 * kept     receives true if the file existed.
 * Errors   STATUS_USAGE and STATUS_INPUT if the options of the run are bad; STATUS_IO;
 *          STATUS_MEMORY. The message names the run. A tree that cannot be grown is not an error:
 *          the file then has the member `error`.
 * Threads  Several threads may call this function at the same time for different runs. */
MUST_CHECK Status study_grow_run(const StudyRunParams *params, size_t run, char **path, bool *kept,
                                 Err *err);

#endif
