/* One run of a study: a tree grown and measured, as a line of JSON in a file of its own, which is
 * named after what it was made from. */
#ifndef CORCAST_STUDY_STUDY_RUN_H
#define CORCAST_STUDY_STUDY_RUN_H

#include "base/base.h"
#include "study/study_plan.h"

typedef struct StudyRunParams {
    const StudyPlan *plan;
    const char *folder; /* that files go to; it is there */
    bool trees;         /* are kept: T.swc beside T.json */
    int threads;
} StudyRunParams;

/* Has the run's file, *path (owned), be there: one that was made from the same is kept, and learns
 * its place in this plan; else the tree is grown and measured. *kept says which. Safe to be called
 * by several threads for different runs.
 *
 * A tree that finds no room is a result, marked by the member `error`; other failures are failures,
 * and the sentence names the run. Costs the tree. */
MUST_CHECK Status study_run(const StudyRunParams *params, size_t run, char **path, bool *kept,
                            Err *err);

#endif
