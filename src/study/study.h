/* The operation `study`: grows and measures trees for all combinations of some values. */
#ifndef CORCAST_STUDY_STUDY_H
#define CORCAST_STUDY_STUDY_H

#include "options/options.h"

/* What the options of `study` set. */
typedef struct StudyOptions {
    const char *output; /* folder for the runs and the tables */
    int only;      /* only this run is grown, counted from 1, and no table is written; 0: all */
    bool table;    /* nothing is grown: makes a table of the operands */
    bool trees;    /* the trees are kept, too */
    bool commands; /* nothing is grown: makes a command per run */
} StudyOptions;

/* Describes the operation. Its options set a StudyOptions. */
extern const Command command_study;

/* Reads the plan, the first operand, and grows its runs into the folder. A run whose file is there
 * and was made from the same is not grown again.
 *
 * lines   with `commands`, the commands are appended; with `table`, the table as CSV. Unchanged
 *         otherwise.
 * Errors  STATUS_USAGE if options exclude each other; STATUS_INPUT if the plan is bad; STATUS_IO;
 *         STATUS_MEMORY; STATUS_CANCELLED, and finished runs stay; and those of growth, of the
 *         first run that failed. */
MUST_CHECK Status study_run(const StudyOptions *options, Parsed *parsed, Text *lines, Err *err);

#endif
