/* One run of a study: grows and measures a tree, and writes the result as one line of JSON to a
 * file of its own. The name of the file is a hash of all inputs of the tree: program version,
 * command line, and the content of the files that the command line names. The number of the run in
 * the plan is not part of the hash, so existing files stay valid when values are added to a plan.
 *
 * Use: study_grow_run(&params, run, &path, &kept, &err) for each run below plan->runs. */
#ifndef CORCAST_STUDY_STUDY_RUN_H
#define CORCAST_STUDY_STUDY_RUN_H

#include "base/base.h"
#include "study/study_plan.h"

/* The parameters that all runs of a study share. All pointers are borrowed. */
typedef struct StudyRunParams {
    const StudyPlan *plan;
    const char *folder; /* an existing folder, for the files */
    bool trees;         /* also write the tree: HASH.swc beside HASH.json */
    int threads;        /* number of threads that grow one tree */
} StudyRunParams;

/* Makes the file of a run, unless a file exists that was made from the same inputs. In an existing
 * file, only the number of the run is updated. A tree that cannot be grown is not an error: the
 * file then has the member `error`.
 * run      number of the run in the plan: 0 <= run < plan->runs.
 * path     receives the path of the file; release it with free.
 * kept     receives true if the file existed.
 * Errors   STATUS_USAGE or STATUS_INPUT if the options of the run or the files that they name
 *          cannot be used; STATUS_CANCELLED; STATUS_IO; STATUS_MEMORY. The sentence names the run.
 * Threads  several threads may call this function at the same time for different runs. */
MUST_CHECK Status study_grow_run(const StudyRunParams *params, size_t run, char **path, bool *kept,
                                 Err *err);

#endif
