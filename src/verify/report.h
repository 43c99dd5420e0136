/* The parts of a report; private to the room verify. */
#ifndef CORCAST_VERIFY_REPORT_H
#define CORCAST_VERIFY_REPORT_H

#include "verify/verify.h"

/* The first plane that differs, or NULL. Borrowed. */
const CompareResult *report_worst(const ReportCase *report);

/* Why the report does not agree, a sentence, or NULL. Borrowed. */
const char *report_reason(const ReportCase *report);

/* Appends `text` with & < > " and ' as entities: for HTML and XML, in elements and attributes. */
void text_escaped(Text *out, const char *text);

/* Appends the JUnit XML: a test case for each plane. */
void report_junit(const ReportCase *report, Text *out);

/* Writes report.html into `folder`; `heat` is the difference picture. */
MUST_CHECK Status report_page(const ReportCase *report, const Picture *heat,
                              const char *template_path, const char *folder, Err *err);

#endif
