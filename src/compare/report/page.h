/* The parts of a report. Private to the module compare. */
#ifndef CORCAST_COMPARE_REPORT_PAGE_H
#define CORCAST_COMPARE_REPORT_PAGE_H

#include "compare/report/report.h"

/* Appends the JUnit XML: a test case for each plane. */
void report_junit(const ReportCase *report, Text *out);

/* Return parts of a report as JSON; the worst segments are those that compare_json has. The caller
 * releases them. NULL if memory runs out. */
json_t *worst_segments_json(const CompareResult *result);
json_t *settled_json(const Settled *settled);
json_t *surface_check_json(const SurfaceCheck *check);
json_t *witness_json(const Witness *witness);

/* Appends the rows of the page's table of rules, and its tables of measures. */
MUST_CHECK Status report_tables(const ReportCase *report, const char *templates, Text *rules,
                                Text *measures, Err *err);

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

/* How the templates case.html and row.html call their case, where they have room for its folder,
 * and what marks them in a page, for report_merge to find. */
#define REPORT_FIRST_CASE "case-1"
#define REPORT_FOLDER "<!-- folder -->"
#define REPORT_ROW_BEGIN "<!-- row: begin -->\n"
#define REPORT_ROW_END "<!-- row: end -->\n"
#define REPORT_CASE_BEGIN "<!-- case: begin -->\n"
#define REPORT_CASE_END "<!-- case: end -->\n"

/* A page about cases. `title`, `heading` and `sentence` are text, `rows`, `cases` and `power`
 * markup; all is borrowed. */
typedef struct ReportFrame {
    const char *title, *heading, *sentence;
    const Text *rows, *cases, *power;
    size_t n_cases;
    bool agrees;
} ReportFrame;

/* Writes the page to `path`; `templates` is the folder with report.html and the templates of its
 * parts. */
MUST_CHECK Status report_write_frame(const ReportFrame *frame, const char *templates,
                                     const char *path, Err *err);
/* Writes the page to `path`; `heat` is the difference picture. */
MUST_CHECK Status report_page(const ReportCase *report, const Picture *heat, const char *templates,
                              const char *path, Err *err);

#endif
