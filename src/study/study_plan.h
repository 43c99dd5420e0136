/* The plan of a study: options of `grow` and the values of each option. Each combination of values
 * is a run.
 *
 *     TRY(study_plan_read("plan.ini", &plan, err));
 *     TRY(study_plan_options(&plan, 0, threads, &parsed, err));    // the options of run 0
 *     study_plan_release(&plan); */
#ifndef CORCAST_STUDY_STUDY_PLAN_H
#define CORCAST_STUDY_STUDY_PLAN_H

#include "base/base.h"
#include "job/tree/makers.h"
#include "options/options.h"

/* Maximum number of runs of a plan; a larger plan is refused. The limit detects mistakes in the
 * plan. Reason of the value not recorded. */
enum { STUDY_MAX_RUNS = 1000000 };

/* An option and its values, as text in the form that the command line accepts. */
typedef struct StudyKey {
    char *name;   /* owned */
    char **value; /* the n values; the array and the strings are owned */
    size_t n, capacity;
} StudyKey;

typedef struct StudyPlan {
    StudyKey *key; /* in the order of the file; owned */
    size_t n, capacity;
    /* number of combinations; from run to run, the value of the last key changes fastest */
    size_t runs;
    HashText hash; /* hash of program version, keys and values */
} StudyPlan;

/* Reads a plan, an INI file with the section [grow] and lines such as `seed = 1..20` or `gamma =
 * 2.5, 3`. A..B stands for the integers from A to B. Values are separated by a comma and a blank; a
 * comma without a blank is part of a value.
 *
 * plan    set on success; release it with study_plan_release.
 * Errors  STATUS_INPUT or STATUS_USAGE, with file and line, for an unknown option, a wrong value, a
 *         repeated key or value, or more than STUDY_MAX_RUNS combinations; STATUS_IO;
 *         STATUS_MEMORY. */
MUST_CHECK Status study_plan_read(const char *path, StudyPlan *plan, Err *err);
void study_plan_release(StudyPlan *plan);

/* Returns the value of key `k` (below plan->n) in a run (below plan->runs); borrowed. */
const char *study_plan_value(const StudyPlan *plan, size_t run, size_t k);

/* Makes the options of a run, equal to those of a command line of `grow`. parsed->options is a
 * GrowOptions. Its member output is "T.swc": a placeholder, so that the command line that a tree's
 * file records does not depend on where the file is.
 *
 * run      0 <= run < plan->runs.
 * threads  number of threads; 0: all processors.
 * parsed   set on success; release it with parsed_release.
 * Errors   STATUS_USAGE if the values of the run exclude each other; STATUS_MEMORY. */
MUST_CHECK Status study_plan_options(const StudyPlan *plan, size_t run, int threads, Parsed *parsed,
                                     Err *err);

#endif
