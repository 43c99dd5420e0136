/* Converts the results of a report to a list of checks, which the text, the JUnit XML and the HTML
 * page then show. Private to the module compare. */
#ifndef CORCAST_COMPARE_REPORT_CHECK_H
#define CORCAST_COMPARE_REPORT_CHECK_H

#include "compare/report/report.h"

/* A measure that is reported in addition to the rules, which compare a measure with a limit [Rule,
 * result.h]. All members are borrowed. */
typedef struct CheckMeasure {
    const char *table; /* heading of the table that lists it: "Color: sizes of differences" */
    const char *name, *unit;
    double value; /* never NAN */
} CheckMeasure;

enum { CHECK_MEASURES_MAX = 40 }; /* more than the rows of measures[] for one kind of plane */

/* One item of a report that is judged. It is one of:
 *
 * - one plane: color, depth, normal, id or alpha
 * - the settled pixels: pixels where the reference A is shown to be wrong [checks/settled.h]
 * - the colors, or the position, of an implicit surface [checks/surface_check.h]
 * - one pair of the programs that drew the scene: A, B and a third renderer, the witness
 *   [checks/witness.h] */
typedef struct Check {
    const char *title;  /* "color", "settled", "exact color", "surface"; borrowed */
    bool agrees;        /* all rules are met; true if there are none */
    const char *reason; /* sentence about the first rule that is not met; "" or NULL if the check
                         * agrees; borrowed */
    Rule rules[RULES_MAX];
    int n_rules;
    CheckMeasure measures[CHECK_MEASURES_MAX]; /* measures of one table are adjacent */
    int n_measures;
    const Settled *settled; /* the settled pixels to list; NULL: none; borrowed */
} Check;

/* All planes, alpha, the settled pixels, colors and position of a surface, and the witness. */
enum { CHECKS_MAX = PLANE_KINDS + 4 + WITNESS_PAIRS };

/* Returns the check of one plane: its rules, and its measures that are not NAN. The check borrows
 * from `plane`. */
Check check_plane(const CompareResult *plane);
/* Returns the check of the settled pixels: a rule for each cause. */
Check check_settled(const Settled *settled);
/* Makes all checks of a report, in the order in which they are shown. They borrow from `report`.
 * Returns their number. */
int report_checks(const ReportCase *report, Check checks[CHECKS_MAX]);

/* Returns the reason of the first check that does not agree, borrowed; NULL if all agree. */
const char *report_reason(const ReportCase *report);
/* Returns the largest ratio of measured to allowed value among the rules that are not met, clamped
 * to [1, 10^12], because JSON has no infinity; 0 if all rules are met. If the allowed value is 0,
 * the measured value itself is used as the ratio. report_merge sorts cases by this number. */
double report_severity(const ReportCase *report);

#endif
