/* The operation `suite`: lets a renderer draw the scenes of the tube suite, and compares each pixel
 * with an interval that is proven to contain its correct color [compare/grade/grade.h]. The tube
 * suite is a list of small trees that are drawn as cylinders, in templates/suite/scenes.ini.
 *
 * Call tubesuite_run, then tubesuite_text or tubesuite_json, then tubesuite_release. */
#ifndef CORCAST_JOB_VERIFY_TUBESUITE_H
#define CORCAST_JOB_VERIFY_TUBESUITE_H

#include "compare/compare.h"
#include "job/verify/renderer_options.h"

/* The formats of the scene files that the renderer reads. */
typedef enum TubeFormat {
    SUITE_POV,
    SUITE_TACHYON,
    SUITE_JSON,
    SUITE_SWC,
    SUITE_FORMATS
} TubeFormat;

/* What the options of `suite` set. */
typedef struct TubeSuiteOptions {
    RendererOptions renderer;
    const char *title; /* name of the renderer on the score card; NULL: the command */
    TubeFormat format;
    double levels; /* maximum distance of a correct pixel from its interval, in levels of 1/255 */
} TubeSuiteOptions;

/* A scene of the suite and its grade. */
typedef struct TubeCase {
    char *name, *group, *look, *options, *tree; /* values of these keys in scenes.ini; owned */
    int rows;                                   /* number of rows of the tree's SWC file */
    ShellDrawing *drawing; /* element of TubeSuite.drawings; drawing->is_drawn is true if there is a
                            * picture of the right size; borrowed */
    size_t wrong;   /* number of pixels that are farther than options->levels from their interval */
    bool certified; /* the scene is drawn, no pixel is wrong, and at least one pixel is decided: its
                     * interval is narrow enough to judge it */
    AnswerGrade grade; /* grade of the picture; zeroed unless it is drawn */
} TubeCase;

/* The score card. Zeroed: empty. Release with tubesuite_release. */
typedef struct TubeSuite {
    const TubeSuiteOptions *options; /* borrowed */
    ARRAY(TubeCase) cases;
    ShellDrawing *drawings;  /* per case; owned */
    size_t drawn, certified; /* numbers of cases that are drawn, and that are certified */
} TubeSuite;

enum {
    SUITE_PIXELS = 64
}; /* width and height of the pictures in pixels; the proven intervals are for this size. Reason of
    * the value not recorded. */

extern const Command command_suite;

void tubesuite_release(TubeSuite *suite);

/* Writes the scenes into options->renderer.folder/scenes, lets the renderer draw them, and grades
 * the pictures. Writes NAME.png and NAME.distance.png for each scene, suite.json and index.html. A
 * picture that is not certified is not an error.
 *
 * suite   zeroed before; release it even after an error.
 * Errors  STATUS_TOOL if no scene is drawn; STATUS_USAGE if the options name no shell command or no
 *         folder; STATUS_INPUT for a malformed scenes.ini; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status tubesuite_run(const TubeSuiteOptions *options, TubeSuite *suite, Err *err);

/* Appends the score card as text: a sentence, and a line for each scene that is not certified. */
void tubesuite_text(const TubeSuite *suite, Text *out);
/* Returns the score card as JSON: a new reference; NULL if memory runs out. */
json_t *tubesuite_json(const TubeSuite *suite);
/* Appends the score card as an HTML page. Its links to pictures are relative to
 * options->renderer.folder. */
void tubesuite_page(const TubeSuite *suite, Text *out);

#endif
