/* Runs the operation `render`: reads the options and the tree, makes the scene, and draws it to
 * memory, to files or to a page. Every drawing begins with rendering_open, which detects all errors
 * in options, files, templates and the tree before the first ray is traced. render_bands.c then
 * draws. */
#include "job/picture/render.h"

#include "job/job.h"
#include "job/picture/line_drawing.h"
#include "job/picture/render_bands.h"
#include "options/output.h"
#include "options/talk.h"
#include <stdlib.h>
#include <string.h>

/* ---- what is drawn, and where to ------------------------------------------------------------- */

/* Reads the list of --planes, and sets the want_ members of *params. */
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

/* Returns a file name whose extension selects the format of a picture in memory. No such file is
 * written. */
static const char *form_name(const RenderOptions *options, bool on_page)
{
    if (on_page)
        return options->ink_mm > 0 ? "panel.pdf" : "panel.ppm";
    return options->press.bits == 32 ? "picture%d.exr" : "picture%d.png";
}

/* Sets the form of the files from the options, and the planes that are rendered. */
static Status plan_form(Rendering *rendering, Err *err)
{
    const RenderOptions *options = rendering->options;
    const bool page = frames_is_page(options->output);
    RenderParams *params = &rendering->params;
    FramesForm *form = &rendering->form;
    TRY(read_planes(options->planes, params, err));
    *form = (FramesForm){.width = options->picture.size.pixels[0],
                         .height = options->picture.size.pixels[1],
                         .path = options->output,
                         .bits = rendering->press.bits,
                         .packing = rendering->press.packing,
                         .encoding = ENCODING_SRGB,
                         .dpi = options->picture.size.dpi,
                         .picture = true,
                         .color = params->want_color,
                         .depth = params->want_depth,
                         .normal = params->want_normal,
                         .id = params->want_id};
    /* form->color states that --planes lists the plane `color`. The color itself is always
     * rendered. 8-bit codes suffice if an opaque picture of 8 bits is the only use of the color. */
    form->alpha = picture_is_transparent(&options->picture);
    params->codes_suffice = form->bits == 8 && !form->color && !form->alpha &&
                            !rendering->has_sheet && !image_traits(form->path).floats;
    params->want_color = true;
    return page ? STATUS_OK : frames_check_output(options->output, options->planes != NULL, err);
}

/* Chooses the rows that are drawn: all rows, or the rows of one tile. */
static Status plan_rows(Rendering *rendering, Err *err)
{
    const RenderOptions *options = rendering->options;
    const RenderKernels kernels = options->kernels;
    if (rendering->in_memory && (options->shard.commands || options->shard.resume))
        return err_set(err, STATUS_USAGE,
                       "--%s needs files; it cannot be used with pictures in memory",
                       options->shard.commands ? "commands" : "resume");
    TRY(shard_check(&options->shard, &rendering->form, rendering->parsed, err));
    TRY(shard_of_tile(options->shard.tile, rendering->form.height, &rendering->shard, err));
    snprintf(rendering->shard.kernels, sizeof rendering->shard.kernels, "%s",
             render_kernel_names[kernels ? kernels : render_fastest_kernels()]);
    rendering->form.height = rendering->shard.rows;
    rendering->form.first = rendering->shard.first;
    return STATUS_OK;
}

/* Checks that there is memory for a band, and for a picture that is stored as a whole. While
 * drawing, a pixel has up to 12 bytes of color, 4 of depth, 12 of a normal and 7 of an id, and up
 * to 6 of its codes [render_band_rows]: 40 in round numbers. In a page, it has 3 floats of 4 bytes.
 * Errors: STATUS_MEMORY. */
static Status check_size(const Rendering *rendering, Err *err)
{
    const FramesForm *form = &rendering->form;
    const int step =
        render_band_rows(form, &rendering->params, NULL, rendering->options->memory_mb);
    TRY(picture_check_memory(form->width, rendering->in_memory ? form->height : step, 40, err));
    return frames_is_page(form->path) ? picture_check_memory(form->width, form->height, 12, err)
                                      : STATUS_OK;
}

/* Checks the options, and plans animation, files and rows, before any file is read. */
static Status plan(Rendering *rendering, Err *err)
{
    RenderOptions *options = rendering->options;
    TRY(render_check(options, err));
    TRY(animation_read(&options->animation, options->output, &rendering->animation, err));
    TRY(press_open(&options->press, options->output, rendering->parsed->common.threads,
                   &rendering->press, err));
    TRY(plan_form(rendering, err));
    TRY(plan_rows(rendering, err));
    return check_size(rendering, err);
}

/* Reads the tree and makes its scene. `fonts` are those of the page that receives the picture;
 * NULL: of the sheet. */
static Status make_scene(Rendering *rendering, const FigureFonts *fonts, Err *err)
{
    if (rendering->has_sheet)
        TRY(sheet_open(&rendering->sheet, err));
    TRY(picture_read_source(&rendering->options->picture, rendering->parsed, &rendering->source,
                            err));
    TRY(render_make_scene(rendering->options, rendering->parsed, &rendering->source,
                          fonts ? fonts : rendering->sheet.fonts, &rendering->scene,
                          &rendering->report, &rendering->animation, err));
    return rendering->form.id
               ? picture_check_ids(&rendering->scene.geometry, rendering->source.of.path, err)
               : STATUS_OK;
}

/* For a picture in memory, options->output is a name by form_name until rendering_close. After an
 * error the Rendering is closed already. */
Status rendering_open(RenderOptions *options, Parsed *parsed, const FigureFonts *fonts,
                      Rendering *out, Err *err)
{
    *out = (Rendering){.options = options, .parsed = parsed, .in_memory = !options->output};
    if (out->in_memory)
        options->output = form_name(options, fonts != NULL);
    render_settle(options);
    out->params = render_params_of(options, parsed->common.threads, &out->cells);
    out->params.progress = progress_report;
    out->params.progress_context = &out->progress;
    out->has_sheet =
        !fonts && (annotation_is_wanted(&options->annotation) || frames_is_page(options->output));
    Status status = plan(out, err);
    if (status == STATUS_OK)
        status = make_scene(out, fonts, err);
    if (status != STATUS_OK)
        rendering_close(out);
    return status;
}

void rendering_close(Rendering *rendering)
{
    if (rendering->in_memory)
        rendering->options->output = NULL;
    renderer_free(rendering->renderer);
    free(rendering->provenance);
    sheet_release(&rendering->sheet);
    scene_release(&rendering->scene);
    picture_source_release(&rendering->source);
    press_release(&rendering->press);
}

/* ---- annotations and reports ----------------------------------------------------------------- */

/* Puts legend, scale bar and panel letter on the sheet, the page that is drawn over the
 * pictures. */
static Status fill_sheet(Rendering *rendering, Err *err)
{
    const PictureOptions *picture = &rendering->options->picture;
    FigurePage *page = &rendering->sheet.page;
    Text description = TEXT_INIT;
    sheet_begin(&rendering->sheet, picture->size.pixels, annotation_dpi(&picture->size));
    picture_description(&rendering->scene.geometry, rendering->source.of.path, &description);
    Status status = sheet_describe(&rendering->sheet, &description, rendering->parsed, err);
    text_release(&description);
    TRY(status);
    const FigureBox whole = {0, 0, page->width_mm, page->height_mm};
    TRY(annotation_put(&rendering->options->annotation, &rendering->scene, whole, page, err));
    TRY(sheet_report(&rendering->sheet, rendering->parsed->common.talk, err));
    page->inks = rendering->press.inks;
    rendering->form.page = page;
    rendering->form.notes = &rendering->sheet.notes;
    return STATUS_OK;
}

/* Sets the metadata of the output files and the annotations, and reports parts of the tree that the
 * scene leaves out. */
Status rendering_describe(Rendering *rendering, Err *err)
{
    TRY(command_line_text(rendering->parsed, &rendering->provenance, err));
    rendering->form.provenance = rendering->provenance;
    rendering->form.colors = rendering->scene.appearance.meaning;
    if (rendering->has_sheet)
        TRY(fill_sheet(rendering, err));
    return picture_report(&rendering->scene, &rendering->report, rendering->parsed->common.talk,
                          err);
}

static json_t *smooth_json(const SmoothReport *smooth)
{
    return json_pack("{s:I, s:I, s:f, s:f, s:f, s:f}", "segments", (json_int_t)smooth->segments,
                     "pieces", (json_int_t)smooth->pieces, "distance_mm", smooth->distance_mm,
                     "distance_radii", smooth->distance_radii, "radius_change",
                     smooth->radius_change, "tolerance", smooth->tolerance);
}

/* The keys places_short, places_sharp and places_crowded count junctions. */
json_t *rendering_json(const Rendering *rendering)
{
    const Scene *scene = &rendering->scene;
    const StageReport *staged = &rendering->report.staged;
    const RenderStats stats = render_stats(rendering);
    json_t *report =
        json_pack("{s:s, s:s, s:s, s:i, s:i, s:f, s:f, s:f, s:I, s:i}", "generator", GENERATOR,
                  "model", models[scene->geometry.model].name, "engine", stats.engine, "width",
                  scene->view.camera.width, "height", scene->view.camera.height, "prepare_seconds",
                  stats.prepare_s, "trace_seconds", stats.trace_s, "cpu_seconds", stats.cpu_s,
                  "rays", (json_int_t)stats.rays, "threads",
                  rendering->params.threads ? rendering->params.threads : threads_available());
    if (model_has(scene->geometry.model, MODEL_JOINTS)) {
        report = JSON_WITH(report, {"joints", json_count(staged->joints)},
                           {"places_short", json_count(staged->junctions_short)},
                           {"places_sharp", json_count(staged->junctions_sharp)},
                           {"places_crowded", json_count(staged->junctions_crowded)});
    }
    if (rendering->report.smooth.pieces)
        report = json_with(report, "smooth", smooth_json(&rendering->report.smooth));
    if (scene->appearance.meaning)
        report = json_with(report, "color", coloring_json(&scene->appearance));
    return report;
}

/* ---- into memory ----------------------------------------------------------------------------- */

Status rendering_draw_result(Rendering *rendering, RenderResult *made, Err *err)
{
    if (rendering->animation.first != rendering->animation.last)
        return err_set(err, STATUS_USAGE,
                       "--only K is missing: a picture in memory is one of the animation's %d",
                       rendering->animation.n);
    rendering->name = "the picture";
    TRY(rendering_draw(rendering, rendering->animation.first, &made->frame, err));
    made->dpi = rendering->form.dpi;
    made->engine = render_stats(rendering).engine;
    return rendering->form.colors ? mem_strdup(&made->colors, rendering->form.colors, err)
                                  : STATUS_OK;
}

void renderresult_release(RenderResult *result)
{
    frame_release(&result->frame);
    free(result->colors);
    *result = (RenderResult){0};
}

/* ---- into files ------------------------------------------------------------------------------ */

/* Adds the files of all pictures and of their planes to the output files of the command. */
static Status note_files(Rendering *rendering, Err *err)
{
    for (int k = rendering->animation.first; k <= rendering->animation.last; k++) {
        FramesForm named = rendering->form;
        char *path;
        TRY(animation_path(&rendering->animation, rendering->form.path, k, &path, err));
        named.path = path;
        Status status = frames_note_planes(&named, &rendering->parsed->files, err);
        if (status == STATUS_OK && rendering->animation.kind != ANIMATION_NONE)
            status = files_add_output(&rendering->parsed->files, "-o", path, err);
        free(path);
        TRY(status);
    }
    return STATUS_OK;
}

static Status write_pictures(Rendering *rendering, Err *err)
{
    const int tiles = rendering->options->shard.tiles;
    TRY(note_files(rendering, err));
    if (rendering->options->shard.commands)
        return shard_put_commands(&rendering->options->shard, rendering->parsed,
                                  rendering->form.path, tiles ? 1 : rendering->animation.first,
                                  tiles ? tiles : rendering->animation.last, err);
    TRY(rendering_describe(rendering, err));
    if (rendering->options->ink_mm > 0)
        return line_drawing_write(&rendering->scene, rendering->options->ink_mm,
                                  rendering->params.threads, &rendering->form, err);
    for (int k = rendering->animation.first; k <= rendering->animation.last; k++)
        TRY(rendering_draw(rendering, k, NULL, err));
    const char *report = rendering->options->json;
    return report ? json_write(rendering_json(rendering), report, err) : STATUS_OK;
}

Status render_run(void *options, Parsed *parsed, Err *err)
{
    Rendering rendering;
    TRY(rendering_open(options, parsed, NULL, &rendering, err));
    Status status = write_pictures(&rendering, err);
    rendering_close(&rendering);
    return status;
}

const Command command_render = {
    .name = "render",
    .summary = "render a tree to an image",
    .operands = "T.swc -o P.png",
    .examples = "  corcast render tree.swc -o tree.png\n"
                "  corcast render tree.swc --model isosurface --shadows on -o tree.ppm\n"
                "  corcast render tree.swc --planes depth,normal,id -o tree.png\n"
                "  corcast render tree.swc --turntable 120 -o turn%03d.png\n"
                "  corcast render tree.swc --color-by pulse.csv --moments all -o f%04d.png\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
    .reads_tree = true,
    .size = sizeof(RenderOptions),
    .set_defaults = render_set_defaults,
    .tables = {{&render_table, 0},
               {&shard_table, offsetof(RenderOptions, shard)},
               {&legend_table, offsetof(RenderOptions, annotation)},
               {&annotation_table, offsetof(RenderOptions, annotation)},
               PICTURE_TABLES(RenderOptions, picture),
               {&press_table, offsetof(RenderOptions, press)}},
};
