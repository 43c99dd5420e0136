/* A study: trees grown for all combinations of some values of the options of `grow`. */
#ifndef CORCAST_STUDY_STUDY_PLAN_H
#define CORCAST_STUDY_STUDY_PLAN_H

#include "base/base.h"
#include "job/tree/growing.h"
#include "job/tree/refining.h"
#include "options/options.h"

enum { STUDY_MOST_RUNS = 1000000 };

/* An option and the values that it takes in turn, as the option writes them. */
typedef struct StudyKey {
    char *name;   /* owned */
    char **value; /* owned */
    size_t n, capacity;
} StudyKey;

typedef struct StudyPlan {
    StudyKey *key; /* owned; in the order of the file */
    size_t n, capacity;
    size_t runs;   /* all combinations; those of the last key follow each other */
    HashText hash; /* of program, keys and values */
} StudyPlan;

/* What the options of a run set. */
typedef struct StudyGrowth {
    const char *output; /* "T.swc", for the command that a tree tells */
    Growing growing;
    Refining refining;
} StudyGrowth;

/* Reads an INI file whose only section is [grow]: `seed = 1..20` or `gamma = 2.5, 3`, a comma and a
 * blank between two values, so that a value may have commas; A..B stands for whole numbers.
 * STATUS_INPUT or STATUS_USAGE, naming file and line, for what is no option of growth, no value of
 * it, there twice, or more than STUDY_MOST_RUNS combinations. Release with study_plan_release. */
MUST_CHECK Status study_plan_read(const char *path, StudyPlan *plan, Err *err);
void study_plan_release(StudyPlan *plan);

/* The value of key `k` in a run, 0 <= run < plan->runs; borrowed. */
const char *study_plan_value(const StudyPlan *plan, size_t run, size_t k);

/* The options of a run, as `corcast grow` would have them, in *parsed (parsed_release), a
 * StudyGrowth among them; `threads` as --threads. */
MUST_CHECK Status study_plan_options(const StudyPlan *plan, size_t run, int threads, Parsed *parsed,
                                     Err *err);

#endif
