/* Writes the results of comparisons as JSON, text, JUnit XML and HTML pages with the pictures.
 *
 * compare_json, compare_text and compare_junit write one CompareResult. A ReportCase describes two
 * renderings of a scene with all their comparisons; report_write writes a folder with a page about
 * it. report_merge combines several such folders in one page. suite_write_page writes a page about
 * a folder of pictures. If memory runs out in a function that appends to a Text, the Text records
 * it, and text_check reports it. */
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
/* Appends the result as JUnit XML: a test suite with a test case per rule. The time is divided
 * evenly among the test cases.
 *
 * name      name of the test suite.
 * seconds   duration of the comparison. */
void compare_junit(const CompareResult *result, const char *name, double seconds, Text *out);

/* ---- reports of one scene -------------------------------------------------------------------- */

/* One of the two programs that rendered a scene, or one of two files. All members are borrowed. */
typedef struct ReportSide {
    const char *name;    /* "POV-Ray" */
    const char *key;     /* its key in JSON: "povray", "native", "a", "b" */
    const char *version; /* "3.7.0.10"; "": none */
    double seconds;      /* wall-clock time of the color picture, sum over tiles; NAN: unknown */
    size_t tiles;        /* tiles that the picture was drawn in; 0: unknown */
    Rendering shown;     /* picture, ids, depth and normal; ids, depth and normal are NULL in both
                          * sides if they are unknown */
} ReportSide;

/* Two renderings of one scene, A and B, and the comparisons of them. All members are borrowed. */
typedef struct ReportCase {
    const char *name;  /* name of the scene: "demo"; one line */
    const char *model; /* vessel geometry: "rounded"; "": none */
    ReportSide a, b;
    const char *sentence;        /* replaces the sentence about the verdict; NULL: not replaced */
    const char *accept;          /* shell command that accepts B as the reference; NULL: none */
    const char *const *commands; /* shell commands that repeat the report */
    size_t n_commands;
    const CompareResult *planes[PLANE_KINDS]; /* NULL: not compared; PLANE_COLOR is required */
    const SurfaceCheck *surface;              /* NULL: the model is no implicit surface */
    const CompareResult *alpha;               /* NULL: the pictures are opaque */
    /* comparison of A with a picture that corcast computes at the exact position of the surface.
     * NULL: the model is no implicit surface. */
    const CompareResult *exact;
    const Settled *settled; /* NULL: no pixel was examined */
    const Witness *witness; /* NULL: no third program drew the scene */
} ReportCase;

/* Returns true if all comparisons and checks of the case agree. */
bool report_agrees(const ReportCase *report);
/* Returns the report with the keys of `verify --json`. The caller releases it. Returns NULL if
 * memory runs out. */
json_t *report_json(const ReportCase *report);

/* Writes report.html, report.json, junit.xml and diff.png into `folder`, which must exist. The page
 * contains its pictures and needs no network. After an error some files may be missing.
 *
 * templates   the folder with the HTML templates.
 * Errors      STATUS_INPUT for a template; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status report_write(const ReportCase *report, const char *templates, const char *folder,
                               Err *err);
/* Writes the page only, to the file `path`. Errors: those of report_write. */
MUST_CHECK Status report_write_page(const ReportCase *report, const char *templates,
                                    const char *path, Err *err);

/* The input of report_merge. All members are borrowed. */
typedef struct ReportMerge {
    const char *const *folders; /* n folders that report_write has written */
    size_t n;
    const char *power;     /* JSON file of `make power`, which measures the faults that comparisons
                            * detect [cause/power.h]; NULL: none */
    const char *templates; /* the folder with the HTML templates */
} ReportMerge;

/* Writes one page about the cases of all folders to the file `path`, the worst disagreement first.
 *
 * all_agree   receives true if all cases agree; set on success only.
 * Errors      STATUS_INPUT if a folder has no report of this version of corcast; STATUS_IO;
 *             STATUS_MEMORY. */
MUST_CHECK Status report_merge(const ReportMerge *merge, const char *path, bool *all_agree,
                               Err *err);

/* ---- a folder of pictures -------------------------------------------------------------------- */

/* Writes one page about the result of suite_judge to the file `path`. It shows each case that
 * fails, with the command that accepts it, and lists the unused files. Reads and compares the
 * pictures again. Errors: STATUS_INPUT for a template or a picture; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status suite_write_page(const Suite *suite, const SuiteFolders *folders,
                                   const char *templates, const char *path, Err *err);

#endif
