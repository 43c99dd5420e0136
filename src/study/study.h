/* The operation `study`: grows and measures a tree for each combination of chosen option values.
 *
 * A plan [study_plan.h] lists options of `grow` and their values. Each combination is a run
 * [study_run.h], which writes a file of its own. At the end, the tables study.csv and study.jsonl
 * [study_table.h] are made from these files. The tables are therefore the same if the study was
 * interrupted and continued, or if runs were grown on other machines.
 *
 * Use: corcast study plan.ini -o runs; or study_run(&options, &parsed, &lines, &err). */
#ifndef CORCAST_STUDY_STUDY_H
#define CORCAST_STUDY_STUDY_H

#include "options/options.h"

/* The struct that the options of `study` set. */
typedef struct StudyOptions {
    const char *output; /* folder for the runs and the tables */
    int only;      /* number of the only run that is grown, from 1; no table is made; 0: all runs */
    bool table;    /* grow nothing; make a table of the result files that the operands name */
    bool trees;    /* also write the tree of each run, as SWC */
    bool commands; /* grow nothing; make one command line per run */
} StudyOptions;

/* Describes the operation. Its options set a StudyOptions. */
extern const Command command_study;

/* Reads the plan, which is the first operand, and grows its runs into the folder options->output. A
 * run is not grown again if its file exists and was made from the same inputs. If a run fails, the
 * other runs continue, but no table is written, and the error is that of the failed run with the
 * lowest number.
 *
 * lines   with `commands`: the commands are appended; with `table`: the table is appended as CSV;
 *         otherwise unchanged.
 * Errors  STATUS_USAGE if options exclude each other; STATUS_INPUT if the plan is malformed;
 *         STATUS_IO; STATUS_CANCELLED if the caller stopped the operation; the files of finished
 *         runs then remain; the errors of study_grow_run; STATUS_MEMORY. */
MUST_CHECK Status study_run(const StudyOptions *options, Parsed *parsed, Text *lines, Err *err);

#endif
