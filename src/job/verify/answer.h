/* The operation `answer`: computes a proven interval for each pixel of a scene and writes the
 * intervals to an OpenEXR file, by which `compare` grades pictures. */
#ifndef CORCAST_JOB_VERIFY_ANSWER_H
#define CORCAST_JOB_VERIFY_ANSWER_H

#include "answer/answer.h"
#include "job/picture/picture.h"

/* The options of `answer`. Strings are borrowed from the parsed command line. */
typedef struct AnswerOptions {
    const char *output;
    const char *certificate; /* file of the claims of some pixels; NULL: none */
    const char *width;       /* greatest width of a decided interval: "1/510" or a number */
    int pattern;
    int body; /* geometry of the vessels: cylinders or rounded */
    bool area, has_pattern, squares;
    int leaves;
    PictureOptions picture;
} AnswerOptions;

extern const Command command_answer;

/* What was computed, for a report. */
typedef struct AnswerReport {
    size_t pixels, undecided, beams;
    double cpu_s;
    HashText scene;
} AnswerReport;

/* Makes the scene, computes its answer and writes options->output.
 *
 * Errors  STATUS_USAGE if an option has no answer or the scene is outside the assumptions of
 *         answers; the errors of picture_scene; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status answer_run(AnswerOptions *options, Parsed *parsed, AnswerReport *report,
                             Err *err);

#endif
