/* What was found, as JSON, text, JUnit XML, and as a page with the pictures. */
#ifndef CORCAST_COMPARE_REPORT_REPORT_H
#define CORCAST_COMPARE_REPORT_REPORT_H

#include "compare/checks/settled.h"
#include "compare/checks/surface_check.h"
#include "compare/checks/witness.h"
#include "compare/result.h"
#include "compare/suite/suite.h"

/* ---- one comparison -------------------------------------------------------------------------- */

/* Returns the result with the keys of `compare --json`; NAN and infinity are null. The caller
 * releases it. Returns NULL if memory runs out. */
json_t *compare_json(const CompareResult *result);
/* Appends the result as text: verdict, rules, measures, worst segments, one per line. */
void compare_text(const CompareResult *result, Text *out);
/* Appends the result as JUnit XML, a test case for each rule. They share the time.
 *
 * name      of the test suite.
 * seconds   that the comparison took. */
void compare_junit(const CompareResult *result, const char *name, double seconds, Text *out);

/* ---- reports of one scene -------------------------------------------------------------------- */

/* One of the two programs that rendered a scene, or one of two files. All members are borrowed. */
typedef struct ReportSide {
    const char *name;    /* "POV-Ray" */
    const char *key;     /* in JSON: "povray", "native", "a", "b" */
    const char *version; /* "3.7.0.10"; "": none */
    double seconds;      /* wall-clock time of the color picture, sum over tiles; NAN: unknown */
    size_t tiles;        /* tiles that the picture was drawn in; 0: unknown */
    Rendering shown;     /* its picture, and ids, depth and normal, each of which is NULL in both
                          * sides if it is unknown */
} ReportSide;

/* One scene as A, the reference, and B have it. All members are borrowed. */
typedef struct ReportCase {
    const char *name;  /* of the scene: "demo"; one line */
    const char *model; /* "rounded"; "": none */
    ReportSide a, b;
    const char *sentence;        /* replaces the sentence about the verdict; NULL: none does */
    const char *accept;          /* shell command that accepts B as the reference; NULL: none */
    const char *const *commands; /* how to repeat the report, one per line */
    size_t n_commands;
    const CompareResult *planes[PLANE_KINDS]; /* NULL: not compared; PLANE_COLOR is required */
    const SurfaceCheck *surface;              /* of an implicit model; NULL: of another model */
    const CompareResult *alpha;               /* of a transparent picture; NULL: it is opaque */
    /* Colors of an implicit surface where it is, compared with A's. NULL: of another model. */
    const CompareResult *exact;
    const Settled *settled; /* NULL: no pixel was examined */
    const Witness *witness; /* NULL: there is none */
} ReportCase;

/* Returns true if all planes, the surface and the witness agree, and not too much is settled. */
bool report_agrees(const ReportCase *report);
/* Returns the report with the keys of `verify --json`. The caller releases it. Returns NULL if
 * memory runs out. */
json_t *report_json(const ReportCase *report);

/* Writes report.html, report.json, junit.xml and diff.png into `folder`, which exists. The page
 * holds its pictures and needs no network.
 *
 * templates   the folder with the templates of the page.
 * Errors      STATUS_INPUT for a template; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status report_write(const ReportCase *report, const char *templates, const char *folder,
                               Err *err);
/* Writes the page alone, to `path`. */
MUST_CHECK Status report_write_page(const ReportCase *report, const char *templates,
                                    const char *path, Err *err);

/* What report_merge makes a page of. All members are borrowed. */
typedef struct ReportMerge {
    const char *const *folders; /* of report_write */
    size_t n;
    const char *power;     /* the file that `make power` writes; NULL: none */
    const char *templates; /* the folder with the templates of the page */
} ReportMerge;

/* Writes one page about all cases of the folders, worst first, to `path`. *all_agree becomes true
 * if all cases agree. Errors: STATUS_INPUT if a folder has no report of this version; STATUS_IO;
 * STATUS_MEMORY. */
MUST_CHECK Status report_merge(const ReportMerge *merge, const char *path, bool *all_agree,
                               Err *err);

/* ---- a folder of pictures -------------------------------------------------------------------- */

/* Writes one page about a suite that was judged: all cases that fail, each with the command that
 * accepts it, and the unused files. Pictures are read and compared again. Errors: STATUS_INPUT;
 * STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status suite_write_page(const Suite *suite, const SuiteFolders *folders,
                                   const char *templates, const char *path, Err *err);

#endif
