/* Grades a picture by an answer. An answer is a file of `corcast answer`: for each channel of each
 * pixel it has an interval that is proven to contain the true color [docs/ANSWERS.md]. The only
 * tolerance is ANSWERGRADE_SLACK, for the rounding of colors.
 *     status = answerfile_read(&answer, "answer.exr", err);
 *     if (status == STATUS_OK)
 *         status = answergrade_image(&answer, &image, &grade, NULL, err);
 *     answerfile_release(&answer);
 *     answergrade_text(&grade, &out); */
#ifndef CORCAST_COMPARE_GRADE_GRADE_H
#define CORCAST_COMPARE_GRADE_GRADE_H

#include "base/base.h"
#include "image/image.h"

/* Distance from the interval, in levels of 1/255 of sRGB, up to which a channel counts as inside.
 * Renderers compute colors in single precision, so a color near the middle between two 8-bit codes
 * may get either code. */
#define ANSWERGRADE_SLACK 0.005

/* An answer that was read from a file. */
typedef struct AnswerFile {
    Plane low, high;  /* linear colors, 3 channels; owned */
    Plane state;      /* 1 channel: 0 where the pixel is decided; owned */
    char pattern[16]; /* pattern of the samples of a pixel: "3" for 3 x 3 and the center; or "area":
                       * the mean over the pixel's area */
    char scene[72];   /* hash of the scene [answer_scene_hash, answer/answer.h] */
    char width[32];   /* maximum width of the interval of a decided pixel, in sRGB from 0 to 1:
                       * "1/510" */
} AnswerFile;

/* Returns true if the file is an answer: an OpenEXR file with the attribute "answer". */
bool answerfile_is(const char *path);
/* Reads an answer. Release it with answerfile_release, also after an error. Errors: STATUS_INPUT if
 * the file is not an answer or malformed; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status answerfile_read(AnswerFile *answer, const char *path, Err *err);
void answerfile_release(AnswerFile *answer);

/* The grade of a picture. The distance of a channel is its distance from its interval, in levels of
 * 1/255 of sRGB or of the picture's own gamma. It is positive if the picture is brighter than the
 * interval. It is 0 inside the interval and up to ANSWERGRADE_SLACK outside. */
typedef struct AnswerGrade {
    size_t pixels, undecided; /* numbers of all pixels, and of pixels whose interval is wider than
                               * the answer's width. Undecided pixels are also graded, because their
                               * intervals are proven. */
    size_t outside;           /* number of pixels with a channel outside its interval */
    size_t brighter, darker;  /* numbers of outside pixels whose channel distances have a positive
                               * sum, and of the other outside pixels */
    double worst;      /* the distance with the largest magnitude; 0: no channel is outside */
    int x, y, channel; /* of `worst`: column, row, and 0 red, 1 green or 2 blue */
    double mean[3];    /* per channel: mean distance over all pixels */
    bool certified;    /* no pixel is outside, and at least one pixel is decided */
} AnswerGrade;

/* Grades an image of 3 channels or 1 (grey), with codes of any gamma or linear floats. A code
 * represents all colors that are rounded to it. NaN has an infinite distance from its interval.
 *
 * distances  receives the distance of each pixel's worst channel, as a plane of 1 channel; the
 *            caller releases it. NULL: not wanted.
 * Errors     STATUS_INPUT if the sizes differ; STATUS_MEMORY. */
MUST_CHECK Status answergrade_image(const AnswerFile *answer, const Image *image,
                                    AnswerGrade *grade, Plane *distances, Err *err);

/* Compares two answers for one scene. Both contain the true color, so their intervals must
 * intersect. A pixel with disjoint intervals counts as outside: at least one answer is wrong there.
 * Distances are positive where b is brighter than a. A pixel is undecided if it is undecided in a
 * or b.
 *
 * Errors  STATUS_INPUT if the sizes, the scenes or the sample patterns differ. */
MUST_CHECK Status answergrade_answers(const AnswerFile *a, const AnswerFile *b, AnswerGrade *grade,
                                      Err *err);

/* Makes a picture of the distances from answergrade_image. Pixels inside their intervals are grey,
 * brighter pixels are red, and darker pixels are blue. The color is saturated at a distance of 8
 * levels or more. The caller releases *out. Errors: STATUS_MEMORY. */
MUST_CHECK Status answergrade_picture(const Plane *distances, Picture *out, Err *err);

/* Appends the verdict as a line of text. If a pixel is outside, appends two more lines: the worst
 * channel, and the mean distances. */
void answergrade_text(const AnswerGrade *grade, Text *out);
/* Returns the grade as JSON: a new reference, NULL if memory runs out. */
json_t *answergrade_json(const AnswerGrade *grade);

#endif
