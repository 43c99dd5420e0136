/* The operation `answer`: computes a proven interval for each pixel of a scene and writes the
 * intervals to an OpenEXR file, by which `compare` grades pictures. The interval certainly contains
 * the color of the pixel. A pixel is decided if its interval is narrow enough. */
#ifndef CORCAST_JOB_VERIFY_ANSWER_H
#define CORCAST_JOB_VERIFY_ANSWER_H

#include "answer/answer.h"
#include "job/picture/picture.h"

/* The options of `answer`. Strings are borrowed from the parsed command line. */
typedef struct AnswerOptions {
    const char *output;
    const char *certificate; /* file for the certificate [answer/certificate.h]; NULL: none */
    const char *width; /* greatest width of a decided interval, in sRGB from 0 to 1: "1/510" or a
                        * number */
    int pattern;       /* AnswerParams.pattern, unless `area` is set */
    int body;          /* geometry of the vessels: cylinders or rounded */
    /* Area answers instead of pattern answers; `pattern` is specified; AnswerParams.squares. */
    bool area, has_pattern, squares;
    int leaves;    /* AnswerParams.leaves */
    double filter; /* AnswerParams.filter */
    PictureOptions picture;
} AnswerOptions;

extern const Command command_answer;

/* Facts about an answer that was written. */
typedef struct AnswerReport {
    size_t pixels, undecided, beams; /* counts: all pixels; Answer.undecided; Answer.beams */
    double cpu_s;                    /* CPU time of all threads */
    HashText scene;                  /* answer_scene_hash */
} AnswerReport;

/* Makes the scene, computes its answer and writes options->output.
 *
 * report  set on success only.
 * Errors  STATUS_USAGE if the answer is not defined for an option, such as ambient occlusion, or
 *         for the scene [answer_make]; the errors of picture_scene; STATUS_CANCELLED; STATUS_IO;
 *         STATUS_MEMORY. */
MUST_CHECK Status answer_run(AnswerOptions *options, Parsed *parsed, AnswerReport *report,
                             Err *err);
/* Returns the report as JSON: a new reference; NULL if memory runs out. */
json_t *answer_json(const AnswerReport *report);

#endif
