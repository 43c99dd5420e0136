/* Converts the results of a report to a list of checks, from which the text, the JUnit XML and the
 * HTML page are written. Private to the module compare. */
#ifndef CORCAST_COMPARE_REPORT_CHECK_H
#define CORCAST_COMPARE_REPORT_CHECK_H

#include "compare/report/report.h"

/* A measure that is reported in addition to the rules. All members are borrowed. */
typedef struct CheckMeasure {
    const char *table; /* heading of the table that lists it: "Color: sizes of differences" */
    const char *name, *unit;
    double value; /* never NAN */
} CheckMeasure;

enum { MEASURES_MAX = 40 };

/* One item that is judged: a plane; alpha; the settled pixels (A is known to be wrong there, see
 * checks/settled.h); the colors or the position of an implicit surface; or a pair of programs, one
 * of which may be the witness (a third, independent renderer, see checks/witness.h). */
typedef struct Check {
    const char *title; /* "color", "settled", "exact color", "surface"; borrowed */
    bool agrees;
    const char *reason; /* sentence about the first rule that is not met; borrowed */
    Rule rules[RULES_MAX];
    int n_rules;
    CheckMeasure measures[MEASURES_MAX]; /* measures of one table are adjacent */
    int n_measures;
    const Settled *settled; /* lists the first settled pixels, or NULL; borrowed */
} Check;

enum { CHECKS_MAX = PLANE_KINDS + 4 + WITNESS_PAIRS };

/* Returns the check of one plane: its rules, and the measures that are not NAN. It borrows from
 * `plane`. */
Check check_plane(const CompareResult *plane);
/* Makes all checks of a report, in the order in which they are shown. They borrow from `report`.
 * Returns their number. */
int report_checks(const ReportCase *report, Check checks[CHECKS_MAX]);

/* Returns the reason of the first check that does not agree, borrowed; NULL if all agree. */
const char *report_reason(const ReportCase *report);
/* Returns the largest ratio measured / allowed of the rules that are not met, clamped to
 * [1, 10^12]. If `allowed` is not above 0, the ratio is `measured`. Returns 0 if all rules are
 * met. */
double report_severity(const ReportCase *report);

#endif
