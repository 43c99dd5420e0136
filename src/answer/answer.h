/* The public header of the module answer: for each pixel of a scene, an interval of linear colors
 * that is proven to contain the pixel's true color.
 *
 * A pattern answer is the mean over the sample positions of a renderer: the center of the pixel
 * and, for N >= 2, N x N positions more, all N x N + 1 of one weight [view.h,
 * camera_sample_offsets]. An area answer is the integral over the pixel's square. docs/ANSWERS.md
 * defines the true color and proves the bounds.
 *
 *     Answer answer;
 *     TRY(answer_make(&scene, &params, &answer, err));
 *     answer_release(&answer); */
#ifndef CORCAST_ANSWER_ANSWER_H
#define CORCAST_ANSWER_ANSWER_H

#include "base/base.h"
#include "image/image.h"
#include "scene/scene.h"

enum { ANSWER_MAX_PATTERN = 63 };

typedef struct AnswerParams {
    int pattern;  /* N, 1..ANSWER_MAX_PATTERN; 0: area answers */
    double width; /* a pixel is decided if its interval is at most this wide in each channel, in
                   * sRGB from 0 to 1 */
    int leaves;   /* area answers: most leaves per pixel */
    bool squares; /* area answers: leaves are squares, not turned along vessels; for tests */
    bool shadows;
    int certified; /* number of pixels that show a vessel whose claims are written to certificate */
    Text *certificate; /* receives JSON; NULL: no certificate; borrowed */
    int threads;       /* 0: all processors */
    bool (*progress)(double fraction, void *context); /* as RenderParams.progress; NULL: none */
    void *progress_context;
} AnswerParams;

typedef enum AnswerState {
    ANSWER_DECIDED,
    ANSWER_UNDECIDED,  /* a ray runs through an edge, to rounding errors: the interval is wide */
    ANSWER_OVER_BUDGET /* area answers: the limit of leaves was reached */
} AnswerState;

/* The channels of an answer's plane. Floats are rounded outwards. */
enum {
    ANSWER_LOW = 0,   /* red, green, blue */
    ANSWER_HIGH = 3,  /* red, green, blue */
    ANSWER_STATE = 6, /* an AnswerState */
    ANSWER_ID,        /* SWC id of the segment at the pixel's center; 0: none, or not decided */
    ANSWER_NEAR,      /* bounds of the depth there, mm; infinite if nothing is hit */
    ANSWER_FAR,
    ANSWER_CHANNELS
};

typedef struct Answer {
    Plane plane;      /* ANSWER_CHANNELS channels; owned */
    size_t undecided; /* number of pixels that are not ANSWER_DECIDED */
    size_t beams;     /* number of rays or leaves */
    HashText scene;   /* of everything that the colors depend on, without pattern and width */
} Answer;

/* Computes the answer of each pixel. The bytes do not depend on the number of threads.
 *
 * scene    a geometry of cylinders and balls, all ends explicit [Geometry.implied_ends].
 * out      release it with answer_release. Set on success only.
 * Errors   STATUS_USAGE, with the field that would help, if the scene is outside the assumptions:
 *          vessels that are not in front of the camera, effects, another model. STATUS_CANCELLED,
 *          STATUS_MEMORY. */
MUST_CHECK Status answer_make(const Scene *scene, const AnswerParams *params, Answer *out,
                              Err *err);
void answer_release(Answer *answer);

/* Returns a digest of the numbers of a scene that determine its colors. */
HashText answer_scene_hash(const Scene *scene, bool shadows);

#endif
