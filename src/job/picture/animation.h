/* Several pictures of one tree: moments of values that change with time, a turn, or growth. */
#ifndef CORCAST_JOB_PICTURE_ANIMATION_H
#define CORCAST_JOB_PICTURE_ANIMATION_H

#include "job/picture/picture.h"
#include "options/files.h"
#include "scene/scene.h"

typedef struct AnimationOptions {
    const char *frames; /* "all" or "A..B" */
    int turn, growth;   /* pictures; 0: none */
} AnimationOptions;

typedef enum AnimationKind {
    ANIMATION_NONE,
    ANIMATION_SERIES,
    ANIMATION_TURN,
    ANIMATION_GROWTH
} AnimationKind;

typedef struct Animation {
    AnimationKind kind;
    int first, last; /* the pictures that are made, counted from 1; last 0: to the end */
    int n;           /* that there are; 0: as many as the series has frames */
} Animation;

/* What is asked for. STATUS_USAGE when two kinds are, --frames is no range, or an animation's
 * `output` has no place for a number. */
MUST_CHECK Status animation_read(const AnimationOptions *options, const char *output,
                                 Animation *animation, Err *err);
/* Counts the frames of an appearance. STATUS_USAGE when values do not change with time or --frames
 * asks for more than there are. */
MUST_CHECK Status animation_count(Animation *animation, const Appearance *appearance, Err *err);

/* The file of a picture, in *path (owned): `pattern` with its %d, %04d and the like as the number,
 * or itself without an animation. */
MUST_CHECK Status animation_path(const Animation *animation, const char *pattern, int number,
                                 char **path, Err *err);

/* The camera of a turn, which shows all of the tree at any angle unless the options say where it is
 * or how much it shows. */
MUST_CHECK Status animation_frame_turn(const PictureOptions *options, const PictureSource *source,
                                       Scene *scene, Err *err);

/* What is animated; all borrowed. */
typedef struct AnimationSubject {
    const PictureOptions *options;
    const Common *common;
    const PictureSource *source;
    const Scene *whole;
} AnimationSubject;

/* What picture `number` shows. Of ANIMATION_GROWTH, geometry and colours are in *grown (owned;
 * scene_release), which begins zeroed; all else is borrowed from the whole scene. */
MUST_CHECK Status animation_scene(const Animation *animation, const AnimationSubject *subject,
                                  int number, Scene *shown, Scene *grown, Err *err);

#endif
