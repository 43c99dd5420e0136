/* The operation `report`: writes one HTML page about the results of several verifications and
 * comparisons. */
#ifndef CORCAST_JOB_VERIFY_REPORT_H
#define CORCAST_JOB_VERIFY_REPORT_H

#include "options/options.h"

/* What the options of `report` set. */
typedef struct ReportOptions {
    const char *page;  /* the HTML file that is written */
    const char *power; /* JSON file of `make power`, which measures the faults that comparisons
                        * detect; its table is below the results; NULL: no table */
} ReportOptions;

/* Describes the operation. Its options set a ReportOptions. */
extern const Command command_report;

/* Writes one page about the operands: folders that `verify` or `compare --report` has written.
 *
 * agree   receives true if the verdict of every folder is "agree"; set on success only.
 * Errors  STATUS_INPUT if a folder has no report; STATUS_USAGE if a file would be both read and
 *         written; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status report_run(const ReportOptions *options, Parsed *parsed, bool *agree, Err *err);

#endif
