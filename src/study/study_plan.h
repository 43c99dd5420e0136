/* The plan of a study: options of `grow`, the values of each option, and the runs. There is one run
 * per combination of values.
 *
 * Use:
 *
 *     TRY(study_plan_read("plan.ini", &plan, err));
 *     TRY(study_plan_options(&plan, 0, threads, &parsed, err));
 *     study_plan_release(&plan); */
#ifndef CORCAST_STUDY_STUDY_PLAN_H
#define CORCAST_STUDY_STUDY_PLAN_H

#include "base/base.h"
#include "job/tree/makers.h"
#include "options/options.h"

/* Maximum number of runs of a plan. A larger plan is refused. Reason of the value not recorded. */
enum { STUDY_MAX_RUNS = 1000000 };

/* An option and its values, as text in the form that the command line accepts. */
typedef struct StudyKey {
    char *name;   /* owned */
    char **value; /* n strings; the array and the strings are owned */
    size_t n, capacity;
} StudyKey;

typedef struct StudyPlan {
    StudyKey *key; /* in the order of the file; owned */
    size_t n, capacity;
    size_t runs;   /* number of combinations; the value of the last key changes first */
    HashText hash; /* hash of program version, keys and values */
} StudyPlan;

/* Reads a plan, an INI file with the section [grow]: `seed = 1..20` or `gamma = 2.5, 3`. Values are
 * separated by a comma and a blank, so that a value may contain commas. A..B are integers.
 *
 * plan    set on success; release it with study_plan_release.
 * Errors  STATUS_INPUT or STATUS_USAGE, with file and line, for an unknown option, a bad value, a
 *         repeated key or value, or more than STUDY_MAX_RUNS combinations; STATUS_IO;
 *         STATUS_MEMORY. */
MUST_CHECK Status study_plan_read(const char *path, StudyPlan *plan, Err *err);
void study_plan_release(StudyPlan *plan);

/* Returns the value of key `k` (below plan->n) in a run (below plan->runs); borrowed. */
const char *study_plan_value(const StudyPlan *plan, size_t run, size_t k);

/* Makes the options of a run, as the command line `corcast grow` would make them. parsed->options
 * is a GrowOptions, whose output is "T.swc" in the command line that the tree's file records.
 *
 * run      0 <= run < plan->runs.
 * threads  as --threads.
 * parsed   set on success; release it with parsed_release.
 * Errors   STATUS_USAGE, STATUS_MEMORY. */
MUST_CHECK Status study_plan_options(const StudyPlan *plan, size_t run, int threads, Parsed *parsed,
                                     Err *err);

#endif
