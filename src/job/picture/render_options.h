/* The options of the operation `render`. The panels of a figure have the same options.
 *
 * A caller zeroes a RenderOptions, calls render_set_defaults, and lets the option tables set it.
 * Then render_settle derives values that follow from other options, render_check refuses
 * contradictions, and render_make_scene makes the scene. rendering_open [render.h] does these three
 * steps. */
#ifndef CORCAST_JOB_PICTURE_RENDER_OPTIONS_H
#define CORCAST_JOB_PICTURE_RENDER_OPTIONS_H

#include "job/picture/animation.h"
#include "job/picture/annotation.h"
#include "job/picture/picture.h"
#include "job/picture/press.h"
#include "job/picture/shard.h"
#include "render/render.h"

/* The options. Strings are borrowed from the parsed command line; NULL: not specified. */
typedef struct RenderOptions {
    const char *output; /* the picture's file; NULL: the picture stays in memory */
    const char *planes; /* planes that are written, separated by commas: "depth,id" */
    const char *json;   /* file of the report */
    unsigned hits;   /* point at which a ray hits an isosurface: 0: on the exact surface; 1: where
                      * POV-Ray's root finder puts it */
    bool exact;      /* draws the picture that `verify` compares with POV-Ray's */
    bool has_method; /* `method` is specified by an option */
    RenderMethod method;
    RenderKernels kernels;
    double threshold;    /* only pixels that differ from a neighbour by more than this, in linear
                          * color, are antialiased; 0: all pixels */
    double memory_mb;    /* maximum memory of one band of rows, MB */
    double min_width_px; /* minimum drawn width of vessels; 0: true widths */
    double ink_mm;       /* line width of a line drawing; 0: a shaded picture */
    AnimationOptions animation;
    ShardOptions shard;
    Annotation annotation;
    PictureOptions picture;
    PressOptions press;
} RenderOptions;

/* Sets the members of a RenderOptions, except those of its member structs, which have option tables
 * of their own. */
extern const OptionTable render_table;
/* Sets all defaults of a zeroed RenderOptions. */
void render_set_defaults(void *options);

/* Derives options from --exact, --method and --scale-bar. An option that the user specified keeps
 * its value. A derived value replaces the value from the look file. */
void render_settle(RenderOptions *options);

/* Checks the options. Errors: STATUS_USAGE if two options exclude each other, or if the method does
 * not support an option. */
MUST_CHECK Status render_check(const RenderOptions *options, Err *err);

/* Returns the parameters of the renderer. The caller sets planes and progress.
 *
 * threads  number of threads; 0: all processors.
 * cells    receives the parameters by which an isosurface is divided into cells; the result
 *          borrows the pointer. */
RenderParams render_params_of(const RenderOptions *options, int threads, CellParams *cells);

/* Makes the scene, reserves space for a legend, and determines the pictures of an animation.
 *
 * options    receives the reserved space.
 * fonts      measure the text of a legend; may be NULL if there is no legend.
 * scene      set on success only; release it with scene_release.
 * report     receives the facts about the scene, for picture_report; owns nothing.
 * animation  receives the pictures to draw; owns nothing.
 * Errors     STATUS_USAGE if an option has no effect with this look; the errors of
 *            picture_scene_of, animation_count and annotation_reserve_space. */
MUST_CHECK Status render_make_scene(RenderOptions *options, Parsed *parsed,
                                    const PictureSource *source, const FigureFonts *fonts,
                                    Scene *scene, PictureReport *report, Animation *animation,
                                    Err *err);

#endif
