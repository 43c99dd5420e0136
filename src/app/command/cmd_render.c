/* Draws band by band, each as many rows as --memory holds, and writes each before the next, so that
 * a picture of any size needs the memory of one band. */
#include "app/command/render_panel.h"
#include "app/commands.h"
#include "app/pictures/animation.h"
#include "app/pictures/frames.h"
#include "app/pictures/line_drawing.h"
#include "app/pictures/picture.h"
#include "app/pictures/press.h"
#include "app/pictures/shard.h"

#include "app/run/output.h"
#include "app/run/progress.h"
#include "render/render.h"
#include <stdlib.h>
#include <string.h>

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
     .help = "the picture: .png, .ppm, .tif, .jpg, .exr or .pfm, or a page that holds it: .pdf, "
             ".svg"},
    {.name = "planes",
     SETS(TEXT, RenderOptions, planes),
     .argument = "LIST",
     .help = "planes beside it, or in an .exr: color,depth,normal,id"},
    {.name = "exact",
     SETS(FLAG, RenderOptions, exact),
     .group = GROUP_RUN,
     .help = "the picture that verify draws: POV-Ray's arithmetic, ray by ray, and one ray a pixel "
             "unless --antialias says more"},
    {.name = "method",
     SETS(CHOICE, RenderOptions, method),
     GIVEN(RenderOptions, has_method),
     .choices = methods,
     .group = GROUP_RUN,
     .help = "cylinders, joined, rounded: as POV-Ray does, by tiles, as the paper does, or tiles "
             "where they can"},
    {.name = "min-width",
     SETS(NUMBER, RenderOptions, min_width_px),
     FROM_TO(0, 64),
     .argument = "PX",
     .group = GROUP_VESSELS,
     .help = "vessels are drawn at least so many pixels wide; 0: as wide as they are"},
    {.name = "ink",
     SETS(NUMBER, RenderOptions, ink_mm),
     .range = &ink_range,
     .group = GROUP_VESSELS,
     .unit = "mm",
     .otherwise = "",
     .help = "a drawing in lines of this width instead, hidden lines left out: .svg or .pdf"},
    {.name = "hits",
     SETS(CHOICE, RenderOptions, hits),
     .choices = hits_names,
     .group = GROUP_POVRAY,
     .help = "isosurface: where it is, or where POV-Ray's root finder sees it"},
    {.name = "antialias-threshold",
     SETS(NUMBER, RenderOptions, threshold),
     FROM_TO(0, 1),
     .group = GROUP_LIGHT,
     .argument = "T",
     .help = "antialias only pixels that differ by T from a neighbour; 0: all, as POV-Ray"},
    {.name = "kernels",
     SETS(CHOICE, RenderOptions, kernels),
     .choices = render_kernel_names,
     .group = GROUP_RUN,
     .help = "instructions that tiles are drawn with, for tests"},
    {.name = "memory",
     SETS(NUMBER, RenderOptions, memory_mb),
     FROM_TO(1e-3, 1e9),
     .group = GROUP_RUN,
     .aside = true,
     .unit = "MB",
     .help = "of a band; larger pictures are drawn and written band by band"},
    {.name = "json", SETS(OUTPUT, RenderOptions, json), .help = "what was done, as JSON"},
    {.name = "frames",
     SETS(TEXT, RenderOptions, animation.frames),
     .group = GROUP_ANIMATION,
     .argument = "all|A..B",
     .help = "a picture for each frame of values that change with time"},
    {.name = "turntable",
     SETS(WHOLE, RenderOptions, animation.turn),
     .group = GROUP_ANIMATION,
     FROM_TO(1, 100000),
     .otherwise = "",
     .help = "so many pictures, once about the upright"},
    {.name = "growth",
     SETS(WHOLE, RenderOptions, animation.growth),
     .group = GROUP_ANIMATION,
     FROM_TO(1, 100000),
     .otherwise = "",
     .help = "so many pictures of the tree as it grows from its root"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static void set_defaults(void *options)
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

/* --planes: which planes are written beside the picture. */
static Status read_planes(const char *list, RenderParams *params, Err *err)
{
    static const char *const names[] = {"color", "depth", "normal", "id"};
    bool *const wanted[] = {&params->want_color, &params->want_depth, &params->want_normal,
                            &params->want_id};
    while (list && *list) {
        size_t length = strcspn(list, ",");
        size_t i = 0;
        while (i < 4 && (strlen(names[i]) != length || strncmp(names[i], list, length) != 0))
            i++;
        if (i == 4)
            return err_set(err, STATUS_USAGE,
                           "--planes: '%.*s' is not one of color, depth, normal, id", (int)length,
                           list);
        *wanted[i] = true;
        list += length + (list[length] == ',');
    }
    return STATUS_OK;
}

static Status write_report(const char *path, const Scene *scene, const RenderStats *stats,
                           const StageReport *staged, int threads, Err *err)
{
    json_t *report = json_pack(
        "{s:s, s:s, s:s, s:i, s:i, s:f, s:f, s:f, s:I, s:i}", "generator", GENERATOR, "model",
        models[scene->geometry.model].name, "engine", stats->engine, "width",
        scene->view.camera.width, "height", scene->view.camera.height, "prepare_seconds",
        stats->prepare_s, "trace_seconds", stats->trace_s, "cpu_seconds", stats->cpu_s, "rays",
        (json_int_t)stats->rays, "threads", threads ? threads : threads_available());
    if (model_has(scene->geometry.model, MODEL_JOINTS)) {
        const JsonMember of_joints[] = {
            {"joints", json_integer((json_int_t)staged->joints)},
            {"places_short", json_integer((json_int_t)staged->places_short)},
            {"places_sharp", json_integer((json_int_t)staged->places_sharp)},
            {"places_crowded", json_integer((json_int_t)staged->places_crowded)},
        };
        report = json_with_members(report, of_joints, sizeof of_joints / sizeof *of_joints);
    }
    if (scene->appearance.said)
        report = json_with(report, "color", coloring_json(&scene->appearance));
    return json_write(report, path, err);
}

/* Rows of a band so that it takes about `memory_mb`: floats, codes and masks, and with occlusion
 * what pixels share, of which half see something. */
static int band_rows(const FramesForm *form, int occlusion, double memory_mb)
{
    int bytes = 12 + form->bits / 8 * 3 + 1 + 4 * form->depth + 12 * form->normal + 7 * form->id;
    if (image_is_floats(form->path))
        bytes += 12 + 4 * form->depth + 12 * form->normal + 4 * form->id;
    bytes += occlusion > 0 ? 42 + occlusion : 0;
    double rows = memory_mb * 1e6 / ((double)bytes * form->width);
    if (rows >= form->height)
        return form->height;
    return rows < 2 * RENDER_BAND_STEP ? RENDER_BAND_STEP
                                       : (int)rows / RENDER_BAND_STEP * RENDER_BAND_STEP;
}

/* What is drawn, and how. */
typedef struct Film {
    AnimationSubject subject;
    const Animation *animation;
    const RenderParams *params;
    const Parsed *parsed;
    bool resume, part; /* what is there is kept; a note says what the picture is */
    Shard shard;       /* of each picture; its hash is still to be made */
    int step;          /* rows of a band */
} Film;

/* Draws the shard's rows band after band and writes each before the next. */
static Status draw_bands(Renderer *renderer, const Scene *scene, FramesWriter *writer,
                         const Film *film, Err *err)
{
    const int end = film->shard.first + film->shard.rows;
    for (int first = film->shard.first; first < end; first += film->step) {
        Frame band;
        int rows = film->step < end - first ? film->step : end - first;
        TRY(renderer_rows(renderer, &scene->view, &scene->appearance, first, rows, &band, err));
        Status status = frames_rows(writer, &band, err);
        frame_release(&band);
        TRY(status);
    }
    return STATUS_OK;
}

/* One picture, by a renderer that is there or its own. */
static Status draw(Renderer *renderer, const Scene *scene, const FramesForm *form, const Film *film,
                   Err *err)
{
    FramesWriter *writer = NULL;
    TRY(frames_open(&writer, form, err));
    Status status = draw_bands(renderer, scene, writer, film, err);
    if (status == STATUS_OK)
        return frames_commit(writer, err);
    frames_discard(writer);
    return status;
}

static void add_stats(RenderStats *all, const RenderStats *one)
{
    all->prepare_s += one->prepare_s;
    all->trace_s += one->trace_s;
    all->cpu_s += one->cpu_s;
    all->rays += one->rays;
    all->engine = one->engine;
}

/* The note of picture `number`, which the form then has, and whether the file has it already. */
static Status find_shard(const Film *film, FramesForm *form, int number, Text *note, bool *there,
                         Err *err)
{
    Shard shard = film->shard;
    const Tree *tree = &film->subject.source->of.tree;
    TRY(shard_hash(&shard, film->parsed, form->provenance, tree, number, err));
    shard_put(&shard, note);
    TRY(text_check(note, err));
    form->shard = text_chars(note);
    if (film->resume)
        TRY(shard_is_there(form->path, &shard, there, err));
    if (*there && !film->subject.common->quiet)
        fprintf(stderr, "%s is there\n", form->path);
    return STATUS_OK;
}

/* The tree as it grows has a geometry, and with it a renderer, for each picture; else the first
 * picture that is drawn makes *prepared for all. */
static Status draw_frame(const Film *film, int number, const FramesForm *form, Renderer **prepared,
                         RenderStats *stats, Err *err)
{
    Scene shown, grown = {0};
    Renderer *young = NULL;
    Renderer **renderer = film->animation->kind == ANIMATION_GROWTH ? &young : prepared;
    FramesForm named = *form;
    Text note = TEXT_INIT;
    bool there = false;
    char *path = NULL;
    Status status;
    TRY_GOTO(animation_path(film->animation, form->path, number, &path, err));
    named.path = path;
    if (film->part)
        TRY_GOTO(find_shard(film, &named, number, &note, &there, err));
    if (there)
        goto done;
    TRY_GOTO(animation_scene(film->animation, &film->subject, number, &shown, &grown, err));
    if (!*renderer)
        TRY_GOTO(renderer_new(&shown.geometry, film->params, renderer, err));
    TRY_GOTO(draw(*renderer, &shown, &named, film, err));
    if (young) {
        const RenderStats one = renderer_stats(young);
        add_stats(stats, &one);
    }
done:
    renderer_free(young);
    scene_release(&grown);
    text_release(&note);
    free(path);
    return status;
}

static Status draw_all(const Film *film, const FramesForm *form, RenderStats *stats, Err *err)
{
    const Animation *animation = film->animation;
    Progress *progress = film->params->progress_context;
    Renderer *prepared = NULL;
    Status status = STATUS_OK;
    for (int k = animation->first; k <= animation->last && status == STATUS_OK; k++) {
        char what[48];
        snprintf(what, sizeof what, "rendering %d of %d", k, animation->last);
        progress_start(progress, animation->kind ? what : "rendering", film->subject.common->quiet);
        status = draw_frame(film, k, form, &prepared, stats, err);
        progress_end(progress);
    }
    if (prepared)
        *stats = renderer_stats(prepared);
    renderer_free(prepared);
    return status;
}

/* What follows from --exact and --method where nothing is said of it. */
static void settle(RenderOptions *options)
{
    PictureOptions *picture = &options->picture;
    if (options->exact && !options->has_method)
        options->method = RENDER_TRACE;
    if (!picture->has_antialias && (options->exact || options->method == RENDER_ZBUFFER))
        picture->antialias = 1;
}

/* Whether vessels thinner than a pixel are drawn by their coverage: not where a method is asked
 * for, whose picture it is. */
static bool covers_thin(const RenderOptions *options)
{
    return options->method == RENDER_FASTEST && options->hits == HITS_EXACT;
}

/* Only primitives are drawn but by rays. */
static Status check_method(const RenderOptions *options, Err *err)
{
    SceneModel model = (SceneModel)options->picture.model;
    if (model_is_of(model, MODEL_PRIMITIVES))
        return STATUS_OK;
    Text able = TEXT_INIT;
    models_of(MODEL_PRIMITIVES, &able);
    Status status = err_set(err, STATUS_USAGE, "--method %s is for %s, not for %s",
                            methods[options->method], text_chars(&able), models[model].name);
    text_release(&able);
    return status;
}

/* What the file holds: 8 bits of a page, and nothing over floats. */
static Status check_file(const RenderOptions *options, const Parsed *parsed, Err *err)
{
    if (frames_is_page(options->output))
        return press_refuse_packing(parsed, "is for pictures; a page holds one of 8 bits", err);
    if (image_is_floats(options->output) && annotation_is_any(&options->annotation))
        return err_set(err, STATUS_USAGE,
                       "-o: %s holds numbers to measure, and no legend, scale bar or letter",
                       strcmp(file_extension(options->output), "exr") ? "a .pfm" : "an .exr");
    return press_check(&options->press, options->output, parsed, err);
}

/* Nothing can be drawn over what is transparent, nor parts of it joined; and every pixel is to be
 * of the same samples over any background. */
static Status check_transparent(const RenderOptions *options, const Parsed *parsed, Err *err)
{
    static const char *const able[] = {"png", "tif", "tiff", "exr", NULL};
    if (!picture_is_transparent(&options->picture))
        return STATUS_OK;
    if (!is_one_of(file_extension(options->output), able))
        return err_set(err, STATUS_USAGE,
                       "-o: '%s' cannot be transparent; --background none takes .png, .tif or .exr",
                       options->output);
    if (annotation_is_any(&options->annotation))
        return err_set(err, STATUS_USAGE,
                       "--background none: a legend, a scale bar or a letter needs a background");
    const OptionNeed needs[] = {
        {"cmyk-profile", false, "needs a background, not --background none"},
        {"antialias-threshold", false, "needs a background, not --background none"},
        {0}};
    return options_check_needs(parsed, needs, err);
}

/* Options that fight each other, or that the method does not know. */
static Status check(const RenderOptions *options, const Parsed *parsed, Err *err)
{
    const PictureOptions *picture = &options->picture;
    TRY(check_file(options, parsed, err));
    if (options->ink_mm > 0)
        TRY(line_drawing_check(picture, options->output, parsed, err));
    if (options->min_width_px > 0 && !covers_thin(options))
        return err_set(err, STATUS_USAGE,
                       "--min-width is for --method fastest, without --exact and --hits povray");
    if (options->min_width_px > 0 && model_is_of((SceneModel)picture->model, MODEL_TRIANGLES))
        return err_set(err, STATUS_USAGE, "--min-width is for vessels, not for --model %s",
                       models[picture->model].name);
    TRY(picture_check_needs(picture, parsed, err));
    TRY(annotation_check(&options->annotation, picture, parsed, err));
    TRY(check_transparent(options, parsed, err));
    TRY(picture_check_dpi(&picture->size, options->output, parsed, err));
    if (options->threshold > 0 && picture->antialias == 1)
        return err_set(err, STATUS_USAGE,
                       "--antialias-threshold needs --antialias N, with N from 2 to 9");
    if (options->exact && options->method != RENDER_TRACE)
        return err_set(err, STATUS_USAGE, "--exact is --method trace, not --method %s",
                       methods[options->method]);
    if (options->has_method && options->method != RENDER_TRACE)
        TRY(check_method(options, err));
    if (options->method == RENDER_ZBUFFER &&
        (picture->stage.shadows || picture->antialias > 1 || picture->occlusion > 0))
        return err_set(err, STATUS_USAGE,
                       "--method zbuffer draws neither shadows nor antialiased pictures nor "
                       "ambient occlusion");
    return STATUS_OK;
}

/* Whether something is drawn over the picture, or holds it. */
static bool is_on_sheet(const RenderOptions *options)
{
    return annotation_is_any(&options->annotation) || frames_is_page(options->output);
}

/* The files that --planes asks for, beside the picture. */
static Status plan_files(const RenderOptions *options, const Press *press, RenderParams *params,
                         FramesForm *form, Err *err)
{
    TRY(read_planes(options->planes, params, err));
    *form = (FramesForm){.width = options->picture.size.pixels[0],
                         .height = options->picture.size.pixels[1],
                         .path = options->output,
                         .bits = press->bits,
                         .packing = press->packing,
                         .encoding = ENCODING_SRGB,
                         .dpi = options->picture.size.dpi,
                         .picture = true,
                         .color = params->want_color,
                         .depth = params->want_depth,
                         .normal = params->want_normal,
                         .id = params->want_id};
    form->alpha = picture_is_transparent(&options->picture);
    params->codes_suffice = form->bits == 8 && !form->color && !form->alpha &&
                            !is_on_sheet(options) && !image_is_floats(form->path);
    params->want_color = true;
    return frames_is_page(options->output)
               ? STATUS_OK
               : frames_check_output(options->output, options->planes != NULL, err);
}

/* The names of all pictures, and of the planes beside them. */
static Status note_files(const Animation *animation, const FramesForm *form, Files *files, Err *err)
{
    for (int k = animation->first; k <= animation->last; k++) {
        FramesForm named = *form;
        char *path;
        TRY(animation_path(animation, form->path, k, &path, err));
        named.path = path;
        Status status = frames_note_planes(&named, files, err);
        if (status == STATUS_OK && animation->kind != ANIMATION_NONE)
            status = files_write(files, "-o", path, err);
        free(path);
        TRY(status);
    }
    return STATUS_OK;
}

/* Of an animation the one picture that --only asks for. */
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

/* Options that have no place beside effects of the look. */
static Status check_effects(const RenderOptions *options, const View *view, Err *err)
{
    if (!effects_present(&view->effects))
        return STATUS_OK;
    if (options->exact)
        return err_set(err, STATUS_USAGE,
                       "--exact is the picture that verify draws, and verify leaves out what "
                       "--look %s adds to it",
                       options->picture.look);
    if (options->threshold > 0)
        return err_set(err, STATUS_USAGE,
                       "--antialias-threshold: --look %s needs all samples of every pixel",
                       options->picture.look);
    return STATUS_OK;
}

/* The scene, with room for a legend, and what of it follows from the animation. */
static Status make_scene(RenderOptions *options, Parsed *parsed, const PictureSource *source,
                         const FigureFonts *fonts, Scene *scene, StageReport *staged,
                         Animation *animation, Err *err)
{
    PictureOptions *picture = &options->picture;
    TRY(picture_scene_of(picture, source, parsed, scene, NULL, staged, err));
    TRY(animation_count(animation, &scene->appearance, err));
    TRY(pick_only(options->shard.only, animation, err));
    if (options->annotation.legend) {
        TRY(annotation_make_room(&options->annotation, fonts, &scene->appearance, picture, err));
        TRY(picture_view(picture, source, &scene->geometry, &scene->view, err));
    }
    if (animation->kind == ANIMATION_TURN)
        TRY(animation_frame_turn(picture, source, scene, err));
    return STATUS_OK;
}

/* What lies over the picture of the scene. */
static Status fill_sheet(const RenderOptions *options, const char *tree, const Scene *scene,
                         const char *command, Sheet *sheet, Err *err)
{
    FigurePage *page = &sheet->page;
    Text description = TEXT_INIT;
    sheet_begin(sheet, options->picture.size.pixels, annotation_dpi(&options->picture));
    picture_description(&scene->geometry, tree, &description);
    Status status = sheet_describe(sheet, &description, command, err);
    text_release(&description);
    TRY(status);
    const FigureBox whole = {0, 0, page->width_mm, page->height_mm};
    return annotation_put(&options->annotation, scene, whole, page, err);
}

static Status draw_pictures(RenderOptions *options, Parsed *parsed, RenderParams *params,
                            FramesForm *form, Animation *animation, const Shard *shard, Err *err)
{
    const CellParams cells = picture_cells(&options->picture);
    PictureSource source = {0};
    Scene scene = {0};
    RenderStats stats = {0};
    StageReport staged;
    Sheet sheet = {0};
    char *line = NULL;
    Progress progress;
    Status status;
    params->povray_cells = options->hits == HITS_POVRAY ? &cells : NULL;
    params->progress = progress_report;
    params->progress_context = &progress;
    const Film film = {.subject = {&options->picture, &parsed->common, &source, &scene},
                       .animation = animation,
                       .params = params,
                       .parsed = parsed,
                       .resume = options->shard.resume,
                       .part = options->shard.resume || options->shard.tile,
                       .shard = *shard,
                       .step = band_rows(form, options->picture.occlusion, options->memory_mb)};
    TRY_GOTO(picture_fits(form->width, film.step, 40, err));
    if (frames_is_page(form->path))
        TRY_GOTO(picture_fits(form->width, form->height, 12, err));
    if (is_on_sheet(options))
        TRY_GOTO(sheet_open(&sheet, err));
    TRY_GOTO(picture_read_source(&options->picture, parsed, &source, err));
    TRY_GOTO(make_scene(options, parsed, &source, sheet.fonts, &scene, &staged, animation, err));
    TRY_GOTO(check_effects(options, &scene.view, err));
    TRY_GOTO(note_files(animation, form, &parsed->files, err));
    if (options->shard.commands) {
        const int tiles = options->shard.tiles;
        status =
            shard_print_commands(&options->shard, parsed, form->path, tiles ? 1 : animation->first,
                                 tiles ? tiles : animation->last, err);
        goto done;
    }
    TRY_GOTO(command_line_text(parsed, &line, err));
    form->provenance = line;
    form->colors = scene.appearance.said;
    if (is_on_sheet(options)) {
        TRY_GOTO(fill_sheet(options, source.of.path, &scene, line, &sheet, err));
        form->page = &sheet.page;
        form->notes = &sheet.notes;
    }
    if (options->ink_mm > 0) {
        status = line_drawing_write(&scene, options->ink_mm, params->threads, form, err);
        goto done;
    }
    TRY_GOTO(draw_all(&film, form, &stats, err));
    if (options->json)
        status = write_report(options->json, &scene, &stats, &staged, params->threads, err);
done:
    free(line);
    sheet_release(&sheet);
    scene_release(&scene);
    picture_source_release(&source);
    return status;
}

/* The part that is drawn, whose rows are those of the file. */
static Status settle_shard(const ShardOptions *options, bool animated, const Parsed *parsed,
                           FramesForm *form, Shard *shard, Err *err)
{
    const RenderKernels kernels = ((const RenderOptions *)parsed->options)->kernels;
    TRY(shard_check(options, animated, form, parsed, err));
    TRY(shard_of_tile(options->tile, form->height, shard, err));
    snprintf(shard->kernels, sizeof shard->kernels, "%s",
             render_kernel_names[kernels ? kernels : render_fastest_kernels()]);
    form->height = shard->rows;
    form->first = shard->first;
    return STATUS_OK;
}

static RenderParams params_of(const RenderOptions *options, int threads)
{
    const PictureOptions *picture = &options->picture;
    return (RenderParams){.threads = threads,
                          .antialias = picture->antialias,
                          .antialias_threshold = options->threshold,
                          .shadows = picture->stage.shadows,
                          .occlusion = picture->occlusion,
                          .method = options->method,
                          .cover_thin = covers_thin(options),
                          .least_px = options->min_width_px,
                          .kernels = options->kernels};
}

/* ---- panels ---------------------------------------------------------------------------------- */

FigureBox panel_part(const PanelInset *inset, const Camera *camera)
{
    double wide = inset->pixels[0] / inset->magnify / camera->width / 2;
    double high = inset->pixels[1] / inset->magnify / camera->height / 2;
    return (FigureBox){inset->at[0] - wide, inset->at[1] - high, inset->at[0] + wide,
                       inset->at[1] + high};
}

View panel_inset_view(const PanelInset *inset, const View *view)
{
    View shown = *view;
    Camera *camera = &shown.camera;
    const FigureBox part = panel_part(inset, camera);
    camera->location = vec3_add_scaled(camera->location, camera->right, inset->at[0] - 0.5);
    camera->location = vec3_add_scaled(camera->location, camera->up, 0.5 - inset->at[1]);
    camera->right = vec3_scale(camera->right, part.right - part.left);
    camera->up = vec3_scale(camera->up, part.bottom - part.top);
    camera->width = inset->pixels[0];
    camera->height = inset->pixels[1];
    return shown;
}

static Status draw_kept(Renderer *renderer, const Scene *scene, Picture *kept, Err *err)
{
    const Camera *camera = &scene->view.camera;
    const FramesForm form = {.width = camera->width,
                             .height = camera->height,
                             .path = "panel",
                             .bits = 8,
                             .encoding = ENCODING_SRGB,
                             .picture = true,
                             .kept = kept};
    const Film film = {.shard = {.rows = camera->height}, .step = band_rows(&form, 0, 128)};
    return draw(renderer, scene, &form, &film, err);
}

static Status draw_panel(const RenderParams *params, Panel *panel, Err *err)
{
    Renderer *renderer;
    TRY(renderer_new(&panel->scene.geometry, params, &renderer, err));
    Status status = draw_kept(renderer, &panel->scene, &panel->picture, err);
    for (size_t i = 0; i < panel->n_insets && status == STATUS_OK; i++) {
        Scene shown = panel->scene;
        shown.view = panel_inset_view(&panel->insets[i], &panel->scene.view);
        status = draw_kept(renderer, &shown, &panel->insets[i].picture, err);
    }
    renderer_free(renderer);
    return status;
}

Status panel_draw(Parsed *parsed, Panel *panel, Err *err)
{
    RenderOptions *options = parsed->options;
    const int *pixels = options->picture.size.pixels;
    PictureSource source = {0};
    Animation still = {.first = 1, .last = 1, .n = 1};
    StageReport staged;
    Progress progress;
    options->output = "panel";
    settle(options);
    const CellParams cells = picture_cells(&options->picture);
    RenderParams params = params_of(options, parsed->common.threads);
    params.povray_cells = options->hits == HITS_POVRAY ? &cells : NULL;
    params.want_color = true;
    params.progress = progress_report;
    params.progress_context = &progress;
    if (panel->n_insets > 0 && options->picture.projection == PROJECTION_PERSPECTIVE)
        return err_set(err, STATUS_USAGE, "an inset is a part of an orthographic picture");
    TRY(check(options, parsed, err));
    TRY(picture_fits(pixels[0], pixels[1], 40, err));
    Status status = picture_read_source(&options->picture, parsed, &source, err);
    if (status == STATUS_OK)
        status =
            make_scene(options, parsed, &source, panel->fonts, &panel->scene, &staged, &still, err);
    if (status == STATUS_OK)
        status = check_effects(options, &panel->scene.view, err);
    progress_start(&progress, "rendering", parsed->common.quiet);
    if (status == STATUS_OK)
        status = draw_panel(&params, panel, err);
    progress_end(&progress);
    panel->annotation = options->annotation;
    picture_source_release(&source);
    return status;
}

void panel_release(Panel *panel)
{
    for (size_t i = 0; i < panel->n_insets; i++)
        picture_release(&panel->insets[i].picture);
    picture_release(&panel->picture);
    scene_release(&panel->scene);
}

/* ---- the command ----------------------------------------------------------------------------- */

static Status run_render(void *options, Parsed *parsed, Err *err)
{
    RenderOptions *own_options = options;
    settle(own_options);
    FramesForm form;
    RenderParams params = params_of(own_options, parsed->common.threads);
    Animation animation;
    Shard shard;
    Press press = {0};
    Status status;
    TRY(check(own_options, parsed, err));
    TRY(animation_read(&own_options->animation, own_options->output, &animation, err));
    TRY(press_open(&own_options->press, own_options->output, &press, err));
    TRY_GOTO(plan_files(own_options, &press, &params, &form, err));
    TRY_GOTO(settle_shard(&own_options->shard, animation.kind != ANIMATION_NONE, parsed, &form,
                          &shard, err));
    status = draw_pictures(own_options, parsed, &params, &form, &animation, &shard, err);
done:
    press_release(&press);
    return status;
}

const Command command_render = {
    .name = "render",
    .summary = "render a tree with the native renderer",
    .operands = "T.swc -o P.png",
    .examples = "  corcast render tree.swc -o tree.png\n"
                "  corcast render tree.swc --model isosurface --shadows on -o tree.ppm\n"
                "  corcast render tree.swc --planes depth,normal,id -o tree.png\n"
                "  corcast render tree.swc --turntable 120 -o turn%03d.png\n"
                "  corcast render tree.swc --color-by pulse.csv --frames all -o f%04d.png\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
    .reads_tree = true,
    .size = sizeof(RenderOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0},
               {&shard_table, offsetof(RenderOptions, shard)},
               {&annotation_table, offsetof(RenderOptions, annotation)},
               PICTURE_TABLES(RenderOptions, picture),
               {&press_table, offsetof(RenderOptions, press)}},
    .run = run_render,
};
