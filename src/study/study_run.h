/* One run of a study: grows and measures a tree, and writes the result as a line of JSON into a
 * file of its own. The file is named after a hash of everything that the tree is made from. */
#ifndef CORCAST_STUDY_STUDY_RUN_H
#define CORCAST_STUDY_STUDY_RUN_H

#include "base/base.h"
#include "study/study_plan.h"

/* All pointers are borrowed. */
typedef struct StudyRunParams {
    const StudyPlan *plan;
    const char *folder; /* an existing folder, for the files */
    bool trees;         /* trees are kept: HASH.swc beside HASH.json */
    int threads;        /* that grow one tree */
} StudyRunParams;

/* Makes the file of a run, unless a file that was made from the same exists. The place of the run
 * in the plan is updated in an existing file.
 *
 * run     0 <= run < plan->runs.
 * path    receives the path of the file (owned).
 * kept    receives true if the file existed.
 * Errors  STATUS_USAGE and STATUS_INPUT if the options of the run are bad; STATUS_IO;
 *         STATUS_MEMORY. The sentence names the run. A tree that cannot be grown is not an error:
 * the file then has the member `error`. Threads may call this for different runs at once. */
MUST_CHECK Status study_grow_run(const StudyRunParams *params, size_t run, char **path, bool *kept,
                                 Err *err);

#endif
