/* Makes the parts of a report: JSON of its checks, the HTML page, and the pictures of the page.
 * Private to the module compare.
 *
 * report_parts makes the table row and the section of each case; report_write_frame puts rows and
 * sections into a page. report_merge [report.h] takes the rows and sections out of existing pages,
 * and puts them into a new page.
 *
 * `templates` is always the folder of the HTML templates. Unless stated otherwise, errors are
 * STATUS_INPUT for a missing or malformed template [tmpl.h], STATUS_IO and STATUS_MEMORY. */
#ifndef CORCAST_COMPARE_REPORT_PAGE_H
#define CORCAST_COMPARE_REPORT_PAGE_H

#include "compare/report/report.h"

/* Appends the report as JUnit XML: a test suite with a test case per check. */
void report_junit(const ReportCase *report, Text *out);

/* Return parts of a report as JSON: new references, which the caller releases; NULL if memory runs
 * out. worst_segments_json returns the array `worst_segments` of compare_json's object. */
json_t *rules_json(const Rule *rules, int n);
json_t *worst_segments_json(const CompareResult *result);
json_t *settled_json(const Settled *settled);
json_t *surface_check_json(const SurfaceCheck *check);
json_t *witness_json(const Witness *witness);

/* Appends a number and its unit. Integers are written in full. Other numbers of 1000 or more are
 * rounded to integers, smaller ones to three significant digits. After the number 1, the unit loses
 * its last "s". */
void text_rounded(Text *out, double value, const char *unit);
/* Appends the rows of the table of rules to `rules`, and the tables of measures to `measures`, as
 * HTML. Errors: STATUS_INPUT for a template, STATUS_MEMORY. */
MUST_CHECK Status report_tables(const ReportCase *report, const char *templates, Text *rules,
                                Text *measures, Err *err);

/* Pictures that store depths and normals for the script of the page, with 8 bits per channel.
 *
 * A depth is a 16-bit number, whose high byte is red and whose low byte is green: 0 if no surface
 * is visible, else 1 (nearest) to 65534 (farthest). A component n of a normal is stored as 128 +
 * 127 n; 0 0 0 if no surface is visible. The angle between the normals of A and B is a 16-bit
 * number in units of 0.001 degrees. The pictures of B contain B - A, modulo the range of the
 * numbers, because small numbers compress well. */
typedef enum ReportPlane {
    REPORT_DEPTH_A,
    REPORT_DEPTH_B,
    REPORT_NORMAL_A,
    REPORT_NORMAL_B,
    REPORT_ANGLES,
    REPORT_PLANES
} ReportPlane;
/* Appends each of these pictures to its text, as a data: URI. Appends "data:," instead for planes
 * that are NULL or have more than 2^22 pixels, which would make the page too large.
 *
 * range_mm   receives the smallest and the largest depth, also after an error; 0 0: no depth.
 * Errors     STATUS_MEMORY. */
MUST_CHECK Status report_planes(const Rendering *a, const Rendering *b, Text *parts[REPORT_PLANES],
                                double range_mm[2], Err *err);
/* Makes a reduced copy with 8 bits per channel, at most 96 pixels wide to fit into a table row.
 * Each of its pixels is the mean of a square of pixels. The caller releases *out. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status report_thumbnail(Picture *out, const Picture *picture, Err *err);

/* Placeholders and marks in rows and sections. report_put_part replaces the placeholder
 * REPORT_FIRST_CASE by "case-N", and the placeholder REPORT_FOLDER by the folder of the case.
 * report_merge finds row and section between the marks BEGIN and END. */
#define REPORT_FIRST_CASE "case-1"
#define REPORT_FOLDER "<!-- folder -->"
#define REPORT_ROW_BEGIN "<!-- row: begin -->\n"
#define REPORT_ROW_END "<!-- row: end -->\n"
#define REPORT_CASE_BEGIN "<!-- case: begin -->\n"
#define REPORT_CASE_END "<!-- case: end -->\n"

/* The content of a page about one or more cases. All members are borrowed. */
typedef struct ReportFrame {
    const char *title, *heading, *sentence; /* plain text */
    const Text *rows, *cases; /* HTML: the rows of the table of cases, and the sections */
    const Text *power;  /* HTML: the table of test faults that comparisons detect [power_text];
                         * empty: none */
    const Text *others; /* HTML: a list of cases without pictures; empty: none */
    size_t n_cases;     /* number of sections */
    bool agrees;        /* the verdict in the head of the page */
} ReportFrame;

/* Writes the page to the file `path`. */
MUST_CHECK Status report_write_frame(const ReportFrame *frame, const char *templates,
                                     const char *path, Err *err);
/* Appends the table row of a case and its section, with the marks above. `heat` is the picture of
 * the difference [heat_picture]. Errors: STATUS_INPUT for a template, STATUS_MEMORY. */
MUST_CHECK Status report_parts(const ReportCase *report, const Picture *heat, const char *templates,
                               Text *row, Text *section, Err *err);
/* Appends a row or a section, and replaces its placeholders.
 *
 * part, size   the row or section as report_parts made it, and its length in bytes.
 * number       the number N of the case on the new page, from 1.
 * folder       the folder of the case; NULL: none is shown. */
void report_put_part(Text *out, const char *part, size_t size, size_t number, const char *folder);
/* Writes a page about one case to the file `path`. `heat` as for report_parts. */
MUST_CHECK Status report_page(const ReportCase *report, const Picture *heat, const char *templates,
                              const char *path, Err *err);

#endif
