/* The parts of a report. Private to the module compare. */
#ifndef CORCAST_COMPARE_REPORT_PAGE_H
#define CORCAST_COMPARE_REPORT_PAGE_H

#include "compare/report/report.h"

/* Appends the report as JUnit XML, a test case for each check. */
void report_junit(const ReportCase *report, Text *out);

/* Return parts of a report as JSON, a new reference each; NULL if memory runs out. The worst
 * segments are the same as in compare_json. */
json_t *worst_segments_json(const CompareResult *result);
json_t *settled_json(const Settled *settled);
json_t *surface_check_json(const SurfaceCheck *check);
json_t *witness_json(const Witness *witness);

/* Appends a number with three significant digits, integers with all digits, and its unit. After the
 * number 1 the unit loses its last "s". */
void text_rounded(Text *out, double value, const char *unit);
/* Appends the rows of the page's table of rules, and its tables of measures. */
MUST_CHECK Status report_tables(const ReportCase *report, const char *templates, Text *rules,
                                Text *measures, Err *err);

/* Pictures of depths and normals for the page's script, 8 bits per channel.
 *
 * Depths are numbers of two bytes in red and green: 0 where nothing is seen, else 1 to 65534 over
 * the range of depths. Normals are 128 + 127 n. Angles between normals are in 0.001 degrees, in red
 * and green. Pictures of B hold B - A, modulo the range of the codes. */
typedef enum ReportPlane {
    REPORT_DEPTH_A,
    REPORT_DEPTH_B,
    REPORT_NORMAL_A,
    REPORT_NORMAL_B,
    REPORT_ANGLES,
    REPORT_PLANES
} ReportPlane;
/* Appends these pictures as data: URIs, "data:," for planes that are unknown or larger than 4
 * million pixels. Sets the range of depths. Errors: STATUS_MEMORY. */
MUST_CHECK Status report_planes(const Rendering *a, const Rendering *b, Text *parts[REPORT_PLANES],
                                double range_mm[2], Err *err);
/* Makes a copy at most 96 pixels wide, each pixel of which is the mean of a square. The caller
 * releases it. Errors: STATUS_MEMORY. */
MUST_CHECK Status report_thumbnail(Picture *out, const Picture *picture, Err *err);

/* The name of the case in the templates case.html and row.html, the mark that report_merge replaces
 * by the folder of the case, and the marks between which report_merge finds the parts of a page. */
#define REPORT_FIRST_CASE "case-1"
#define REPORT_FOLDER "<!-- folder -->"
#define REPORT_ROW_BEGIN "<!-- row: begin -->\n"
#define REPORT_ROW_END "<!-- row: end -->\n"
#define REPORT_CASE_BEGIN "<!-- case: begin -->\n"
#define REPORT_CASE_END "<!-- case: end -->\n"

/* A page about cases. All members are borrowed. `title`, `heading` and `sentence` are text; `rows`,
 * `cases`, `power` and `others`, a list of cases without pictures, are markup. */
typedef struct ReportFrame {
    const char *title, *heading, *sentence;
    const Text *rows, *cases, *power, *others;
    size_t n_cases;
    bool agrees;
} ReportFrame;

/* Writes the page to `path`; `templates` is the folder with report.html and the templates of its
 * parts. */
MUST_CHECK Status report_write_frame(const ReportFrame *frame, const char *templates,
                                     const char *path, Err *err);
/* Appends the row of a case and its section, with the marks above. `heat` is the difference
 * picture. */
MUST_CHECK Status report_parts(const ReportCase *report, const Picture *heat, const char *templates,
                               Text *row, Text *section, Err *err);
/* Appends a row or a section as that of the case with this number, from 1. `folder` is the folder
 * of the case; NULL: none is shown. */
void report_put_part(Text *out, const char *part, size_t size, size_t number, const char *folder);
/* Writes the page to `path`; `heat` is the difference picture. */
MUST_CHECK Status report_page(const ReportCase *report, const Picture *heat, const char *templates,
                              const char *path, Err *err);

#endif
