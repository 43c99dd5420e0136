#include "app/commands.h"
#include "app/frames.h"
#include "app/picture.h"
#include "render/render.h"
#include <stdlib.h>
#include <string.h>

static const Command command = {
    .name = "render",
    .summary = "render a tree with the native renderer",
    .operands = "T.swc -o P.png",
    .examples = "  corcast render tree.swc -o tree.png\n"
                "  corcast render tree.swc --model isosurface --antialias 3 -o tree.ppm\n"
                "  corcast render tree.swc --planes depth,normal,id -o tree.png\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
};

enum { HITS_EXACT, HITS_POVRAY };
static const char *const hits_names[] = {"exact", "povray", NULL};
static const char *const methods[] = {
    [RENDER_TRACE] = "trace", [RENDER_RASTER] = "raster", [RENDER_ZBUFFER] = "zbuffer", NULL};

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
    json_t *report =
        json_pack("{s:s, s:s, s:i, s:i, s:f, s:f, s:f, s:I, s:i}", "generator", GENERATOR, "model",
                  model_name(scene->model), "width", scene->camera.width, "height",
                  scene->camera.height, "prepare_seconds", stats->prepare_s, "trace_seconds",
                  stats->trace_s, "cpu_seconds", stats->cpu_s, "rays", (json_int_t)stats->rays,
                  "threads", threads ? threads : threads_available());
    if (scene->model == SCENE_JOINED) {
        const JsonMember of_joints[] = {
            {"joints", json_integer((json_int_t)staged->joints)},
            {"places_short", json_integer((json_int_t)staged->places_short)},
            {"places_sharp", json_integer((json_int_t)staged->places_sharp)},
            {"places_crowded", json_integer((json_int_t)staged->places_crowded)},
        };
        report = json_with_members(report, of_joints, sizeof of_joints / sizeof *of_joints);
    }
    return json_write(report, path, err);
}

/* Rows of a band so that it takes about `memory_mb`: floats, codes and masks. */
static int band_rows(const FramesForm *form, double memory_mb)
{
    int bytes = 12 + form->bits / 8 * 3 + 1 + 4 * form->depth + 12 * form->normal + 7 * form->id;
    double rows = memory_mb * 1e6 / ((double)bytes * form->width);
    if (rows >= form->height)
        return form->height;
    return rows < 2 * RENDER_BAND_STEP ? RENDER_BAND_STEP
                                       : (int)rows / RENDER_BAND_STEP * RENDER_BAND_STEP;
}

/* Draws band after band and writes each before the next. */
static Status draw_bands(Renderer *renderer, FramesWriter *writer, int height, int step, Err *err)
{
    for (int first = 0; first < height; first += step) {
        Frame band;
        int rows = step < height - first ? step : height - first;
        TRY(renderer_rows(renderer, first, rows, &band, err));
        Status status = frames_rows(writer, &band, err);
        frame_release(&band);
        TRY(status);
    }
    return STATUS_OK;
}

static Status draw(const Scene *scene, const RenderParams *params, const FramesForm *form,
                   double memory_mb, RenderStats *stats, Err *err)
{
    int step = band_rows(form, memory_mb);
    TRY(picture_fits(form->width, step, 40, err));
    Renderer *renderer;
    TRY(renderer_new(scene, params, &renderer, err));
    FramesWriter *writer = NULL;
    Status status = frames_open(&writer, form, err);
    if (status == STATUS_OK)
        status = draw_bands(renderer, writer, form->height, step, err);
    *stats = renderer_stats(renderer);
    renderer_free(renderer);
    if (status == STATUS_OK)
        return frames_commit(writer, err);
    frames_discard(writer);
    return status;
}

Status run_render(int argc, char **argv, Err *err)
{
    PictureOptions picture;
    picture_options_init(&picture);
    const char *output = NULL, *planes = NULL, *json = NULL;
    int bits = 8, hits = HITS_EXACT, method = RENDER_TRACE, kernels = KERNELS_FASTEST;
    double threshold = 0, memory_mb = 128;
    const Option own[] = {
        {"output", OPTION_OUTPUT, &output, NULL, 0, 0, NULL, "P",
         "the picture: .png, .ppm, .tif or .pfm"},
        {"planes", OPTION_TEXT, &planes, NULL, 0, 0, NULL, "LIST",
         "planes beside it: color,depth,normal,id"},
        {"bits", OPTION_WHOLE, &bits, NULL, 8, 16, NULL, "8|16", "of a PNG or PPM (8)"},
        {"method", OPTION_CHOICE, &method, NULL, 0, 0, methods, NULL,
         "all but isosurfaces: as POV-Ray does, fast, or as the paper does (trace)"},
        {"hits", OPTION_CHOICE, &hits, NULL, 0, 0, hits_names, NULL,
         "isosurface: where it is, or where POV-Ray's root finder sees it (exact)"},
        {"antialias-threshold", OPTION_NUMBER, &threshold, NULL, 0, 1, NULL, "T",
         "antialias only pixels that differ by T from a neighbour (0: all, as POV-Ray)"},
        {"kernels", OPTION_CHOICE, &kernels, NULL, 0, 0, render_kernel_names, NULL,
         "instructions that tiles are drawn with, for tests (fastest)"},
        {"memory", OPTION_NUMBER, &memory_mb, NULL, 1e-3, 1e9, NULL, "MB",
         "of a band; larger pictures are drawn and written band by band (128)"},
        {"json", OPTION_OUTPUT, &json, NULL, 0, 0, NULL, "FILE", "what was done, as JSON"},
        {0},
    };
    const Option *const tables[] = {own, picture.table, picture.coloring.table, NULL};
    Parsed parsed;
    TRY(options_parse(&command, tables, argc, argv, &parsed, err));
    Status status = STATUS_OK;
    Scene scene = {0};
    RenderStats stats;
    StageReport staged;
    char *line = NULL;
    Progress progress;
    RenderParams params = {.threads = parsed.common.threads,
                           .progress = progress_report,
                           .progress_context = &progress,
                           .antialias = picture.antialias,
                           .shadows = picture.stage.shadows};
    if (parsed.common.help)
        goto done;
    TRY_GOTO(bits_check(bits, err));
    const OptionNeed needs[] = {{"bits", strcmp(file_extension(output), "pfm") != 0,
                                 "is for whole numbers; a .pfm holds floats"},
                                {0}};
    TRY_GOTO(options_check_needs(&parsed, needs, err));
    TRY_GOTO(picture_check_needs(&picture, &parsed, err));
    if (threshold > 0 && picture.antialias == 1) {
        status = err_set(err, STATUS_USAGE,
                         "--antialias-threshold needs --antialias N, with N from 2 to 9");
        goto done;
    }
    if (method != RENDER_TRACE &&
        (picture.model == SCENE_ISOSURFACE || picture.model == SCENE_BLOB)) {
        status = err_set(err, STATUS_USAGE,
                         "--method %s is for cylinders, joined and rounded, not for %s",
                         methods[method], model_name((SceneModel)picture.model));
        goto done;
    }
    if (method == RENDER_ZBUFFER &&
        (params.shadows || picture.antialias > 1 || picture.occlusion > 0)) {
        status = err_set(err, STATUS_USAGE,
                         "--method zbuffer draws neither shadows nor antialiased pictures nor "
                         "ambient occlusion");
        goto done;
    }
    params.method = (RenderMethod)method;
    params.kernels = (RenderKernels)kernels;
    params.antialias_threshold = threshold;
    params.occlusion = picture.occlusion;
    TRY_GOTO(read_planes(planes, &params, err));
    FramesForm form = {.width = picture.size[0],
                       .height = picture.size[1],
                       .path = output,
                       .bits = bits,
                       .encoding = ENCODING_SRGB,
                       .picture = true,
                       .color = params.want_color,
                       .depth = params.want_depth,
                       .normal = params.want_normal,
                       .id = params.want_id};
    params.codes_suffice = bits == 8 && !form.color && strcmp(file_extension(output), "pfm") != 0;
    params.want_color = true;
    TRY_GOTO(frames_check_output(output, planes != NULL, err));
    TRY_GOTO(frames_note_planes(&form, &parsed.files, err));
    TRY_GOTO(
        picture_scene(&picture, parsed.operands[0], parsed.common.quiet, &scene, &staged, err));
    const CellParams cells = picture_cells(&picture);
    params.povray_cells = hits == HITS_POVRAY ? &cells : NULL;
    TRY_GOTO(command_line_text("render", argc, argv, &line, err));
    form.provenance = line;
    progress_start(&progress, "rendering", parsed.common.quiet);
    status = draw(&scene, &params, &form, memory_mb, &stats, err);
    progress_end(&progress);
    TRY_GOTO(status);
    if (json)
        TRY_GOTO(write_report(json, &scene, &stats, &staged, params.threads, err));
done:
    free(line);
    scene_release(&scene);
    parsed_release(&parsed);
    return status;
}
