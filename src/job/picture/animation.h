/* An animation: several pictures of one tree. The pictures show the frames of values that change
 * with time (a series), a rotation of the view (a turn), or the growth of the tree.
 *
 * Pictures are numbered from 1. A series and a turn keep the geometry, so that a renderer can reuse
 * what it has prepared. Each picture of growth has a geometry of its own.
 *
 * Use, after the scene of the whole tree is made:
 *
 *     TRY(animation_read(&options, output, &animation, err));
 *     TRY(animation_count(&animation, &scene.appearance, err));
 *     TRY(animation_scene(&animation, &subject, number, &shown, &grown, err)); */
#ifndef CORCAST_JOB_PICTURE_ANIMATION_H
#define CORCAST_JOB_PICTURE_ANIMATION_H

#include "job/picture/picture.h"
#include "options/files.h"
#include "scene/scene.h"

typedef struct AnimationOptions {
    const char *frames; /* "all" or "A..B"; NULL: no series */
    int turn, growth;   /* number of pictures of a turn, of growth; 0: no such animation */
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
                      * the series */
    int n;           /* pictures of the whole animation; 0: the number of frames, not known yet */
} Animation;

/* Reads the options. Errors: STATUS_USAGE if they select two kinds, if --moments is not a range, or
 * if the `output` of an animation does not contain exactly one %d, %4d or %04d. */
MUST_CHECK Status animation_read(const AnimationOptions *options, const char *output,
                                 Animation *animation, Err *err);
/* Counts the frames of a series and completes its animation; leaves other kinds as they are.
 * Errors: STATUS_USAGE if values do not change with time, or if --moments asks for a frame beyond
 * the last.
 */
MUST_CHECK Status animation_count(Animation *animation, const Appearance *appearance, Err *err);

/* Makes the file name of a picture: replaces %d, %4d or %04d in `pattern` by the picture's number.
 * The name of a single picture is the pattern itself.
 *
 * path    set on success; release it with free.
 * Errors  STATUS_MEMORY. */
MUST_CHECK Status animation_path(const Animation *animation, const char *pattern, int number,
                                 char **path, Err *err);

/* Sets the camera of a rotation, which shows all of the tree at any angle. Keeps the camera if the
 * options specify its location or its height. Errors: as stage_view. */
MUST_CHECK Status animation_fit_camera(const PictureOptions *options, const PictureSource *source,
                                       Scene *scene, Err *err);

/* The tree and the options of an animation. All pointers are borrowed. */
typedef struct AnimationInput {
    const PictureOptions *options;
    const Common *common;
    const PictureSource *source;
    const Scene *whole; /* the scene of the fully grown tree */
} AnimationInput;

/* Returns true if the pictures have geometries of their own: growth, and the frames of a series in
 * which vessels beat. */
static inline bool animation_changes_geometry(const Animation *animation, const PictureOptions *options)
{
    return animation->kind == ANIMATION_GROWTH ||
           (animation->kind == ANIMATION_SERIES && options->beat > 0);
}

/* Makes the scene of picture `number`.
 *
 * number  from 1 to animation->n.
 * shown   receives the scene; it borrows from the whole scene and from *grown.
 * grown   if animation_changes_geometry, receives the geometry and for growth the colors of this picture;
 *         zeroed before; release it with scene_release. Otherwise it stays unchanged.
 * Errors  as picture_geometry; STATUS_MEMORY. */
MUST_CHECK Status animation_scene(const Animation *animation, const AnimationInput *subject,
                                  int number, Scene *shown, Scene *grown, Err *err);

#endif
