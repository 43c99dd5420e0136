/* The public header of the module answer: computes for each pixel of a scene an interval of linear
 * colors that is proven to contain the pixel's true color.
 *
 * There are two definitions of the true color. A pattern answer bounds the mean of the colors at a
 * renderer's sample positions, all with the same weight. With N = AnswerParams.pattern, the center
 * of the pixel is a position; if N >= 2, there are N x N more positions [camera_sample_offsets,
 * view.h]. An area answer bounds the mean over the area of the pixel. docs/ANSWERS.md proves the
 * bounds.
 *
 * Each header uses only the ones before it in this list:
 *
 * affine.h                   numbers with a proven error bound
 * faces.h, triangleface.h,
 * jointface.h                surfaces, and hits of rays
 * answerplan.h               the data that all pixels share
 * levelray.h, levelterm.h    rays through sums of terms
 * isosurface.h               rays through isosurfaces and blobs
 * light.h                    shading and shadows
 * interval.h                 intervals of colors
 * workspace.h                the answers of pixels
 * region.h                   integrals over parts of a pixel
 * certificate.h              proofs for independent checkers
 *
 *     Answer answer;
 *     TRY(answer_make(&scene, &params, &answer, err));
 *     answer_release(&answer); */
#ifndef CORCAST_ANSWER_ANSWER_H
#define CORCAST_ANSWER_ANSWER_H

#include "base/base.h"
#include "image/image.h"
#include "scene/scene.h"

/* Largest AnswerParams.pattern. It has 63 x 63 + 1 = 3970 sample positions; pattern.c bounds the
 * rounding errors of a sum of up to 4000 colors. */
enum { ANSWER_MAX_PATTERN = 63 };

typedef struct AnswerParams {
    int pattern;  /* samples along each side of a pixel, 1 to ANSWER_MAX_PATTERN; 0: area answers */
    double width; /* a pixel is decided if its interval is at most this wide in each channel, in
                   * sRGB from 0 to 1 */
    int leaves;   /* area answers: maximum number of leaves (parts) that a pixel is divided into */
    double filter; /* area answers: side of the square, centred on a pixel, whose mean color is the
                    * color of the pixel; 1 to 2 pixels */
    bool squares;  /* area answers, for tests: true: leaves stay squares; false: leaves are turned
                    * along vessels */
    bool shadows;  /* false: nothing blocks light */
    int certified; /* maximum number of pixels in the certificate, at least 1. They are spread
                    * evenly over the pixels whose center shows a vessel. */
    Text *certificate; /* receives the certificate as JSON; NULL: no certificate; borrowed */
    int threads;       /* 0: all processors */
    bool (*progress)(double fraction, void *context); /* returns false to stop; NULL: none */
    void *progress_context;
} AnswerParams;

typedef enum AnswerState {
    ANSWER_DECIDED,    /* the interval is at most AnswerParams.width wide */
    ANSWER_UNDECIDED,  /* pattern answers: the interval is wider, usually because a ray passes an
                        * edge within its rounding errors */
    ANSWER_OVER_BUDGET /* area answers: the interval is wider, and the pixel has AnswerParams.leaves
                        * leaves */
} AnswerState;

/* The channels of Answer.plane. Bounds are rounded outwards to floats. */
enum {
    ANSWER_LOW = 0,   /* red, green, blue */
    ANSWER_HIGH = 3,  /* red, green, blue */
    ANSWER_STATE = 6, /* an AnswerState */
    ANSWER_ID,   /* SWC id of the segment at the pixel's center; 0: no vessel is there, or rounding
                  * errors leave open which one */
    ANSWER_NEAR, /* lower bound of the vessel's depth at the center, mm; infinity: no vessel */
    ANSWER_FAR,  /* upper bound of this depth, mm; infinity: no vessel, or open which one */
    ANSWER_CHANNELS
};

typedef struct Answer {
    Plane plane;      /* ANSWER_CHANNELS channels; owned */
    size_t undecided; /* number of pixels that are not ANSWER_DECIDED */
    size_t beams;     /* number of rays (pattern answers) or leaves (area answers) computed */
    HashText scene;   /* answer_scene_hash */
} Answer;

/* Computes the answer of each pixel.
 *
 * scene    its model has cylinders and balls, triangles or, for pattern answers only, joints, a
 *          potential or a blob; Geometry.implied_ends is false.
 * out      release it with answer_release. Set on success only.
 * Errors   STATUS_USAGE, with the member to change in backquotes, if the answer is not defined for
 *          the scene: it has effects such as outlines; an area answer is asked for a model that has
 *          only pattern answers; a vessel is not in front of the camera, or is behind the plane
 *          from which a parallel light starts. STATUS_CANCELLED. STATUS_MEMORY.
 * Threads  the result does not depend on the number of threads. */
MUST_CHECK Status answer_make(const Scene *scene, const AnswerParams *params, Answer *out,
                              Err *err);
void answer_release(Answer *answer);

/* Returns a hash of everything in a scene that determines its colors. Two answers with the same
 * hash and the same pattern bound the same colors. */
HashText answer_scene_hash(const Scene *scene, bool shadows);
/* Returns the numbers of a scene as JSON, for programs that do not read scene languages: lengths in
 * mm, linear colors. The caller releases it. Returns NULL if memory runs out. */
json_t *answer_scene_json(const Scene *scene, bool shadows);

#endif
