/* An animation: several pictures of one tree, numbered from 1. A series shows values that change
 * with time, one picture per time step (frame) of the values. A turn rotates the camera around the
 * tree. Growth shows the tree as it grows from its root.
 *
 * A series and a turn keep the geometry, so that a renderer prepares it once. Growth, and a series
 * in which vessels beat, have a geometry for each picture [animation_changes_geometry].
 *
 * Example, without checks of errors; `scene` is the scene of the whole tree, and `input` has it:
 *
 *     animation_read(&options, output, &animation, err);
 *     animation_count(&animation, &scene.appearance, err);
 *     for (int number = animation.first; number <= animation.last; number++) {
 *         Scene shown, grown = {0};
 *         animation_scene(&animation, &input, number, &shown, &grown, err);
 *         animation_path(&animation, output, number, &path, err);
 *         ... draw `shown` to the file `path`, then scene_release(&grown)
 *     } */
#ifndef CORCAST_JOB_PICTURE_ANIMATION_H
#define CORCAST_JOB_PICTURE_ANIMATION_H

#include "job/picture/picture.h"
#include "options/files.h"
#include "scene/scene.h"

typedef struct AnimationOptions {
    /* value of --moments: the time steps (frames) "all", "A" or "A..B"; NULL: no series */
    const char *frames;
    int turn, growth; /* number of pictures of a turn and of growth; 0: no such animation */
} AnimationOptions;

typedef enum AnimationKind {
    ANIMATION_NONE,   /* a single picture */
    ANIMATION_SERIES, /* the colors change */
    ANIMATION_TURN,   /* the view changes */
    ANIMATION_GROWTH  /* the geometry changes */
} AnimationKind;

typedef struct Animation {
    AnimationKind kind;
    int first, last; /* first and last picture that are drawn, counted from 1; last 0: to the end of
                      * the series, which animation_count then sets */
    int n; /* number of pictures of the whole animation; 0: not known before animation_count */
} Animation;

/* Reads the options. Without an animation, *animation is a single picture. Errors: STATUS_USAGE if
 * the options select two kinds, if `frames` is malformed, or if the path `output` of an animation
 * does not contain exactly one %d, %4d or %04d. */
MUST_CHECK Status animation_read(const AnimationOptions *options, const char *output,
                                 Animation *animation, Err *err);
/* Sets `n` and `last` of a series from the number of time steps of the appearance. Leaves other
 * kinds unchanged. Errors: STATUS_USAGE if the values do not change with time, or if the series has
 * fewer time steps than `last`. */
MUST_CHECK Status animation_count(Animation *animation, const Appearance *appearance, Err *err);

/* Makes the file name of picture `number`: replaces %d, %4d or %04d in `pattern` by the number. The
 * name of a single picture is the pattern itself.
 *
 * path    set on success; release it with free.
 * Errors  STATUS_MEMORY. */
MUST_CHECK Status animation_path(const Animation *animation, const char *pattern, int number,
                                 char **path, Err *err);

/* Sets the camera of a turn to a distance at which the whole tree is in the picture at any angle.
 * Keeps the camera if the options specify its location or its height.
 *
 * scene   its geometry must be set; its view is changed.
 * Errors  those of stage_view. */
MUST_CHECK Status animation_fit_camera(const PictureOptions *options, const PictureSource *source,
                                       Scene *scene, Err *err);

/* The input of animation_scene. All pointers are borrowed. */
typedef struct AnimationInput {
    const PictureOptions *options;
    const Common *common;
    const PictureSource *source;
    const Scene *whole; /* the scene of the fully grown tree */
} AnimationInput;

/* Returns true if each picture has a geometry of its own: in growth, and in a series in which
 * vessels beat. */
static inline bool animation_changes_geometry(const Animation *animation,
                                              const PictureOptions *options)
{
    return animation->kind == ANIMATION_GROWTH ||
           (animation->kind == ANIMATION_SERIES && options->beat > 0);
}

/* Makes the scene of picture `number`.
 *
 * number  from 1 to animation->n.
 * shown   receives the scene. It borrows from the whole scene and from *grown.
 * grown   what this picture has of its own; zeroed before. If animation_changes_geometry is true,
 *         receives the geometry of this picture and, for growth, the colors; else it is unchanged.
 *         Release it with scene_release after the last use of *shown.
 * Errors  those of picture_geometry; STATUS_MEMORY. */
MUST_CHECK Status animation_scene(const Animation *animation, const AnimationInput *subject,
                                  int number, Scene *shown, Scene *grown, Err *err);

#endif
