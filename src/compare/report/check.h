/* What a report judges, in the one form that its text, JUnit XML and page are written from; private
 * to the room compare. */
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

/* One thing that is judged: a plane, the settled pixels, an isosurface's colours or place, or two
 * programs of which one may be the witness. */
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

/* The check of one plane: its rules, and its measures that are known. */
Check check_plane(const CompareResult *plane);
/* All checks of a report, in the order in which they are shown; how many there are. */
int report_checks(const ReportCase *report, Check checks[CHECKS_MAX]);

/* Why the report does not agree: the reason of its first check that does not. NULL when all agree.
 * Borrowed. */
const char *report_reason(const ReportCase *report);
/* By how much the rule that is broken most is exceeded: measured over allowed, at least 1; 0 when
 * all are met. */
double report_severity(const ReportCase *report);

#endif
