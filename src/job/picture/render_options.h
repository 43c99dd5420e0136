/* The options of `render`, which panels of a figure have, too. */
#ifndef CORCAST_JOB_PICTURE_RENDER_OPTIONS_H
#define CORCAST_JOB_PICTURE_RENDER_OPTIONS_H

#include "job/picture/animation.h"
#include "job/picture/annotation.h"
#include "job/picture/picture.h"
#include "job/picture/press.h"
#include "job/picture/shard.h"
#include "render/render.h"

typedef struct RenderOptions {
    const char *output, *planes, *json;
    unsigned hits;
    bool exact, has_method;
    RenderMethod method;
    RenderKernels kernels;
    double threshold, memory_mb, min_width_px, ink_mm;
    AnimationOptions animation;
    ShardOptions shard;
    Annotation annotation;
    PictureOptions picture;
    PressOptions press;
} RenderOptions;

extern const OptionTable render_table; /* sets a RenderOptions but what has tables of its own */
/* Of zeroed options, those of all tables. */
void render_set_defaults(void *options);

/* Settles what follows from --exact and --method where nothing is said of it. */
void render_settle(RenderOptions *options);

/* STATUS_USAGE when options fight each other, or the method does not know one. */
MUST_CHECK Status render_check(const RenderOptions *options, Err *err);

/* What the options ask of the renderer, but for planes and progress. `cells` is borrowed. */
RenderParams render_params_of(const RenderOptions *options, int threads, CellParams *cells);

/* The scene, with room for a legend, and what of it and its pictures follows from the animation.
 * STATUS_USAGE when options have no place beside effects of the look; as picture_scene_of,
 * animation_count and annotation_make_room. */
MUST_CHECK Status render_make_scene(RenderOptions *options, Parsed *parsed,
                                    const PictureSource *source, const FigureFonts *fonts,
                                    Scene *scene, PictureReport *made, Animation *animation,
                                    Err *err);

#endif
