/* The public header of the module answer: for each pixel of a scene, an interval of linear colors
 * that is proven to contain the pixel's true color.
 *
 * A pattern answer bounds the mean of the colors at a renderer's sample positions. N is
 * AnswerParams.pattern. For N = 1, the center of the pixel is the only position. For N >= 2, there
 * are N x N more [view.h, camera_sample_offsets]. All positions have the same weight. An area
 * answer bounds the mean over the pixel's square. docs/ANSWERS.md defines the true color and proves
 * the bounds.
 *
 * The files, each of which uses only those before it: affine.h (numbers with proven errors),
 * faces.h and triangleface.h (surfaces and hits of rays), answerplan.h, levelray.h, isosurface.h
 * (rays through isosurfaces), light.h (shading and shadows), interval.h, workspace.h (pixels),
 * region.h (integrals), certificate.h.
 *
 *     Answer answer;
 *     TRY(answer_make(&scene, &params, &answer, err));
 *     answer_release(&answer); */
#ifndef CORCAST_ANSWER_ANSWER_H
#define CORCAST_ANSWER_ANSWER_H

#include "base/base.h"
#include "image/image.h"
#include "scene/scene.h"

/* Largest N. It has 63 x 63 + 1 = 3970 sample positions; pattern.c bounds the rounding errors of a
 * sum of up to 4000. */
enum { ANSWER_MAX_PATTERN = 63 };

typedef struct AnswerParams {
    int pattern;   /* N, 1..ANSWER_MAX_PATTERN; 0: area answers */
    double width;  /* a pixel is decided if its interval is at most this wide in each channel, in
                    * sRGB from 0 to 1 */
    int leaves;    /* area answers: a pixel that is divided into this many leaves is not divided
                    * further */
    bool squares;  /* area answers, for tests: leaves stay squares, not turned along vessels */
    bool shadows;  /* false: nothing blocks light */
    int certified; /* maximum number of pixels in the certificate, at least 1; they are spread
                    * evenly over the pixels whose center shows a vessel */
    Text *certificate; /* receives the certificate as JSON; NULL: no certificate; borrowed */
    int threads;       /* 0: all processors */
    bool (*progress)(double fraction, void *context); /* returns false to stop; NULL: none */
    void *progress_context;
} AnswerParams;

typedef enum AnswerState {
    ANSWER_DECIDED,    /* the interval is at most AnswerParams.width wide */
    ANSWER_UNDECIDED,  /* pattern answers: the interval is wider. Usually a ray passes an edge
                        * within its rounding errors */
    ANSWER_OVER_BUDGET /* area answers: the interval is wider, and the pixel has
                        * AnswerParams.leaves leaves */
} AnswerState;

/* The channels of an answer's plane. Bounds are rounded outwards to floats. */
enum {
    ANSWER_LOW = 0,   /* red, green, blue */
    ANSWER_HIGH = 3,  /* red, green, blue */
    ANSWER_STATE = 6, /* an AnswerState */
    ANSWER_ID,   /* SWC id of the segment at the pixel's center; 0: no vessel, or not decided */
    ANSWER_NEAR, /* lower bound of a vessel's depth at the center, mm; infinity: no vessel */
    ANSWER_FAR,  /* upper bound of this depth, mm; infinity: no vessel, or not decided */
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
 * scene    has a model of cylinders and balls, of triangles, or, for pattern answers, of the
 *          potential; Geometry.implied_ends is false.
 * out      release it with answer_release. Set on success only.
 * Errors   STATUS_USAGE, naming the field to change, if the answer is not defined for the scene:
 *          another model, effects such as outlines, a vessel that is not in front of the camera, or
 *          a vessel behind the plane from which a parallel light starts. STATUS_CANCELLED,
 *          STATUS_MEMORY.
 * Threads  the result does not depend on their number. */
MUST_CHECK Status answer_make(const Scene *scene, const AnswerParams *params, Answer *out,
                              Err *err);
void answer_release(Answer *answer);

/* Returns a digest of everything in a scene that determines its colors. Two answers with the same
 * digest and the same pattern bound the same colors. */
HashText answer_scene_hash(const Scene *scene, bool shadows);
/* Returns all numbers of a scene as JSON, for programs that read no scene language: lengths in mm,
 * linear colors. The caller releases it. Returns NULL if memory runs out. */
json_t *answer_scene_json(const Scene *scene, bool shadows);

#endif
