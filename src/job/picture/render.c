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
static Status plan_form(Rendering *r, Err *err)
{
    const RenderOptions *options = r->options;
    const bool page = frames_is_page(options->output);
    RenderParams *params = &r->params;
    FramesForm *form = &r->form;
    TRY(read_planes(options->planes, params, err));
    *form = (FramesForm){.width = options->picture.size.pixels[0],
                         .height = options->picture.size.pixels[1],
                         .path = options->output,
                         .bits = r->press.bits,
                         .packing = r->press.packing,
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
    params->codes_suffice = form->bits == 8 && !form->color && !form->alpha && !r->has_sheet &&
                            !image_traits(form->path).floats;
    params->want_color = true;
    return page ? STATUS_OK : frames_check_output(options->output, options->planes != NULL, err);
}

/* Chooses the rows that are drawn: all rows, or the rows of one tile. */
static Status plan_rows(Rendering *r, Err *err)
{
    const RenderOptions *options = r->options;
    const RenderKernels kernels = options->kernels;
    if (r->in_memory && (options->shard.commands || options->shard.resume))
        return err_set(err, STATUS_USAGE,
                       "--%s needs files; it cannot be used with pictures in memory",
                       options->shard.commands ? "commands" : "resume");
    TRY(shard_check(&options->shard, &r->form, r->parsed, err));
    TRY(shard_of_tile(options->shard.tile, r->form.height, &r->shard, err));
    snprintf(r->shard.kernels, sizeof r->shard.kernels, "%s",
             render_kernel_names[kernels ? kernels : render_fastest_kernels()]);
    r->form.height = r->shard.rows;
    r->form.first = r->shard.first;
    return STATUS_OK;
}

/* Checks that there is memory for a band, and for a picture that is stored as a whole. While
 * drawing, a pixel has up to 12 bytes of color, 4 of depth, 12 of a normal and 7 of an id, and up
 * to 6 of its codes [render_band_rows]: 40 in round numbers. In a page, it has 3 floats of 4 bytes.
 * Errors: STATUS_MEMORY. */
static Status check_size(const Rendering *r, Err *err)
{
    const FramesForm *form = &r->form;
    const int step = render_band_rows(form, &r->params, NULL, r->options->memory_mb);
    TRY(picture_check_memory(form->width, r->in_memory ? form->height : step, 40, err));
    return frames_is_page(form->path) ? picture_check_memory(form->width, form->height, 12, err)
                                      : STATUS_OK;
}

/* Checks the options, and plans animation, files and rows, before any file is read. */
static Status plan(Rendering *r, Err *err)
{
    RenderOptions *options = r->options;
    TRY(render_check(options, err));
    TRY(animation_read(&options->animation, options->output, &r->animation, err));
    TRY(press_open(&options->press, options->output, r->parsed->common.threads, &r->press, err));
    TRY(plan_form(r, err));
    TRY(plan_rows(r, err));
    return check_size(r, err);
}

/* Reads the tree and makes its scene. `fonts` are those of the page that receives the picture;
 * NULL: of the sheet. */
static Status make_scene(Rendering *r, const FigureFonts *fonts, Err *err)
{
    if (r->has_sheet)
        TRY(sheet_open(&r->sheet, err));
    TRY(picture_read_source(&r->options->picture, r->parsed, &r->source, err));
    TRY(render_make_scene(r->options, r->parsed, &r->source, fonts ? fonts : r->sheet.fonts,
                          &r->scene, &r->report, &r->animation, err));
    return r->form.id ? picture_check_ids(&r->scene.geometry, r->source.of.path, err) : STATUS_OK;
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

void rendering_close(Rendering *r)
{
    if (r->in_memory)
        r->options->output = NULL;
    renderer_free(r->renderer);
    free(r->provenance);
    sheet_release(&r->sheet);
    scene_release(&r->scene);
    picture_source_release(&r->source);
    press_release(&r->press);
}

/* ---- annotations and reports ----------------------------------------------------------------- */

/* Puts legend, scale bar and panel letter on the sheet, the page that is drawn over the
 * pictures. */
static Status fill_sheet(Rendering *r, Err *err)
{
    const PictureOptions *picture = &r->options->picture;
    FigurePage *page = &r->sheet.page;
    Text description = TEXT_INIT;
    sheet_begin(&r->sheet, picture->size.pixels, annotation_dpi(&picture->size));
    picture_description(&r->scene.geometry, r->source.of.path, &description);
    Status status = sheet_describe(&r->sheet, &description, r->parsed, err);
    text_release(&description);
    TRY(status);
    const FigureBox whole = {0, 0, page->width_mm, page->height_mm};
    TRY(annotation_put(&r->options->annotation, &r->scene, whole, page, err));
    TRY(sheet_report(&r->sheet, r->parsed->common.talk, err));
    page->inks = r->press.inks;
    r->form.page = page;
    r->form.notes = &r->sheet.notes;
    return STATUS_OK;
}

/* Sets the metadata of the output files and the annotations, and reports parts of the tree that the
 * scene leaves out. */
Status rendering_describe(Rendering *r, Err *err)
{
    TRY(command_line_text(r->parsed, &r->provenance, err));
    r->form.provenance = r->provenance;
    r->form.colors = r->scene.appearance.meaning;
    if (r->has_sheet)
        TRY(fill_sheet(r, err));
    return picture_report(&r->scene, &r->report, r->parsed->common.talk, err);
}

static json_t *smooth_json(const SmoothReport *smooth)
{
    return json_pack("{s:I, s:I, s:f, s:f, s:f, s:f}", "segments", (json_int_t)smooth->segments,
                     "pieces", (json_int_t)smooth->pieces, "distance_mm", smooth->distance_mm,
                     "distance_radii", smooth->distance_radii, "radius_change",
                     smooth->radius_change, "tolerance", smooth->tolerance);
}

/* The keys places_short, places_sharp and places_crowded count junctions. */
json_t *rendering_json(const Rendering *r)
{
    const Scene *scene = &r->scene;
    const StageReport *staged = &r->report.staged;
    const RenderStats stats = render_stats(r);
    json_t *report =
        json_pack("{s:s, s:s, s:s, s:i, s:i, s:f, s:f, s:f, s:I, s:i}", "generator", GENERATOR,
                  "model", models[scene->geometry.model].name, "engine", stats.engine, "width",
                  scene->view.camera.width, "height", scene->view.camera.height, "prepare_seconds",
                  stats.prepare_s, "trace_seconds", stats.trace_s, "cpu_seconds", stats.cpu_s,
                  "rays", (json_int_t)stats.rays, "threads",
                  r->params.threads ? r->params.threads : threads_available());
    if (model_has(scene->geometry.model, MODEL_JOINTS)) {
        report = JSON_WITH(report, {"joints", json_count(staged->joints)},
                           {"places_short", json_count(staged->junctions_short)},
                           {"places_sharp", json_count(staged->junctions_sharp)},
                           {"places_crowded", json_count(staged->junctions_crowded)});
    }
    if (r->report.smooth.pieces)
        report = json_with(report, "smooth", smooth_json(&r->report.smooth));
    if (scene->appearance.meaning)
        report = json_with(report, "color", coloring_json(&scene->appearance));
    return report;
}

/* ---- into memory ----------------------------------------------------------------------------- */

Status rendering_draw_result(Rendering *r, RenderResult *made, Err *err)
{
    if (r->animation.first != r->animation.last)
        return err_set(err, STATUS_USAGE,
                       "--only K is missing: a picture in memory is one of the animation's %d",
                       r->animation.n);
    r->name = "the picture";
    TRY(rendering_draw(r, r->animation.first, &made->frame, err));
    made->dpi = r->form.dpi;
    made->engine = render_stats(r).engine;
    return r->form.colors ? mem_strdup(&made->colors, r->form.colors, err) : STATUS_OK;
}

void render_release(RenderResult *result)
{
    frame_release(&result->frame);
    free(result->colors);
    *result = (RenderResult){0};
}

/* ---- into files ------------------------------------------------------------------------------ */

/* Adds the files of all pictures and of their planes to the output files of the command. */
static Status note_files(Rendering *r, Err *err)
{
    for (int k = r->animation.first; k <= r->animation.last; k++) {
        FramesForm named = r->form;
        char *path;
        TRY(animation_path(&r->animation, r->form.path, k, &path, err));
        named.path = path;
        Status status = frames_note_planes(&named, &r->parsed->files, err);
        if (status == STATUS_OK && r->animation.kind != ANIMATION_NONE)
            status = files_add_output(&r->parsed->files, "-o", path, err);
        free(path);
        TRY(status);
    }
    return STATUS_OK;
}

static Status write_pictures(Rendering *r, Err *err)
{
    const int tiles = r->options->shard.tiles;
    TRY(note_files(r, err));
    if (r->options->shard.commands)
        return shard_put_commands(&r->options->shard, r->parsed, r->form.path,
                                  tiles ? 1 : r->animation.first, tiles ? tiles : r->animation.last,
                                  err);
    TRY(rendering_describe(r, err));
    if (r->options->ink_mm > 0)
        return line_drawing_write(&r->scene, r->options->ink_mm, r->params.threads, &r->form, err);
    for (int k = r->animation.first; k <= r->animation.last; k++)
        TRY(rendering_draw(r, k, NULL, err));
    const char *report = r->options->json;
    return report ? json_write(rendering_json(r), report, err) : STATUS_OK;
}

Status render_run(void *options, Parsed *parsed, Err *err)
{
    Rendering r;
    TRY(rendering_open(options, parsed, NULL, &r, err));
    Status status = write_pictures(&r, err);
    rendering_close(&r);
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
