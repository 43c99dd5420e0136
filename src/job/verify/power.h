/* The operation `power`: measures the statistical power of a tolerance. It introduces faults of
 * known size into a picture, and reports the faults that a comparison by the tolerance does not
 * detect. */
#ifndef CORCAST_JOB_VERIFY_POWER_H
#define CORCAST_JOB_VERIFY_POWER_H

#include "job/verify/compare_options.h"

/* What the options of `power` set. */
typedef struct PowerOptions {
    /* shell command of the renderer under test; it writes a picture to the file {}. Not used with
     * `choose` */
    const char *render;
    /* shell command that compares the files {a} and {b}, exit status 0: equal; NULL: `judge`
     * decides */
    const char *verdict;
    const char *extension; /* extension of the file {} */
    /* folder for the pictures whose fault was not detected; NULL: not written */
    const char *folder;
    const char *choose; /* file for the tolerance that is chosen from repeated renderings; NULL: no
                         * tolerance is chosen */
    /* with `choose`: accepted false alarm rate, the fraction of pictures without a fault that the
     * tolerance rejects; 0: the lowest rate that the renderings allow */
    double alarms;
    bool json;       /* for the command line: the result is printed as JSON */
    Vec3 background; /* color over which transparent pictures are composited; sRGB in [0, 1] */
    JudgeOptions judge;
} PowerOptions;

/* Describes the operation. Its options set a PowerOptions. */
extern const Command command_power;

/* The result of the operation. */
typedef struct PowerReport {
    Power power;
    Choice choice; /* the chosen tolerance; zeroed without options->choose */
} PowerReport;

/* Runs the renderer twice, and introduces faults of known size into copies of the second picture.
 * Each copy is compared with the first picture, by options->judge or by the command
 * options->verdict.
 *
 * If options->choose is set, the operands are a reference and repeated renderings. The function
 * then chooses a tolerance, writes it to the file options->choose, and introduces the faults into
 * copies of the first repeated rendering.
 *
 * report  set on success; release report->power with power_release.
 * Errors  STATUS_USAGE if a shell command lacks its placeholders ({}, or {a} and {b}), or if
 *         options exclude each other; STATUS_TOOL if the renderer fails; STATUS_INPUT for an
 *         unreadable picture, or if there are too few renderings for the rate options->alarms;
 *         STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status power_run(const PowerOptions *options, Parsed *parsed, PowerReport *report,
                            Err *err);

#endif
