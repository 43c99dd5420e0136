/* Defines the options of `render` that are not about the scene and their defaults, and checks
 * options that exclude each other. Each check is made before the scene is, so that errors come at
 * once. */
#include "job/picture/render_options.h"

#include "job/picture/frames.h"
#include "job/picture/line_drawing.h"
#include "options/output.h"
#include <string.h>

enum { HITS_EXACT, HITS_POVRAY };
static const char *const hits_names[] = {"exact", "povray", NULL};
static const char *const methods[] = {[RENDER_TRACE] = "trace",
                                      [RENDER_RASTER] = "raster",
                                      [RENDER_ZBUFFER] = "zbuffer",
                                      [RENDER_FASTEST] = "fastest",
                                      NULL};

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, RenderOptions, output),
     .argument = "P",
     .help = "file to write: an image (.png, .ppm, .tif, .jpg, .exr or .pfm), or a page with the "
             "image (.pdf, .eps or .svg)"},
    {.name = "planes",
     SETS(TEXT, RenderOptions, planes),
     .argument = "LIST",
     .when = WHEN(SURFACES) | WHEN(WHOLE),
     .help = "kinds of data per pixel to write, separated by commas, such as depth,id: color, "
             "depth (distance from the camera, mm), normal (direction of the surface), id (number "
             "of the visible segment). Each plane is a file beside the image, or a layer of an "
             ".exr image"},
    {.name = "exact",
     SETS(FLAG, RenderOptions, exact),
     .group = GROUP_RUN,
     .when = WHEN(SURFACES),
     .help = "draw exactly the image that `corcast verify` compares with POV-Ray: with POV-Ray's "
             "arithmetic, ray by ray, and one ray per pixel unless --antialias is set"},
    {.name = "method",
     SETS(CHOICE, RenderOptions, method),
     GIVEN(RenderOptions, has_method),
     .choices = methods,
     .group = GROUP_RUN,
     .when = WHEN(SURFACES),
     .help = "algorithm, for --model cylinders, joined, rounded and blob: trace (ray by ray, as "
             "POV-Ray does), raster (tile by tile), zbuffer (vessel by vessel into a depth "
             "buffer, as Neumann 1996 does; not for blob), fastest (raster where possible, else "
             "trace)"},
    {.name = "min-width",
     SETS(NUMBER, RenderOptions, min_width_px),
     FROM_TO(0, 64),
     .argument = "PX",
     .group = GROUP_VESSELS,
     .when = WHEN(SURFACES),
     .help = "minimum drawn width of vessels, pixels; 0 draws true widths"},
    {.name = "ink",
     SETS(NUMBER, RenderOptions, ink_mm),
     .range = &ink_range,
     .group = GROUP_VESSELS,
     .unit = "mm",
     .otherwise = "shaded vessels",
     .help = "draw only the visible outlines of the vessels, as lines of this width on paper, "
             "instead of shaded vessels; .svg, .pdf or .eps only"},
    {.name = "hits",
     SETS(CHOICE, RenderOptions, hits),
     .choices = hits_names,
     .group = GROUP_POVRAY,
     .when = WHEN(POTENTIAL),
     .help = "for --model isosurface only: point where a ray hits the surface: exact (on the "
             "surface), povray (where POV-Ray's root finder stops, slightly off the surface)"},
    {.name = "antialias-threshold",
     SETS(NUMBER, RenderOptions, threshold),
     FROM_TO(0, 1),
     .group = GROUP_LIGHT,
     .argument = "T",
     .when = WHEN(OPAQUE),
     .help = "minimum color difference between neighboring pixels at which they are antialiased; "
             "0 antialiases all pixels, as POV-Ray does"},
    {.name = "kernels",
     SETS(CHOICE, RenderOptions, kernels),
     .choices = render_kernel_names,
     .group = GROUP_RUN,
     .when = WHEN(SURFACES),
     .help = "processor instructions to use, for tests only; all values give the same image. "
             "Values"},
    {.name = "memory",
     SETS(NUMBER, RenderOptions, memory_mb),
     FROM_TO(1e-3, 1e9),
     .group = GROUP_RUN,
     .aside = true,
     .unit = "MB",
     .when = WHEN(SURFACES),
     .help = "maximum memory for the image; a larger image is drawn and written band by band"},
    {.name = "json",
     SETS(OUTPUT, RenderOptions, json),
     .when = WHEN(SURFACES) | WHEN(WHOLE),
     .help = "also write a summary of the run as JSON to FILE"},
    {.name = "moments",
     .former = "frames",
     SETS(TEXT, RenderOptions, animation.frames),
     .group = GROUP_ANIMATION,
     .argument = "all|A..B",
     .when = WHEN(SURFACES),
     .help = "with a --color-by that changes with time: draw an animation, one image per time "
             "step: all steps, or steps A to B, both included; the first is 1. The name of -o "
             "must contain the image number, as in f%04d.png"},
    {BEAT_OPTION(RenderOptions, picture.beat), .when = WHEN(SURFACES)},
    {.name = "turntable",
     SETS(WHOLE, RenderOptions, animation.turn),
     .group = GROUP_ANIMATION,
     FROM_TO(1, 100000),
     .otherwise = "one image",
     .when = WHEN(SURFACES),
     .help =
         "draw an animation of one full turn around the vertical axis, with this number of images"},
    {.name = "growth",
     SETS(WHOLE, RenderOptions, animation.growth),
     .group = GROUP_ANIMATION,
     FROM_TO(1, 100000),
     .otherwise = "one image",
     .when = WHEN(SURFACES),
     .help = "draw an animation of the tree as it grows from its root, with this number of images"},
};

/* Returns the conditions about animations and tiles that do not hold. */
static ConditionSet unmet_of_parts(const RenderOptions *options)
{
    const AnimationOptions *animation = &options->animation;
    const ShardOptions *shard = &options->shard;
    const bool animated = animation->frames || animation->turn > 0 || animation->growth > 0;
    const ConditionSet whole = WHEN(WHOLE) | WHEN(WHOLE_SRGB);
    return UNLESS(!animated, STILL) | UNLESS(animated, ANIMATED) |
           UNLESS(animated || shard->tiles > 0, HAS_PARTS) | (shard_needs_note(shard) ? whole : 0);
}

static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    const RenderOptions *options = set;
    const PictureOptions *picture = &options->picture;
    return unmet_of_parts(options) | UNLESS(options->ink_mm == 0, SURFACES) |
           UNLESS(!picture_is_transparent(picture), OPAQUE) |
           picture_unmet_dpi(&picture->size, options_output(parsed));
}

const OptionTable render_table = {OPTION_ROWS(own), .unmet = unmet};

void render_set_defaults(void *options)
{
    RenderOptions *own_options = options;
    picture_set_defaults(&own_options->picture);
    annotation_set_defaults(&own_options->annotation);
    press_set_defaults(&own_options->press);
    own_options->picture.antialias = PICTURE_ANTIALIAS;
    own_options->method = RENDER_FASTEST;
    own_options->kernels = KERNELS_FASTEST;
    own_options->memory_mb = 128;
}

void render_settle(RenderOptions *options)
{
    PictureOptions *picture = &options->picture;
    if (options->exact && !options->has_method)
        options->method = RENDER_TRACE;
    picture->omits_effects = options->exact;
    const bool bare = options->exact || options->method == RENDER_ZBUFFER;
    if (!picture->has_antialias && bare)
        picture->antialias = 1;
    if (!picture->has_occlusion && bare)
        picture->occlusion = 0;
    if (!picture->has_shadows && options->method == RENDER_ZBUFFER)
        picture->stage.shadows = false;
    if (!picture->has_projection && options->annotation.has_scale_bar)
        picture->projection = PROJECTION_ORTHOGRAPHIC;
}

/* Returns true if vessels thinner than a pixel are drawn by their coverage. A method that an option
 * selects draws its own picture of them. */
static bool covers_thin(const RenderOptions *options)
{
    return options->method == RENDER_FASTEST && options->hits == HITS_EXACT;
}

/* Refuses a method for models that it cannot draw: only the default method draws isosurfaces and
 * meshes. */
static Status check_method(const RenderOptions *options, Err *err)
{
    SceneModel model = (SceneModel)options->picture.model;
    unsigned elements = MODEL_PRIMITIVES;
    if (options->method != RENDER_ZBUFFER)
        elements |= MODEL_BLOB;
    if (model_is_of(model, elements))
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "--method %s needs %s, not %s", methods[options->method],
                   models_of(elements).text, models[model].name);
}

/* Refuses annotations over a transparent picture, whose halos and ink depend on the background. */
static Status check_transparent(const RenderOptions *options, Err *err)
{
    static const char *const able[] = {"png", "tif", "tiff", "exr", NULL};
    if (!picture_is_transparent(&options->picture))
        return STATUS_OK;
    if (!is_one_of(file_extension(options->output), able))
        return err_set(err, STATUS_USAGE,
                       "-o: '%s' cannot be transparent; --background none needs .png, .tif or .exr",
                       options->output);
    if (annotation_is_wanted(&options->annotation))
        return err_set(err, STATUS_USAGE,
                       "--background none: a legend, a scale bar or a letter needs a background");
    return STATUS_OK;
}

Status render_check(const RenderOptions *options, Err *err)
{
    const PictureOptions *picture = &options->picture;
    TRY(annotation_check_file(&options->annotation, options->output, err));
    TRY(press_check(&options->press, options->output, err));
    if (options->ink_mm > 0)
        TRY(line_drawing_check(picture, options->output, err));
    if (options->min_width_px > 0 && !covers_thin(options))
        return err_set(err, STATUS_USAGE,
                       "--min-width needs --method fastest, without --exact and --hits povray");
    if (options->min_width_px > 0 && model_is_of((SceneModel)picture->model, MODEL_TRIANGLES))
        return err_set(err, STATUS_USAGE, "--min-width has no effect on --model %s",
                       models[picture->model].name);
    TRY(annotation_check(&options->annotation, picture, err));
    TRY(check_transparent(options, err));
    if (options->threshold > 0 && picture->antialias == 1)
        return err_set(err, STATUS_USAGE,
                       "--antialias-threshold needs --antialias N, with N from 2 to 9");
    if (options->exact && options->method != RENDER_TRACE)
        return err_set(err, STATUS_USAGE, "--exact uses --method trace; do not give --method %s",
                       methods[options->method]);
    if (options->has_method && options->method != RENDER_TRACE)
        TRY(check_method(options, err));
    if (options->method == RENDER_ZBUFFER &&
        (picture->stage.shadows || picture->antialias > 1 || picture->occlusion > 0))
        return err_set(
            err, STATUS_USAGE,
            "--method zbuffer draws no shadows, no antialiased pictures and no ambient occlusion");
    return STATUS_OK;
}

RenderParams render_params_of(const RenderOptions *options, int threads, CellParams *cells)
{
    const PictureOptions *picture = &options->picture;
    *cells = picture_cells(picture);
    return (RenderParams){.threads = threads,
                          .antialias = picture->antialias,
                          .antialias_threshold = options->threshold,
                          .shadows = picture->stage.shadows,
                          .occlusion = picture->occlusion,
                          .method = options->method,
                          .povray_cells = options->hits == HITS_POVRAY ? cells : NULL,
                          .cover_thin = covers_thin(options),
                          .min_width_px = options->min_width_px,
                          .kernels = options->kernels};
}

/* Restricts the animation to the picture that --only selects; 0 selects all. */
static Status pick_only(int only, Animation *animation, Err *err)
{
    if (only == 0)
        return STATUS_OK;
    if (only < animation->first || only > animation->last)
        return err_set(err, STATUS_USAGE, "--only: %d is not a picture from %d to %d", only,
                       animation->first, animation->last);
    animation->first = animation->last = only;
    return STATUS_OK;
}

/* Refuses options that have no effect together with effects of the look. */
static Status check_effects(const RenderOptions *options, const View *view, Err *err)
{
    if (!effects_present(&view->effects))
        return STATUS_OK;
    if (options->threshold > 0)
        return err_set(err, STATUS_USAGE,
                       "--antialias-threshold: --look %s needs all samples of every pixel",
                       options->picture.look);
    if (options->min_width_px > 0 && effects_need_ids(&view->effects))
        return err_set(err, STATUS_USAGE,
                       "--min-width has no effect with --look %s, which draws vessel edges at "
                       "their true width",
                       options->picture.look);
    return STATUS_OK;
}

Status render_make_scene(RenderOptions *options, Parsed *parsed, const PictureSource *source,
                         const FigureFonts *fonts, Scene *scene, PictureReport *made,
                         Animation *animation, Err *err)
{
    PictureOptions *picture = &options->picture;
    picture->by_tiles = options->ink_mm == 0 &&
                        (options->method == RENDER_FASTEST || options->method == RENDER_RASTER);
    TRY(picture_scene_of(picture, source, parsed, scene, NULL, made, err));
    TRY(animation_count(animation, &scene->appearance, err));
    TRY(pick_only(options->shard.only, animation, err));
    if (options->annotation.legend) {
        TRY(annotation_reserve_space(&options->annotation, fonts, &scene->appearance,
                                     &picture->size, picture->stage.room, err));
        TRY(picture_view(picture, source, &scene->geometry, &scene->view, err));
    }
    if (animation->kind == ANIMATION_TURN)
        TRY(animation_fit_camera(picture, source, scene, err));
    TRY(check_effects(options, &scene->view, err));
    return options->exact
               ? picture_report_effects(picture, "--exact omits them", parsed->common.talk, err)
               : STATUS_OK;
}
