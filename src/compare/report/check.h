/* Checks: what a report judges, in the one form that text, JUnit XML and page are written from.
 * Private to the module compare. */
#ifndef CORCAST_COMPARE_REPORT_CHECK_H
#define CORCAST_COMPARE_REPORT_CHECK_H

#include "compare/report/report.h"

/* A number that is reported beside the rules. All members are borrowed. */
typedef struct CheckMeasure {
    const char *table; /* the heading it stands under: "Colour: sizes of differences" */
    const char *name, *unit;
    double value; /* never NAN */
} CheckMeasure;

enum { MEASURES_MAX = 40 };

/* One thing that is judged: a plane, alpha, the settled pixels, the colours or the place of an
 * implicit surface, or two programs of which one may be the witness. */
typedef struct Check {
    const char *title; /* "color", "settled", "exact color", "surface"; borrowed */
    bool agrees;
    const char *reason; /* as in CompareResult; borrowed */
    Rule rules[RULES_MAX];
    int n_rules;
    CheckMeasure measures[MEASURES_MAX]; /* those of one table follow each other */
    int n_measures;
    const Settled *settled; /* whose first pixels are listed; NULL in other checks. Borrowed */
} Check;

enum { CHECKS_MAX = PLANE_KINDS + 4 + WITNESS_PAIRS };

/* Returns the check of one plane: its rules, and the measures that are known. */
Check check_plane(const CompareResult *plane);
/* Sets all checks of a report, in the order in which they are shown, and returns their number. */
int report_checks(const ReportCase *report, Check checks[CHECKS_MAX]);

/* Returns the reason of the first check that does not agree, borrowed; NULL if all agree. */
const char *report_reason(const ReportCase *report);
/* Returns by how much the worst broken rule is exceeded: measured over allowed, at least 1; 0 if
 * all rules are met. */
double report_severity(const ReportCase *report);

#endif
