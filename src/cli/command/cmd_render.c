/* Everything that may fail for a reason of the user's is asked before the first ray: options,
 * files, templates, the tree. */
#include "cli/commands.h"
#include "job/picture/line_drawing.h"
#include "job/picture/render_film.h"
#include "job/picture/render_options.h"
#include "job/picture/sheet.h"
#include "options/output.h"
#include "options/talk.h"
#include <stdlib.h>
#include <string.h>

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
            {"joints", json_count(staged->joints)},
            {"places_short", json_count(staged->places_short)},
            {"places_sharp", json_count(staged->places_sharp)},
            {"places_crowded", json_count(staged->places_crowded)},
        };
        report = json_with_members(report, of_joints, sizeof of_joints / sizeof *of_joints);
    }
    if (scene->appearance.said)
        report = json_with(report, "color", coloring_json(&scene->appearance));
    return json_write(report, path, err);
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
                            !is_on_sheet(options) && !image_traits(form->path).floats;
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

/* STATUS_MEMORY unless there is memory for a band of `step` rows, and for the page that keeps all.
 */
static Status check_size(const FramesForm *form, int step, Err *err)
{
    TRY(picture_fits(form->width, step, 40, err));
    return frames_is_page(form->path) ? picture_fits(form->width, form->height, 12, err)
                                      : STATUS_OK;
}

/* A command for each tile, or for each picture of the animation. */
static Status print_commands(const ShardOptions *options, const Parsed *parsed, const char *path,
                             const Animation *animation, Err *err)
{
    int tiles = options->tiles;
    return shard_print_commands(options, parsed, path, tiles ? 1 : animation->first,
                                tiles ? tiles : animation->last, err);
}

static Status draw_pictures(RenderOptions *options, Parsed *parsed, RenderParams *params,
                            FramesForm *form, Animation *animation, const Shard *shard, Err *err)
{
    PictureSource source = {0};
    Scene scene = {0};
    RenderStats stats = {0};
    PictureReport made;
    Sheet sheet = {0};
    char *line = NULL;
    Progress progress;
    Status status;
    params->progress = progress_report;
    params->progress_context = &progress;
    const Film film = {.subject = {&options->picture, &parsed->common, &source, &scene},
                       .animation = animation,
                       .params = params,
                       .parsed = parsed,
                       .resume = options->shard.resume,
                       .part = options->shard.resume || options->shard.tile,
                       .shard = *shard,
                       .memory_mb = options->memory_mb};
    TRY_GOTO(check_size(form, film_band_rows(form, params, NULL, options->memory_mb), err));
    if (is_on_sheet(options))
        TRY_GOTO(sheet_open(&sheet, err));
    TRY_GOTO(picture_read_source(&options->picture, parsed, &source, err));
    TRY_GOTO(
        render_make_scene(options, parsed, &source, sheet.fonts, &scene, &made, animation, err));
    if (form->id)
        TRY_GOTO(picture_check_ids(&scene.geometry, source.of.path, err));
    TRY_GOTO(note_files(animation, form, &parsed->files, err));
    if (options->shard.commands) {
        status = print_commands(&options->shard, parsed, form->path, animation, err);
        goto done;
    }
    TRY_GOTO(command_line_text(parsed, &line, err));
    form->provenance = line;
    form->colors = scene.appearance.said;
    if (is_on_sheet(options)) {
        TRY_GOTO(fill_sheet(options, source.of.path, &scene, line, &sheet, err));
        figure_warn(&sheet.page, "corcast render", parsed->common.quiet);
        form->page = &sheet.page;
        form->notes = &sheet.notes;
    }
    TRY_GOTO(picture_say(&scene, &made, parsed->common.quiet, err));
    if (options->ink_mm > 0) {
        status = line_drawing_write(&scene, options->ink_mm, params->threads, form, err);
        goto done;
    }
    TRY_GOTO(film_draw(&film, form, &stats, err));
    if (options->json)
        status = write_report(options->json, &scene, &stats, &made.staged, params->threads, err);
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

Status run_render(void *options, Parsed *parsed, Err *err)
{
    RenderOptions *own_options = options;
    render_settle(own_options);
    FramesForm form;
    CellParams cells;
    RenderParams params = render_params_of(own_options, parsed->common.threads, &cells);
    Animation animation;
    Shard shard;
    Press press = {0};
    Status status;
    TRY(render_check(own_options, parsed, err));
    TRY(animation_read(&own_options->animation, own_options->output, &animation, err));
    TRY(press_open(&own_options->press, own_options->output, parsed->common.threads, &press, err));
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
    .set_defaults = render_set_defaults,
    .tables = {{&render_table, 0},
               {&shard_table, offsetof(RenderOptions, shard)},
               {&annotation_table, offsetof(RenderOptions, annotation)},
               PICTURE_TABLES(RenderOptions, picture),
               {&press_table, offsetof(RenderOptions, press)}},
};
