/* The operation `suite`: lets a renderer draw the scenes of the tube suite, and grades each picture
 * by the proven answer for its scene [compare/grade/grade.h]. The tube suite is a list of small
 * trees, templates/suite/scenes.ini, that are drawn as cylinders. */
#ifndef CORCAST_JOB_VERIFY_TUBESUITE_H
#define CORCAST_JOB_VERIFY_TUBESUITE_H

#include "compare/compare.h"
#include "job/verify/renderer_options.h"

/* The formats in which scenes are handed to the renderer. */
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
    double levels; /* largest distance of a right pixel from its interval, in levels of 1/255 */
} TubeSuiteOptions;

/* A scene of the suite and its grade. */
typedef struct TubeCase {
    char *name, *group, *look, *options, *tree; /* keys of templates/suite/scenes.ini; owned */
    int rows;                                   /* number of rows of the tree's SWC file */
    ShellDrawing *drawing;                      /* its element of TubeSuite.drawings; is_drawn: the
                                                 * picture has the right size */
    size_t wrong;   /* count of pixels that are farther than options->levels from their interval */
    bool certified; /* it is drawn, no pixel is wrong, and at least one pixel is decided */
    AnswerGrade grade; /* grade of the picture; zeroed unless it is drawn */
} TubeCase;

/* The score card. Zeroed: empty. Release with tubesuite_release. */
typedef struct TubeSuite {
    const TubeSuiteOptions *options; /* borrowed */
    ARRAY(TubeCase) cases;
    ShellDrawing *drawings;  /* per case; owned */
    size_t drawn, certified; /* number of these cases */
} TubeSuite;

enum { SUITE_PIXELS = 64 }; /* width and height of the pictures */

extern const Command command_suite;

void tubesuite_release(TubeSuite *suite);

/* Writes the scenes into options->renderer.folder/scenes, lets the renderer draw them, and grades
 * the pictures. Writes NAME.png and NAME.distance.png for each scene, suite.json and index.html.
 *
 * suite   zeroed before; release it even after an error. A picture that is not certified is not an
 *         error.
 * Errors  STATUS_TOOL if no scene is drawn; STATUS_USAGE; STATUS_INPUT; STATUS_IO; STATUS_MEMORY.
 */
MUST_CHECK Status tubesuite_run(const TubeSuiteOptions *options, TubeSuite *suite, Err *err);

/* Appends the score card as text: a sentence, and a line for each scene that is not certified. */
void tubesuite_text(const TubeSuite *suite, Text *out);
/* Returns the score card as JSON: a new reference; NULL if memory runs out. */
json_t *tubesuite_json(const TubeSuite *suite);
/* Appends the score card as an HTML page. Its links to pictures are relative to
 * options->renderer.folder. */
void tubesuite_page(const TubeSuite *suite, Text *out);

#endif
