/* Several pictures of one tree: the frames of values that change with time, a rotation, or growth.
 */
#ifndef CORCAST_JOB_PICTURE_ANIMATION_H
#define CORCAST_JOB_PICTURE_ANIMATION_H

#include "job/picture/picture.h"
#include "options/files.h"
#include "scene/scene.h"

typedef struct AnimationOptions {
    const char *frames; /* "all" or "A..B"; NULL: no series */
    int turn, growth;   /* number of pictures; 0: none */
} AnimationOptions;

typedef enum AnimationKind {
    ANIMATION_NONE,   /* a single picture */
    ANIMATION_SERIES, /* the colors change */
    ANIMATION_TURN,   /* the view changes */
    ANIMATION_GROWTH  /* the geometry changes */
} AnimationKind;

typedef struct Animation {
    AnimationKind kind;
    int first, last; /* pictures that are drawn, counted from 1; last 0: to the end of the series */
    int n;           /* pictures of the whole animation; 0: the number of frames, not known yet */
} Animation;

/* Reads the options. Errors: STATUS_USAGE if they ask for two kinds, if --frames is not a range, or
 * if the `output` of an animation has no place for a number. */
MUST_CHECK Status animation_read(const AnimationOptions *options, const char *output,
                                 Animation *animation, Err *err);
/* Counts the frames of a series and completes its animation; leaves other kinds as they are.
 * Errors: STATUS_USAGE if values do not change with time, or if --frames asks for a frame beyond
 * the last.
 */
MUST_CHECK Status animation_count(Animation *animation, const Appearance *appearance, Err *err);

/* Makes the file name of a picture, in *path (owned). The place %d, %4d or %04d of `pattern`
 * becomes the number. The name of a single picture is the pattern itself. Errors: STATUS_MEMORY. */
MUST_CHECK Status animation_path(const Animation *animation, const char *pattern, int number,
                                 char **path, Err *err);

/* Sets the camera of a rotation, which shows all of the tree at any angle. Keeps the camera if the
 * options specify its location or its height. Errors: as stage_view. */
MUST_CHECK Status animation_frame_turn(const PictureOptions *options, const PictureSource *source,
                                       Scene *scene, Err *err);

/* What is animated; all borrowed. */
typedef struct AnimationSubject {
    const PictureOptions *options;
    const Common *common;
    const PictureSource *source;
    const Scene *whole; /* of a grown tree */
} AnimationSubject;

/* Makes the scene of picture `number`.
 *
 * shown   borrows from the whole scene and from *grown.
 * grown   of growth: geometry and colors of this picture; zeroed before; release it with
 *         scene_release. Other kinds leave it as it is.
 * Errors  as picture_geometry; STATUS_MEMORY. */
MUST_CHECK Status animation_scene(const Animation *animation, const AnimationSubject *subject,
                                  int number, Scene *shown, Scene *grown, Err *err);

#endif
