/* The parts of a report; private to the room verify. */
#ifndef CORCAST_VERIFY_REPORT_H
#define CORCAST_VERIFY_REPORT_H

#include "verify/verify.h"

/* The first plane that differs, or NULL. Borrowed. */
const CompareResult *report_worst(const ReportCase *report);

/* Why the report does not agree, a sentence, or NULL. Borrowed. */
const char *report_reason(const ReportCase *report);

/* Appends `text` with & < > " and ' as entities, without control characters, and with U+FFFD for
 * what is not UTF-8: for HTML and XML, in elements and attributes. */
void text_escaped(Text *out, const char *text);

/* Appends the JUnit XML: a test case for each plane. */
void report_junit(const ReportCase *report, Text *out);

/* By how much the rule that is broken most is exceeded: measured over allowed, at least 1; 0 when
 * all are met. */
double report_severity(const ReportCase *report);

/* The worst segments of a comparison as compare_json has them. New reference. */
json_t *worst_segments_json(const CompareResult *result);

/* Appends a number for people, to three digits but for counts, and its unit, "level" of 1. */
void report_number(Text *out, double value, const char *unit);
/* HTML about one plane: the rows of its rules, and tables of its measures. */
void report_rule_rows(const CompareResult *plane, Text *out);
void report_metric_tables(const CompareResult *plane, Text *out);
void report_surface_rows(const SurfaceCheck *surface, Text *rules, Text *metrics);
void report_exact_rows(const CompareResult *exact, Text *rules, Text *metrics);
void report_settled_rows(const ReportCase *report, Text *rules, Text *metrics);

/* Appends a picture as a data: URI. */
MUST_CHECK Status report_picture(Text *out, const Picture *picture, Err *err);
/* Appends the depths and normals of both sides as data: URIs for the page's script, "data:," for
 * what is not known or larger than 4 million pixels. Depth: 0 for nothing, else 1 to 65534 over
 * range_mm, in red and green; normals: 128 + 127 n; the angle between them in 0.001 degrees, in red
 * and green. B is less A, modulo the range of the codes. */
typedef enum ReportPlane {
    REPORT_DEPTH_A,
    REPORT_DEPTH_B,
    REPORT_NORMAL_A,
    REPORT_NORMAL_B,
    REPORT_ANGLES,
    REPORT_PLANES
} ReportPlane;
MUST_CHECK Status report_planes(const ReportSide *a, const ReportSide *b,
                                Text *parts[REPORT_PLANES], double range_mm[2], Err *err);
/* A small copy of a picture, at most 96 pixels across, each the mean of a box. */
MUST_CHECK Status report_thumbnail(Picture *out, const Picture *picture, Err *err);

/* What marks the parts of a page with one case, for report_merge to find. */
#define REPORT_FIRST_CASE "case-1"
#define REPORT_ROW_BEGIN "<!-- row: begin -->\n"
#define REPORT_ROW_END "<!-- row: end -->\n"
#define REPORT_CASE_BEGIN "<!-- case: begin -->\n"
#define REPORT_CASE_END "<!-- case: end -->\n"

/* A page about cases; all is HTML and borrowed. */
typedef struct ReportFrame {
    const char *title, *heading, *sentence;
    const char *rows, *cases, *power;
    size_t n_cases;
    bool agrees;
} ReportFrame;

/* Appends the page; `templates` is the folder with report.html and case.html. */
MUST_CHECK Status report_frame(const ReportFrame *frame, const char *templates, Text *out,
                               Err *err);
/* Writes the page to `path`; `heat` is the difference picture. */
MUST_CHECK Status report_page(const ReportCase *report, const Picture *heat, const char *templates,
                              const char *path, Err *err);

#endif
