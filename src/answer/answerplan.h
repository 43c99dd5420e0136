/* The plan of an answer: the data that all pixels share, namely the faces of the scene [faces.h],
 * their bounding volume hierarchy, the lights, and the frames of walls. An answer is, per pixel, an
 * interval that contains the true color [answer.h]. answerplan_make fills the plan, which does not
 * change afterwards; answerplan_beam and answerplan_blockers read it. Private to the module answer.
 */
#ifndef CORCAST_ANSWER_ANSWERPLAN_H
#define CORCAST_ANSWER_ANSWERPLAN_H

#include "answer/answer.h"
#include "answer/faces.h"

/* Returns channel 0 (red), 1 (green) or 2 (blue). */
static inline double rgb_channel(Rgb color, int channel)
{
    return (double)(channel == 0 ? color.r : channel == 1 ? color.g : color.b);
}

/* One light of the scene, and the data that all shadow rays to it share. */
typedef struct LightRays {
    const Light *light;
    Form3 towards;     /* parallel light: unit vector towards the light; else 0 */
    WallFrame *frames; /* parallel light, per face: frame for the direction `towards`; owned;
                        * NULL for other lights */
    int points; /* number of points on the light over which shadows are averaged; 0: nothing blocks
                 * this light */
} LightRays;

/* Length, mm, from the start of a shadow ray, within which a blocker may be ignored. Renderers
 * ignore blockers within 1e-3 mm; this constant is 1 % larger, to cover their rounding. A ray that
 * starts inwards, and leaves its own solid again within this length, therefore may be blocked or
 * not. The path inside a cylinder or a ball is about 2 radius |cosine| long, so this happens only
 * at grazing angles. */
#define SHADOW_FROM_MM 1.01e-3

typedef struct AnswerPlan {
    const Scene *scene; /* borrowed */
    AnswerParams params;
    Face *faces;       /* per face; owned, like all arrays below */
    size_t n;          /* number of faces, without the ground */
    bool has_ground;   /* faces[n] is the ground */
    BoxTree tree;      /* hierarchy of the faces' bounding boxes, without the ground */
    WallFrame *frames; /* per face, for an orthographic camera; NULL in perspective */
    Beam parallel;     /* orthographic camera: the part that all its beams share, namely the
                        * direction and a pointer to `frames` */
    PixelRect *screen; /* per face: the pixels that its bounding box covers */
    LightRays lights[VIEW_MAX_LIGHTS];
    /* Per channel: lower and upper bound of all colors of the scene, and of the contribution of any
     * single light. `least` is 0 unless a light has a negative color. */
    double least[3], most[3];
    bool is_field;         /* the faces are segments of an isosurface or of a blob */
    bool is_blob;          /* the faces are segments of a blob */
    double level;          /* field: the value on the surface */
    double shadow_from_mm; /* field: SHADOW_FROM_MM, or ten times that for a blob, whose limit is
                            * BLOB_NEAREST_MM in renderers */
    /* Isosurface: upper bounds of the sum of all terms that a ray may leave out, and of the
     * magnitude of that sum's gradient, 1/mm. */
    double dropped, dropped_slope;
    double pad_mm; /* length by which the boxes in `tree` are enlarged on each side */
} AnswerPlan;

/* Prepares a scene. Release *plan with answerplan_release, even after an error. Errors:
 * STATUS_USAGE if the answer is not defined for the scene [answer_make]; STATUS_MEMORY. */
MUST_CHECK Status answerplan_make(const Scene *scene, const AnswerParams *params, AnswerPlan *plan,
                                  Err *err);
void answerplan_release(AnswerPlan *plan);

/* Returns the beam of the camera rays through a rectangle of the picture. Positions are in pixels
 * from the left and the upper edge of the picture.
 *
 * x, y           the rectangle's center.
 * along, across  half sides of the rectangle, as vectors. The beam's forms are functions of ex and
 *                ey in [-1, 1]: (ex, ey) is the ray through (x, y) + ex along + ey across. */
Beam answerplan_beam(const AnswerPlan *plan, double x, double y, const double along[2],
                     const double across[2]);
/* Returns the beam of the single camera ray through (x, y). */
static inline Beam answerplan_ray(const AnswerPlan *plan, double x, double y)
{
    static const double none[2] = {0, 0};
    return answerplan_beam(plan, x, y, none, none);
}

/* A list of faces. */
typedef struct FaceList {
    uint32_t *faces; /* indices in AnswerPlan.faces; the capacity holds all faces */
    size_t n;
} FaceList;

/* Lists the faces, without the ground, that may block a path. The path begins at any point whose
 * coordinates differ from those of `from` by at most `reach` mm. It ends at its beginning plus
 * `far` times `towards`; `far` may be infinite. */
void answerplan_blockers(const AnswerPlan *plan, Vec3 from, double reach, Vec3 towards, double far,
                         FaceList *list);

#endif
