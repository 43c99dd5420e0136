/* The operation `study`: grows and measures a tree for each combination of chosen option values.
 *
 * A plan [study_plan.h] lists options of `grow` and their values. Each combination is a run
 * [study_run.h], which writes a file of its own. The tables study.csv and study.jsonl
 * [study_table.h] are made from the files at the end. A study that was interrupted, or whose runs
 * were grown elsewhere, therefore ends with the same tables.
 *
 * Use: corcast study plan.ini -o runs; or study_run(&options, &parsed, &lines, &err). */
#ifndef CORCAST_STUDY_STUDY_H
#define CORCAST_STUDY_STUDY_H

#include "options/options.h"

/* What the options of `study` set. */
typedef struct StudyOptions {
    const char *output; /* folder for the runs and the tables */
    int only;      /* the single run that is grown, counted from 1, without tables; 0: all runs */
    bool table;    /* grow nothing; make a table of the operands */
    bool trees;    /* also write the tree of each run, as SWC */
    bool commands; /* grow nothing; make one command per run */
} StudyOptions;

/* Describes the operation. Its options set a StudyOptions. */
extern const Command command_study;

/* Reads the plan, the first operand, and grows its runs into the folder. A run is not grown again
 * if its file exists and was made from the same inputs. A run that fails does not stop the other
 * runs, but no table is then written.
 *
 * lines   With `commands`, receives the commands. With `table`, receives the table as CSV. Both are
 *         appended. Otherwise unchanged.
 * Errors  STATUS_USAGE if options exclude each other; STATUS_INPUT if the plan is bad; STATUS_IO;
 *         STATUS_MEMORY. STATUS_CANCELLED if the caller stopped the operation; the files of
 *         finished runs remain. If runs fail, the error is that of the failed run with the lowest
 *         number [study_grow_run]. */
MUST_CHECK Status study_run(const StudyOptions *options, Parsed *parsed, Text *lines, Err *err);

#endif
