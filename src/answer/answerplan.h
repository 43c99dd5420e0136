/* What all pixels of an answer share: faces, their search tree, lights, and frames of walls. */
#ifndef CORCAST_ANSWER_ANSWERPLAN_H
#define CORCAST_ANSWER_ANSWERPLAN_H

#include "answer/answer.h"
#include "answer/faces.h"

static inline double rgb_channel(Rgb color, int channel)
{
    return (double)(channel == 0 ? color.r : channel == 1 ? color.g : color.b);
}

/* The rays from a surface to a light. */
typedef struct LightRays {
    const Light *light;
    Form3 towards;     /* parallel light: unit */
    WallFrame *frames; /* parallel light: per face; owned */
    int points;        /* number of points that shadows are averaged over */
} LightRays;

typedef struct AnswerPlan {
    const Scene *scene; /* borrowed */
    AnswerParams params;
    Face *faces;
    size_t n;          /* number of faces, without the ground */
    bool has_ground;   /* faces[n] is the ground */
    BoxTree tree;      /* of the boxes of faces */
    WallFrame *frames; /* per face, for an orthographic camera; NULL in perspective */
    PixelRect *screen; /* per face: the pixels that its box covers */
    LightRays lights[VIEW_MAX_LIGHTS];
    /* Bounds of each channel of every color, and of what each light adds: `least` is 0 unless a
     * light has a negative color. */
    double least[3], most[3];
    double pad_mm; /* the boxes of the search tree are this much larger than the faces */
} AnswerPlan;

/* Prepares a scene. Release *plan with answerplan_release, even after an error. Errors:
 * STATUS_USAGE if the scene is outside the assumptions of answers; STATUS_MEMORY. */
MUST_CHECK Status answerplan_make(const Scene *scene, const AnswerParams *params, AnswerPlan *plan,
                                  Err *err);
void answerplan_release(AnswerPlan *plan);

/* Returns the beam of the rays through a rectangle of the picture around (x, y), pixels from the
 * left and upper edges. The point (ex, ey) of its forms is at (x, y) + ex along + ey across. */
Beam answerplan_beam(const AnswerPlan *plan, double x, double y, const double along[2],
                     const double across[2]);
/* Returns the beam of a single ray. */
static inline Beam answerplan_ray(const AnswerPlan *plan, double x, double y)
{
    static const double none[2] = {0, 0};
    return answerplan_beam(plan, x, y, none, none);
}

/* Faces that the rays of a beam may hit. */
typedef struct FaceList {
    uint32_t *faces; /* capacity: all faces */
    size_t n;
} FaceList;

/* Lists the faces that may block the path from a point within `reach` mm of `from`, along each
 * axis, in the direction `towards`; `far`: up to this multiple of it. */
void answerplan_blockers(const AnswerPlan *plan, Vec3 from, double reach, Vec3 towards, double far,
                         FaceList *list);

#endif
