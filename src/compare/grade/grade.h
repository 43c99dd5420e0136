/* Grades a picture by an answer: by an interval for each channel of each pixel that is proven to
 * contain the true color [docs/ANSWERS.md]. No tolerance is needed, except one for the rounding of
 * colors in single precision. */
#ifndef CORCAST_COMPARE_GRADE_GRADE_H
#define CORCAST_COMPARE_GRADE_GRADE_H

#include "base/base.h"
#include "image/image.h"

/* Distance from the interval, in levels of 1/255 of sRGB, up to which a pixel counts as inside.
 * Renderers compute colors in single precision, and a code of 8 bits may round either way at a
 * tie. */
#define ANSWERGRADE_SLACK 0.005

/* An answer as it is read from its file. */
typedef struct AnswerFile {
    Plane low, high;  /* linear colors, 3 channels; owned */
    Plane state;      /* 1 channel: 0 where the pixel is decided; owned */
    char pattern[16]; /* "3", or "area" */
    char scene[72];   /* digest of the scene */
    char width[32];
} AnswerFile;

/* Returns true if the file is an answer: an OpenEXR file with the attribute "answer". */
bool answerfile_is(const char *path);
/* Reads an answer. Release it with answerfile_release, also after an error. Errors: STATUS_INPUT,
 * STATUS_MEMORY. */
MUST_CHECK Status answerfile_read(AnswerFile *answer, const char *path, Err *err);
void answerfile_release(AnswerFile *answer);

/* How a picture lies in the intervals. Distances are in levels of 1/255 of sRGB, positive where the
 * picture is brighter than the interval. */
typedef struct AnswerGrade {
    size_t pixels, undecided; /* undecided: pixels whose interval is wider than the answer's width;
                               * they are graded, too, because their interval is proven */
    size_t outside;           /* pixels with a channel outside its interval */
    size_t brighter, darker;  /* of these: by the sum of their channels' distances */
    double worst;             /* distance of the worst channel; 0: none is outside */
    int x, y, channel;        /* where that is: column, row, 0 red, 1 green, 2 blue */
    double mean[3];           /* per channel: mean distance over all pixels */
    bool certified;           /* no pixel is outside, and one at least is decided */
} AnswerGrade;

/* Grades an image of 3 channels or grey: codes of any gamma, or linear floats.
 *
 * distances  receives the worst channel's distance of each pixel, 1 channel; the caller releases
 *            it. NULL: not wanted.
 * Errors     STATUS_INPUT if the sizes differ; STATUS_MEMORY. */
MUST_CHECK Status answergrade_image(const AnswerFile *answer, const Image *image,
                                    AnswerGrade *grade, Plane *distances, Err *err);

/* Checks that the intervals of two answers of one scene intersect; they are then consistent. A
 * pixel whose intervals are disjoint counts as outside, and one of the answers is wrong. Errors:
 * STATUS_INPUT if the sizes, the scenes or the patterns differ. */
MUST_CHECK Status answergrade_answers(const AnswerFile *a, const AnswerFile *b, AnswerGrade *grade,
                                      Err *err);

/* Makes a picture of distances: grey where pixels are inside, red where they are brighter than the
 * answer, blue where they are darker, in full color from 8 levels on. Errors: STATUS_MEMORY. */
MUST_CHECK Status answergrade_picture(const Plane *distances, Picture *out, Err *err);

/* Appends the verdict as one sentence. */
void answergrade_text(const AnswerGrade *grade, Text *out);
/* Returns the grade as JSON: a new reference, NULL if memory runs out. */
json_t *answergrade_json(const AnswerGrade *grade);

#endif
