/* What a verification leaves: a folder with the scene, all planes and the report, and its verdict
 * as text. */
#include "cli/commands.h"
#include "emit/emit.h"
#include "job/picture/frames.h"
#include "job/verify/verification.h"
#include "options/output.h"
#include "options/templates.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

/* ---- the folder ------------------------------------------------------------------------------ */

/* All that a verification leaves. The verdict comes first: what is interrupted leaves none. */
static const char *const left[] = {
    "report.html",         "report.json",      "junit.xml",         "diff.png",
    "scene.pov",           "scene.inc",        "ids.pov",           "ids.inc",
    "povray.png",          "povray.depth.png", "povray.normal.png", "povray.id.png",
    "povray.depth-id.png", "povray.alpha.png", "povray.depth.pfm",  "povray.normal.pfm",
    "povray.id.ppm",       "native.png",       "native.depth.pfm",  "native.normal.pfm",
    "native.id.ppm",       "exact.png",        "exact.depth.pfm",   "exact.normal.pfm",
    "exact.id.ppm",        "scene.tachyon",    "tachyon.depth.ppm", "tachyon.id.ppm"};

/* Likewise those of tiles, by the beginnings of their names. */
static const char *const left_of_tiles[] = {
    "scene.tile-",         "ids.tile-",       "povray.tile-",         "povray.depth.tile-",
    "povray.normal.tile-", "povray.id.tile-", "povray.depth-id.tile-"};

/* Where a verification writes to. */
typedef struct Folder {
    const char *path;
    int lock; /* the folder, locked, or -1 */
} Folder;

/* Does `what` with the path of each file of the folder. */
static Status for_all_files(const Folder *folder, Files *files,
                            Status (*what)(Files *files, const char *path, Err *err), Err *err)
{
    for (size_t i = 0; i < sizeof left / sizeof *left; i++) {
        char *path = NULL;
        TRY(file_join(folder->path, left[i], &path, err));
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

static bool is_of_tile(const char *name)
{
    for (size_t i = 0; i < sizeof left_of_tiles / sizeof *left_of_tiles; i++)
        if (strncmp(name, left_of_tiles[i], strlen(left_of_tiles[i])) == 0)
            return true;
    return false;
}

/* Removes what tiles have left. */
static Status remove_tiles(const Folder *folder, Err *err)
{
    DIR *entries = opendir(folder->path);
    Status status = STATUS_OK;
    if (!entries)
        return err_set(err, STATUS_IO, "%s: cannot be read: %s", folder->path, strerror(errno));
    for (const struct dirent *entry; status == STATUS_OK && (entry = readdir(entries));) {
        char *path = NULL;
        if (!is_of_tile(entry->d_name))
            continue;
        status = file_join(folder->path, entry->d_name, &path, err);
        if (status == STATUS_OK)
            status = remove_file(NULL, path, err);
        free(path);
    }
    closedir(entries);
    return status;
}

/* Where the folder is there, keeps other verifications out of it until the end of the process, and
 * removes what an earlier one has left: an old verdict is none about this tree. A file system
 * without locks has none. */
static Status claim_folder(Folder *folder, Files *files, Err *err)
{
    if (folder->lock >= 0)
        return STATUS_OK;
    folder->lock = open(folder->path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder->lock < 0)
        return errno == ENOENT ? STATUS_OK
                               : err_set(err, STATUS_IO, "%s: cannot be written to: %s",
                                         folder->path, strerror(errno));
    if (flock(folder->lock, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        return err_set(err, STATUS_IO, "%s: another verification is writing to this folder",
                       folder->path);
    TRY(for_all_files(folder, files, note_file, err));
    TRY(for_all_files(folder, files, remove_file, err));
    return remove_tiles(folder, err);
}

/* ---- the verdict ------------------------------------------------------------------------------
 */

static Status write_report(Verification *v, bool as_json, bool *agrees, Err *err)
{
    ReportCase report = {.name = v->name,
                         .model = models[v->scene.geometry.model].name,
                         .a = {.name = "POV-Ray",
                               .key = "povray",
                               .version = v->run.version,
                               .seconds = v->run.seconds,
                               .tiles = v->n_tiles,
                               .picture = verification_shown_by_povray(v),
                               .ids = &v->povray.id,
                               .depth = &v->povray.depth,
                               .normal = &v->povray.normal},
                         .b = {.name = "corcast",
                               .key = "native",
                               .version = CORCAST_VERSION,
                               .seconds = v->stats.prepare_s + v->stats.trace_s,
                               .picture = verification_shown_natively(v),
                               .ids = &v->native.id,
                               .depth = &v->native.depth,
                               .normal = &v->native.normal},
                         .commands = (const char *const *)v->commands,
                         .n_commands = v->n_commands};
    for (int kind = 0; kind < PLANE_KINDS; kind++)
        report.planes[kind] = &v->results[kind];
    report.surface = verification_takes_two_steps(v) ? &v->surface : NULL;
    report.alpha = v->has_alpha ? &v->alpha : NULL;
    report.exact = verification_takes_two_steps(v) ? &v->exact_color : NULL;
    report.settled = v->asked ? &v->settled : NULL;
    report.witness = v->asks_witness ? &v->witness : NULL;
    *agrees = report_agrees(&report);
    char *page = NULL;
    TRY(templates_path("report", &page, err));
    Status status = report_write(&report, page, v->folder, err);
    if (status == STATUS_OK && as_json)
        status = json_write(report_json(&report), "-", err);
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
    if (v->has_alpha && v->alpha.agrees)
        printf("  %-7s %-7s%zu of %zu pixels differ\n", "alpha", "agree", v->alpha.differing_pixels,
               v->alpha.pixels);
    else if (v->has_alpha)
        printf("  %-7s %-7s%s\n", "alpha", "differ", v->alpha.reason);
    if (v->asked)
        TRY(print_settled(&v->settled, err));
    if (verification_takes_two_steps(v))
        print_surface(&v->surface);
    if (verification_takes_two_steps(v))
        print_exact(&v->exact_color);
    if (v->asks_witness)
        printf("  %-7s %-7s%s\n", "witness", v->witness.agrees ? "agree" : "differ",
               v->witness.sentence);
    char tiles[40] = "";
    if (v->n_tiles > 1)
        snprintf(tiles, sizeof tiles, " of %zu tiles", v->n_tiles);
    printf("%s: POV-Ray %s in %.2f s%s, corcast in %.2f s; %s/report.html\n",
           agrees ? "agree" : "differ", v->run.version, v->run.seconds, tiles,
           v->stats.prepare_s + v->stats.trace_s, v->folder);
    return STATUS_OK;
}

/* Who else draws the scene. */
typedef enum WitnessChoice { NO_WITNESS, WITNESS_TACHYON } WitnessChoice;
static const char *const witnesses[] = {[NO_WITNESS] = "none", [WITNESS_TACHYON] = "tachyon", NULL};

typedef struct VerifyOptions {
    const char *folder;
    int bits;
    RenderKernels kernels;
    WitnessChoice witness;
    int tiles;
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
    {.name = "witness",
     SETS(CHOICE, VerifyOptions, witness),
     .choices = witnesses,
     .group = GROUP_JUDGE,
     .help = "a third program that draws the scene: what is seen where and how far away must be "
             "the same in all three"},
    {.name = "tiles",
     SETS(WHOLE, VerifyOptions, tiles),
     FROM_TO(1, 10000),
     .group = GROUP_RUN,
     .help = "POV-Ray draws the picture in so many parts at least, each from a scene of what its "
             "rays can meet; in more where it can hold no more"},
    {.name = "json", SETS(FLAG, VerifyOptions, json), .help = "the report on standard output"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static void set_defaults(void *options)
{
    VerifyOptions *own_options = options;
    picture_set_defaults(&own_options->picture);
    own_options->bits = 8;
    own_options->tiles = 1;
    own_options->kernels = KERNELS_FASTEST;
}

static Status check(const VerifyOptions *options, Err *err)
{
    const PictureOptions *picture = &options->picture;
    if (strcmp(options->folder, "-") == 0)
        return err_set(err, STATUS_USAGE, "-o: a report is a folder, not standard output");
    TRY(bits_check(options->bits, err));
    TRY(picture_check_povray(picture, err));
    if (options->witness == WITNESS_TACHYON)
        TRY(emit_check_model(emitter_find("tachyon", false), (SceneModel)picture->model, err));
    return picture_fits(picture->size.pixels[0], picture->size.pixels[1], 120, err);
}

/* Moves a camera that was not given by a fraction of a pixel. Trees on integers have outlines, cuts
 * and equally near surfaces that a framed picture puts exactly at pixel centres, where the rounding
 * of either renderer decides what is seen. The fractions are not near a multiple of the distance
 * between samples of antialiasing, and neither are their sum and their difference. */
static void move_off_ties(Camera *camera)
{
    static const double right_px = 0.137, up_px = 0.291;
    camera->location =
        vec3_add(camera->location, vec3_add(vec3_scale(camera->right, right_px / camera->width),
                                            vec3_scale(camera->up, up_px / camera->height)));
}

/* Returns STATUS_INPUT if neither side shows a vessel: their agreement would prove nothing. */
static Status check_shows_something(const Verification *v, Err *err)
{
    const CompareResult *ids = &v->results[PLANE_ID];
    if (ids->common_pixels + ids->missing_pixels + ids->extra_pixels + ids->settled_pixels > 0)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "neither POV-Ray nor corcast shows a vessel of %s in this view, so nothing is "
                   "verified: the camera looks past the tree, or the vessels are too small to be "
                   "drawn",
                   v->tree);
}

/* Reads the tree, makes the folder, draws both sides and compares them. */
static Status verify(Verification *v, int frame, Folder *folder, Parsed *parsed, Err *err)
{
    TRY(claim_folder(folder, &parsed->files, err));
    PictureReport made;
    TRY(picture_scene(v->picture, parsed, &v->scene, &made, err));
    TRY(picture_check_ids(&v->scene.geometry, parsed->operands[0], err));
    TRY(picture_say(&v->scene, &made, parsed->common.talk, err));
    TRY(picture_say_effects(v->picture, &v->scene.view, "left out on both sides",
                            parsed->common.talk, err));
    v->scene.view.effects = (Effects){0};
    if (!v->picture->stage.has_location)
        move_off_ties(&v->scene.view.camera);
    v->has_alpha = v->scene.view.transparent;
    v->scene.view.transparent = false; /* shown over the look's background */
    TRY(verification_pick_frame(v, frame, err));
    TRY(file_make_folder(v->folder, err));
    TRY(claim_folder(folder, &parsed->files, err));
    TRY(shown_name(v->tree, &v->name, err));
    TRY(verification_draw(v, err));
    TRY(verification_compare(v, err));
    return check_shows_something(v, err);
}

Status run_verify(void *options, Parsed *parsed, Err *err)
{
    VerifyOptions *own_options = options;
    Status status = STATUS_OK;
    bool agrees = false;
    char **command;
    const int frame = own_options->picture.coloring.frame;
    Verification v = {.picture = &own_options->picture,
                      .common = &parsed->common,
                      .tree = parsed->operands[0],
                      .folder = own_options->folder,
                      .bits = own_options->bits,
                      .least_tiles = own_options->tiles,
                      .kernels = own_options->kernels,
                      .asks_witness = own_options->witness == WITNESS_TACHYON};
    Folder folder = {own_options->folder, -1};
    TRY(check(own_options, err));
    TRY_GOTO(verification_add_command(&v, &command, err));
    TRY_GOTO(command_line_text(parsed, command, err));
    own_options->picture.coloring.frame = 0; /* the scene for POV-Ray has all */
    TRY_GOTO(verify(&v, frame, &folder, parsed, err));
    TRY_GOTO(write_report(&v, own_options->json, &agrees, err));
    if (!own_options->json && !parsed->common.quiet)
        TRY_GOTO(print_verdict(&v, agrees, err));
    status = agrees ? STATUS_OK : STATUS_DIFFERS;
done:
    if (folder.lock >= 0)
        close(folder.lock);
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
    .reads_tree = true,
    .size = sizeof(VerifyOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0}, PICTURE_TABLES(VerifyOptions, picture)},
};
