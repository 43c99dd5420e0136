/* One scene, two renderers: the scene is written for POV-Ray and rendered natively from memory;
 * then all four planes of both are held against each other. An implicit surface takes two steps:
 * corcast repeats POV-Ray's root finder, whose picture must be POV-Ray's, and where that sees the
 * surface is held against where it is. */
#include "app/commands.h"
#include "app/frames.h"
#include "app/picture.h"
#include "app/povfiles.h"
#include "app/progress.h"
#include "app/settle.h"
#include "app/templates.h"
#include "render/render.h"
#include "verify/verify.h"
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

typedef struct Verification {
    const PictureOptions *picture;
    const Common *common;
    const char *tree, *folder;
    int lock;   /* the folder, locked, or -1 */
    char *name; /* of the tree, for the report; owned */
    Scene scene;
    CellParams cells;
    Frame native, povray,
        exact; /* `exact` of an isosurface, whose `native` is POV-Ray's view of it */
    int bits;  /* of the colours that are compared */
    RenderKernels kernels;
    Picture native_picture, povray_picture; /* sRGB of 8 bits, or linear of 16 */
    Picture native_shown, povray_shown;     /* of 16 bits, in sRGB of 8 bits */
    RenderStats stats;                      /* of the exact frame, where there is one */
    OracleRun run;                          /* of the colour plane */
    CompareResult results[PLANE_KINDS];
    Settled settled;
    bool asked; /* whether anything was settled, or nothing had to be */
    SurfaceCheck surface;
    CompareResult exact_color;
    char *commands[8]; /* owned */
    size_t n_commands;
} Verification;

static void verification_release(Verification *v)
{
    scene_release(&v->scene);
    frame_release(&v->native);
    frame_release(&v->povray);
    frame_release(&v->exact);
    picture_release(&v->native_picture);
    picture_release(&v->povray_picture);
    picture_release(&v->native_shown);
    settled_release(&v->settled);
    picture_release(&v->povray_shown);
    for (size_t i = 0; i < v->n_commands; i++)
        free(v->commands[i]);
    free(v->name);
    if (v->lock >= 0)
        close(v->lock);
}

/* ---- the folder ------------------------------------------------------------------------------ */

/* All that a verification leaves. The verdict comes first: what is interrupted leaves none. */
static const char *const left[] = {
    "report.html",      "report.json",       "junit.xml",         "diff.png",
    "scene.pov",        "scene.inc",         "ids.pov",           "ids.inc",
    "povray.png",       "povray.depth.png",  "povray.normal.png", "povray.id.png",
    "povray.depth.pfm", "povray.normal.pfm", "povray.id.ppm",     "native.png",
    "native.depth.pfm", "native.normal.pfm", "native.id.ppm",     "exact.png",
    "exact.depth.pfm",  "exact.normal.pfm",  "exact.id.ppm"};

/* Does `what` with the path of each file of the folder. */
static Status for_all_files(const Verification *v, Files *files,
                            Status (*what)(Files *files, const char *path, Err *err), Err *err)
{
    for (size_t i = 0; i < sizeof left / sizeof *left; i++) {
        char *path = NULL;
        TRY(file_join(v->folder, left[i], &path, err));
        Status status = what(files, path, err);
        free(path);
        TRY(status);
    }
    return STATUS_OK;
}

static Status note_file(Files *files, const char *path, Err *err)
{
    return files_write(files, "-o", path, err);
}

static Status remove_file(Files *files, const char *path, Err *err)
{
    (void)files;
    if (unlink(path) == 0 || errno == ENOENT)
        return STATUS_OK;
    return err_set(err, STATUS_IO, "%s: cannot be removed: %s", path, strerror(errno));
}

/* Where the folder is there, keeps other verifications out of it until the end of the process, and
 * removes what an earlier one has left: an old verdict is none about this tree. A file system
 * without locks has none. */
static Status claim_folder(Verification *v, Files *files, Err *err)
{
    if (v->lock >= 0)
        return STATUS_OK;
    v->lock = open(v->folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (v->lock < 0)
        return errno == ENOENT ? STATUS_OK
                               : err_set(err, STATUS_IO, "%s: cannot be written to: %s", v->folder,
                                         strerror(errno));
    if (flock(v->lock, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        return err_set(err, STATUS_IO, "%s: another verification is writing to this folder",
                       v->folder);
    TRY(for_all_files(v, files, note_file, err));
    return for_all_files(v, files, remove_file, err);
}

/* ---- the two sides --------------------------------------------------------------------------- */

static bool takes_two_steps(const Verification *v)
{
    return models[v->scene.geometry.model].proof == PROOF_STEPS;
}

/* Whether POV-Ray needs a scene of its own to paint ids. */
static bool has_id_scene(const Verification *v)
{
    return model_has(v->scene.geometry.model, MODEL_FIELD);
}

static RenderParams render_params(const Verification *v, const CellParams *povray_cells)
{
    return (RenderParams){.kernels = v->kernels,
                          .threads = v->common->threads,
                          .antialias = v->picture->antialias,
                          .shadows = v->picture->stage.shadows,
                          .povray_cells = povray_cells,
                          .want_color = true,
                          .want_depth = true,
                          .want_normal = true,
                          .want_id = true};
}

static Status render_frame(Verification *v, const CellParams *povray_cells, Frame *frame, Err *err)
{
    Progress progress;
    RenderParams params = render_params(v, povray_cells);
    params.progress = progress_report;
    params.progress_context = &progress;
    progress_start(&progress, povray_cells ? "corcast, as POV-Ray" : "corcast", v->common->quiet);
    Status status = render(&v->scene, &params, frame, &v->stats, err);
    progress_end(&progress);
    return status;
}

static Encoding encoding_of(const Verification *v)
{
    return v->bits == 16 ? ENCODING_LINEAR : ENCODING_SRGB;
}

static Status write_frame(const Verification *v, const Frame *frame, const char *name,
                          Encoding encoding, const char *provenance, Err *err)
{
    char *path = NULL;
    TRY(file_join(v->folder, name, &path, err));
    Status status = frames_write(frame, path, v->bits, encoding, provenance, err);
    free(path);
    return status;
}

/* Of an isosurface, where POV-Ray's root finder sees it. */
static const CellParams *cells_of(const Verification *v)
{
    return takes_two_steps(v) ? &v->cells : NULL;
}

static Status render_native(Verification *v, const char *provenance, Err *err)
{
    TRY(render_frame(v, cells_of(v), &v->native, err));
    TRY(picture_from_plane(&v->native_picture, &v->native.color, encoding_of(v), v->bits, err));
    TRY(write_frame(v, &v->native, "native.png", encoding_of(v), provenance, err));
    if (!takes_two_steps(v))
        return STATUS_OK;
    TRY(render_frame(v, NULL, &v->exact, err));
    return write_frame(v, &v->exact, "exact.png", ENCODING_SRGB, provenance, err);
}

/* What a screen shows of linear codes. */
static Status show_both(Verification *v, Err *err)
{
    if (v->bits == 8)
        return STATUS_OK;
    TRY(picture_to_srgb(&v->povray_shown, &v->povray_picture, 8, err));
    return picture_to_srgb(&v->native_shown, &v->native_picture, 8, err);
}

static Status read_plane(Verification *v, OraclePlane plane, const char *path, Err *err)
{
    double near_mm, far_mm;
    camera_depth_range(&v->scene.view.camera, v->scene.geometry.bounds, &near_mm, &far_mm);
    switch (plane) {
    case ORACLE_COLOR:
        return picture_read(&v->povray_picture, path, err);
    case ORACLE_DEPTH:
        return oracle_read_depth(&v->povray.depth, path, near_mm, far_mm, err);
    case ORACLE_NORMAL:
        return oracle_read_normal(&v->povray.normal, path, err);
    case ORACLE_ID:
        return oracle_read_ids(&v->povray.id, path, err);
    }
    return STATUS_OK;
}

static Status run_oracle_plane(Verification *v, const char *scene, OraclePlane plane, Err *err)
{
    static const char *const names[] = {
        [ORACLE_COLOR] = "povray.png",
        [ORACLE_DEPTH] = "povray.depth.png",
        [ORACLE_NORMAL] = "povray.normal.png",
        [ORACLE_ID] = "povray.id.png",
    };
    static const char *const labels[] = {
        [ORACLE_COLOR] = "POV-Ray, picture",
        [ORACLE_DEPTH] = "POV-Ray, depth",
        [ORACLE_NORMAL] = "POV-Ray, normals",
        [ORACLE_ID] = "POV-Ray, ids",
    };
    char *path = NULL;
    TRY(file_join(v->folder, names[plane], &path, err));
    Progress progress;
    progress_start(&progress, labels[plane], v->common->quiet);
    OracleParams params = {.scene = scene,
                           .output = path,
                           .width = v->picture->size[0],
                           .height = v->picture->size[1],
                           .antialias = v->picture->antialias,
                           .threads = v->common->threads,
                           .plane = plane,
                           .bits = v->bits,
                           .progress = progress_report,
                           .progress_context = &progress};
    Status status = povray_from_environment(&params, err);
    if (status == STATUS_OK)
        status = oracle_command(&params, &v->commands[v->n_commands], err);
    if (status == STATUS_OK) {
        v->n_commands++;
        status = oracle_run(&params, plane == ORACLE_COLOR ? &v->run : NULL, err);
    }
    progress_end(&progress);
    if (status == STATUS_OK)
        status = read_plane(v, plane, path, err);
    if (status == STATUS_INPUT) /* of POV-Ray's making */
        status = STATUS_TOOL;
    free(path);
    return status;
}

/* Writes the scene; the ids of an implicit surface are painted in a scene of their own, as they
 * take most of it. */
static Status write_scene(Verification *v, bool ids, char **scene, Err *err)
{
    TRY(file_join(v->folder, ids ? "ids.pov" : "scene.pov", scene, err));
    const EmitParams params = {.scene = &v->scene,
                               .command = v->commands[0],
                               .shadows = v->picture->stage.shadows,
                               .ids = ids,
                               .cells = v->cells};
    return scene_files_write(emitter_find("pov", false), &params, v->tree, *scene, NULL, err);
}

static Status run_oracle(Verification *v, Err *err)
{
    char *scene = NULL, *ids = NULL;
    Status status = write_scene(v, false, &scene, err);
    if (status == STATUS_OK && has_id_scene(v))
        status = write_scene(v, true, &ids, err);
    for (int plane = ORACLE_COLOR; status == STATUS_OK && plane <= ORACLE_ID; plane++)
        status =
            run_oracle_plane(v, plane == ORACLE_ID && ids ? ids : scene, (OraclePlane)plane, err);
    free(scene);
    free(ids);
    char *picture = NULL;
    if (status == STATUS_OK)
        status = file_join(v->folder, "povray.png", &picture, err);
    if (status == STATUS_OK)
        status = frames_write(&v->povray, picture, 0, ENCODING_SRGB, NULL, err);
    free(picture);
    return status;
}

/* ---- the verdict ----------------------------------------------------------------------------- */

static const Picture *shown_by_povray(const Verification *v)
{
    return v->bits == 8 ? &v->povray_picture : &v->povray_shown;
}

static const Picture *shown_natively(const Verification *v)
{
    return v->bits == 8 ? &v->native_picture : &v->native_shown;
}

/* Asks who is right where the sides differ; the tolerance then knows. */
static Status settle_sides(Verification *v, const Rendering *a, const Rendering *b,
                           Tolerance *tolerance, Err *err)
{
    const RenderParams params = render_params(v, cells_of(v));
    const SettleCase asked = {&v->scene, &params, a, b, encoding_of(v), tolerance};
    v->asked = settle_applies(&asked);
    if (!v->asked)
        return STATUS_OK;
    TRY(settle_pixels(&asked, &v->settled, err));
    tolerance->settled = v->settled.marks;
    return STATUS_OK;
}

/* Whether vessels are seen whole: their mean breadth, twice the area over the outline, is at most a
 * quarter of the picture. Along an edge between pixels an outline is pi / 4 long
 * [Cauchy-Crofton]. */
static bool sees_whole_vessels(const IdPlane *ids)
{
    size_t width = (size_t)ids->width, height = (size_t)ids->height, seen = 0, sides = 0;
    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x++) {
            const uint32_t *id = &ids->ids[y * width + x];
            seen += *id != 0;
            sides += x + 1 < width && !id[0] != !id[1];
            sides += y + 1 < height && !id[0] != !id[width];
        }
    double side = (double)(width < height ? width : height);
    return 2 * (double)seen * 4 <= side * 0.785398163397448 * (double)sides;
}

/* Of a vessel from near by, POV-Ray's steps tilt all normals that are seen one way, by up to 0.1
 * degrees: what that makes of the colours averages out over the breadth of a vessel alone. */
static Tolerance exact_tolerance(const IdPlane *ids)
{
    Tolerance tolerance = tolerance_surface(0);
    tolerance.title = "exact color";
    if (sees_whole_vessels(ids))
        return tolerance;
    tolerance.gain = tolerance.offset_levels = tolerance.interior_ppm = (double)INFINITY;
    tolerance.segment_levels = tolerance.bias_levels = 1.5;
    return tolerance;
}

/* Holds where POV-Ray's root finder sees the surface against where it is. */
static Status check_surface(Verification *v, Err *err)
{
    const Frame *seen = &v->native, *exact = &v->exact;
    const SurfaceSight sight = {seen->depth.values, seen->normal.values, seen->id.ids};
    const SurfaceSight exact_sight = {exact->depth.values, exact->normal.values, exact->id.ids};
    Plane allowed = {0};
    TRY(plane_init(&allowed, seen->depth.width, seen->depth.height, 1, err));
    Status status = surface_tolerance(&v->scene.geometry, &v->scene.view.camera, v->cells.erf,
                                      &sight, &exact_sight, allowed.values, err);
    const SurfacePlanes planes = {&seen->depth, &exact->depth, &allowed};
    if (status == STATUS_OK)
        status = surface_check(&planes, &v->surface, err);
    plane_release(&allowed);
    return status;
}

/* Holds the colours of the surface where it is against POV-Ray's, as they are shown. */
static Status compare_exact(Verification *v, const Rendering *povray, Err *err)
{
    Picture picture;
    const Tolerance tolerance = exact_tolerance(&v->exact.id);
    TRY(picture_from_plane(&picture, &v->exact.color, ENCODING_SRGB, 8, err));
    Rendering a = *povray;
    a.picture = shown_by_povray(v);
    const Rendering b = {&picture, &v->exact.id, &v->exact.depth, &v->exact.normal};
    Status status = compare_pictures(&a, &b, &tolerance, &v->exact_color, NULL, err);
    picture_release(&picture);
    return status;
}

static Status compare_sides(Verification *v, Err *err)
{
    double near_mm, far_mm;
    camera_depth_range(&v->scene.view.camera, v->scene.geometry.bounds, &near_mm, &far_mm);
    Tolerance tolerance = tolerance_identity((far_mm - near_mm) / 65535);
    const IdPlane *a = &v->povray.id, *b = &v->native.id;
    const Rendering view_a = {&v->povray_picture, a, &v->povray.depth, &v->povray.normal};
    const Rendering view_b = {&v->native_picture, b, &v->native.depth, &v->native.normal};
    TRY(settle_sides(v, &view_a, &view_b, &tolerance, err));
    TRY(compare_pictures(&view_a, &view_b, &tolerance, &v->results[PLANE_COLOR], NULL, err));
    TRY(compare_perception(shown_by_povray(v), shown_natively(v), &v->results[PLANE_COLOR], err));
    if (!v->results[PLANE_COLOR].agrees)
        TRY(compare_cause(&v->povray_picture, &v->native_picture, &v->results[PLANE_COLOR], err));
    TRY(compare_planes(PLANE_DEPTH, &v->povray.depth, &v->native.depth, a, b, &tolerance,
                       &v->results[PLANE_DEPTH], err));
    TRY(compare_planes(PLANE_NORMAL, &v->povray.normal, &v->native.normal, a, b, &tolerance,
                       &v->results[PLANE_NORMAL], err));
    TRY(compare_ids(a, b, &tolerance, &v->results[PLANE_ID], err));
    if (!takes_two_steps(v))
        return STATUS_OK;
    TRY(compare_exact(v, &view_a, err));
    return check_surface(v, err);
}

static Status write_report(Verification *v, bool as_json, bool *agrees, Err *err)
{
    ReportCase report = {.name = v->name,
                         .model = models[v->scene.geometry.model].name,
                         .a = {.name = "POV-Ray",
                               .key = "povray",
                               .version = v->run.version,
                               .seconds = v->run.seconds,
                               .picture = shown_by_povray(v),
                               .ids = &v->povray.id,
                               .depth = &v->povray.depth,
                               .normal = &v->povray.normal},
                         .b = {.name = "corcast",
                               .key = "native",
                               .version = CORCAST_VERSION,
                               .seconds = v->stats.prepare_s + v->stats.trace_s,
                               .picture = shown_natively(v),
                               .ids = &v->native.id,
                               .depth = &v->native.depth,
                               .normal = &v->native.normal},
                         .commands = (const char *const *)v->commands,
                         .n_commands = v->n_commands};
    for (int kind = 0; kind < PLANE_KINDS; kind++)
        report.planes[kind] = &v->results[kind];
    report.surface = takes_two_steps(v) ? &v->surface : NULL;
    report.exact = takes_two_steps(v) ? &v->exact_color : NULL;
    report.settled = v->asked ? &v->settled : NULL;
    *agrees = report_agrees(&report);
    char *templates = NULL, *page = NULL;
    TRY(templates_folder(&templates, err));
    Status status = file_join(templates, "report", &page, err);
    if (status == STATUS_OK)
        status = report_write(&report, page, v->folder, err);
    if (status == STATUS_OK && as_json)
        status = json_write(report_json(&report), "-", err);
    free(templates);
    free(page);
    return status;
}

static void print_surface(const SurfaceCheck *surface)
{
    printf("  %-7s %-7s", "surface", surface->agrees ? "agree" : "differ");
    if (surface->agrees)
        printf("99 %% within %.3g mm, worst %.3g mm, %zu pixels graze\n", surface->p99_mm,
               surface->max_mm, surface->grazing);
    else
        printf("%s\n", surface->reason);
}

static void print_exact(const CompareResult *exact)
{
    printf("  %-7s %-7s", "exact", exact->agrees ? "agree" : "differ");
    if (exact->agrees)
        printf("gain %.6f, %zu of %zu pixels off by more than %g levels\n", exact->gain,
               exact->beyond_pixels, exact->common_pixels, exact->tolerance.color_levels);
    else
        printf("%s\n", exact->reason);
}

/* A line for each cause that was met, and for the first pixels where. */
static Status print_settled(const Settled *settled, Err *err)
{
    Text text = TEXT_INIT;
    for (SettledCause cause = settled->from; cause <= settled->to; cause++)
        if (settled->count[cause])
            text_printf(&text, "  %-7s %-7s%s: %zu, at most %zu allowed; corcast is right there\n",
                        "settled",
                        settled->count[cause] <= settled_allowed(settled, cause) ? "agree"
                                                                                 : "differ",
                        settled_cause_sentence(cause), settled->count[cause],
                        settled_allowed(settled, cause));
    for (int i = 0; i < settled->n_first && settled->from == SETTLED_ROOT; i++) {
        text_printf(&text, "                 %s ", settled_cause_name(settled->first[i].cause));
        settled_describe(&settled->first[i], "POV-Ray", "corcast", &text);
        text_puts(&text, "\n");
    }
    Status status = text_check(&text, err);
    if (status == STATUS_OK)
        fputs(text_chars(&text), stdout);
    text_release(&text);
    return status;
}

static Status print_verdict(const Verification *v, bool agrees, Err *err)
{
    for (int kind = 0; kind < PLANE_KINDS; kind++) {
        const CompareResult *result = &v->results[kind];
        printf("  %-7s %-7s", plane_kind_name((PlaneKind)kind),
               result->agrees ? "agree" : "differ");
        if (!result->agrees)
            printf("%s\n", result->reason);
        else if (kind == PLANE_DEPTH)
            printf("median %.3g mm, 99 %% within %.3g mm, worst %.3g mm\n", result->median,
                   result->p99, result->max);
        else if (kind == PLANE_NORMAL)
            printf("median %.3g deg, 99 %% within %.3g deg, worst %.3g deg\n", result->median,
                   result->p99, result->max);
        else
            printf("%zu of %zu pixels differ\n", result->differing_pixels, result->pixels);
    }
    if (v->asked)
        TRY(print_settled(&v->settled, err));
    if (takes_two_steps(v))
        print_surface(&v->surface);
    if (takes_two_steps(v))
        print_exact(&v->exact_color);
    printf("%s: POV-Ray %s in %.2f s, corcast in %.2f s; %s/report.html\n",
           agrees ? "agree" : "differ", v->run.version, v->run.seconds,
           v->stats.prepare_s + v->stats.trace_s, v->folder);
    return STATUS_OK;
}

typedef struct VerifyOptions {
    const char *folder;
    int bits;
    RenderKernels kernels;
    bool json;
    PictureOptions picture;
} VerifyOptions;

static const Option own[] = {
    {.name = "output",
     SETS(FOLDER, VerifyOptions, folder),
     .argument = "DIR",
     .is_told = true,
     .help = "folder for the report, the scene and all planes"},
    {.name = "bits",
     SETS(WHOLE, VerifyOptions, bits),
     .range = &bits_range,
     .group = GROUP_JUDGE,
     .argument = "8|16",
     .help = "of the colours compared: 8, sRGB, or 16, linear"},
    {.name = "kernels",
     SETS(CHOICE, VerifyOptions, kernels),
     .choices = render_kernel_names,
     .group = GROUP_RUN,
     .help = "instructions that the exact isosurface is drawn with, for tests"},
    {.name = "json", SETS(FLAG, VerifyOptions, json), .help = "the report on standard output"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static void set_defaults(void *options)
{
    VerifyOptions *own_options = options;
    picture_set_defaults(&own_options->picture);
    own_options->bits = 8;
    own_options->kernels = KERNELS_FASTEST;
}

static Status check(const VerifyOptions *options, const Parsed *parsed, Err *err)
{
    const PictureOptions *picture = &options->picture;
    if (strcmp(options->folder, "-") == 0)
        return err_set(err, STATUS_USAGE, "-o: a report is a folder, not standard output");
    TRY(bits_check(options->bits, err));
    TRY(picture_check_needs(picture, parsed, err));
    TRY(picture_check_povray(picture, err));
    return picture_fits(picture->size[0], picture->size[1], 120, err);
}

/* Reads the tree, makes the folder, draws both sides and compares them. */
static Status verify(Verification *v, Parsed *parsed, Err *err)
{
    char *line = NULL;
    TRY(claim_folder(v, &parsed->files, err));
    TRY(picture_scene(v->picture, parsed, &v->scene, NULL, err));
    v->cells = picture_cells(v->picture);
    TRY(file_make_folder(v->folder, err));
    TRY(claim_folder(v, &parsed->files, err));
    TRY(shown_name(v->tree, &v->name, err));
    TRY(command_line_text(parsed, &line, err));
    v->commands[v->n_commands++] = line;
    TRY(run_oracle(v, err));
    TRY(render_native(v, line, err));
    TRY(show_both(v, err));
    return compare_sides(v, err);
}

static Status run_verify(void *options, Parsed *parsed, Err *err)
{
    const VerifyOptions *own_options = options;
    Status status = STATUS_OK;
    bool agrees = false;
    Verification v = {.picture = &own_options->picture,
                      .common = &parsed->common,
                      .tree = parsed->operands[0],
                      .folder = own_options->folder,
                      .bits = own_options->bits,
                      .kernels = own_options->kernels,
                      .lock = -1};
    TRY(check(own_options, parsed, err));
    TRY_GOTO(verify(&v, parsed, err));
    TRY_GOTO(write_report(&v, own_options->json, &agrees, err));
    if (!own_options->json && !parsed->common.quiet)
        TRY_GOTO(print_verdict(&v, agrees, err));
    status = agrees ? STATUS_OK : STATUS_DIFFERS;
done:
    verification_release(&v);
    return status;
}

const Command command_verify = {
    .name = "verify",
    .summary = "prove that POV-Ray and the native renderer agree",
    .operands = "T.swc -o DIR",
    .examples = "  corcast verify tree.swc -o check\n"
                "  corcast verify tree.swc --model isosurface --size 400x400 -o check\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
    .size = sizeof(VerifyOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0},
               {&picture_table, offsetof(VerifyOptions, picture)},
               {&coloring_table, offsetof(VerifyOptions, picture.coloring)},
               {&blood_table, offsetof(VerifyOptions, picture.coloring.blood)}},
    .run = run_verify,
};
