/* The operation `power`: measures the statistical power of a tolerance. It plants faults of known
 * size in a renderer's picture, and reports which faults a comparison fails to detect. */
#ifndef CORCAST_JOB_VERIFY_POWER_H
#define CORCAST_JOB_VERIFY_POWER_H

#include "job/verify/compare_options.h"

/* What the options of `power` set. */
typedef struct PowerOptions {
    const char *render;    /* shell command that draws a picture into the file {} */
    const char *verdict;   /* shell command that compares {a} and {b}; NULL: `judge` is the rule */
    const char *extension; /* extension of the file {} */
    const char *folder;    /* folder for pictures whose fault is missed; NULL: not written */
    const char *choose;    /* file for the chosen tolerance; NULL: nothing is chosen */
    double alarms;   /* with `choose`: accepted fraction of comparisons without a fault that fail;
                      * 0: the lowest possible */
    bool json;       /* for the command line: the result is printed as JSON */
    Vec3 background; /* transparent pictures are composited over it; sRGB in [0, 1] */
    JudgeOptions judge;
} PowerOptions;

/* Describes the operation. Its options set a PowerOptions. */
extern const Command command_power;

/* The result of the operation. */
typedef struct PowerReport {
    Power power;
    Choice choice; /* with options->choose, else zeroed */
} PowerReport;

/* Runs the renderer twice, plants faults of known size in copies of the second picture, and lets
 * the rule (options->judge or options->verdict) compare each copy with the first picture.
 *
 * With options->choose, the operands are a reference and repeated renderings. power_run then
 * chooses a tolerance, writes it to the file options->choose, and plants the faults in a copy of
 * the first repeated rendering.
 *
 * report  set on success; release report->power with power_release.
 * Errors  STATUS_USAGE if a shell command lacks its placeholders ({}, or {a} and {b}), or options
 *         exclude each other; STATUS_TOOL if
 *         the renderer fails; STATUS_INPUT for an unreadable picture, or if there are too few
 *         renderings to reach the rate options->alarms;
 *         STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status power_run(const PowerOptions *options, Parsed *parsed, PowerReport *report,
                            Err *err);

#endif
