/* The operation `answer`: computes for each pixel of a scene an interval that is proven to contain
 * the pixel's color, and writes the intervals to an OpenEXR file. The command `compare` grades
 * pictures by this file. A pixel is decided if its interval is narrow enough. */
#ifndef CORCAST_JOB_VERIFY_ANSWER_H
#define CORCAST_JOB_VERIFY_ANSWER_H

#include "answer/answer.h"
#include "job/picture/picture.h"

/* The options of `answer`. Strings are borrowed from the parsed command line. */
typedef struct AnswerOptions {
    const char *output;
    const char *certificate; /* file of the certificate, a record for independent checkers
                              * [answer/certificate.h]; NULL: none */
    /* maximum width of a decided interval, in sRGB from 0 to 1: "1/510", or a number */
    const char *width;
    int pattern; /* AnswerParams.pattern: number of samples along each side of a pixel; not used
                  * with `area` */
    int body;    /* 0: cylinders; 1: rounded vessels */
    /* `area`: intervals of the mean color over each pixel's area, instead of a pattern of samples.
     * `has_pattern`: `pattern` is specified. `squares`: AnswerParams.squares. */
    bool area, has_pattern, squares;
    int leaves;    /* AnswerParams.leaves [answer/answer.h] */
    double filter; /* AnswerParams.filter */
    PictureOptions picture;
} AnswerOptions;

extern const Command command_answer;

/* The facts about an answer that was written. */
typedef struct AnswerReport {
    /* numbers of all pixels, of undecided pixels, and of rays (pattern answers) or leaves (area
     * answers) that were computed [answer/answer.h] */
    size_t pixels, undecided, beams;
    double cpu_s;   /* CPU time of all threads */
    HashText scene; /* hash of the scene [answer_scene_hash] */
} AnswerReport;

/* Makes the scene, computes its answer and writes options->output.
 *
 * options  is changed: values are set that follow from other options.
 * report   set on success only.
 * Errors   STATUS_USAGE if the answer is not defined for an option, such as ambient occlusion, or
 *          for the scene [answer_make]; the errors of picture_scene; STATUS_CANCELLED; STATUS_IO;
 *          STATUS_MEMORY. */
MUST_CHECK Status answer_run(AnswerOptions *options, Parsed *parsed, AnswerReport *report,
                             Err *err);
/* Returns the report as JSON: a new reference; NULL if memory runs out. */
json_t *answer_json(const AnswerReport *report);

#endif
