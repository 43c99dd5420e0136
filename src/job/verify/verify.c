/* Runs the operation `verify`: draws a tree with corcast and with POV-Ray, compares the pictures,
 * and writes a report. This file opens the folder, makes the scene that is compared, and runs the
 * steps in order; verification.c has the steps. */
#include "job/verify/verify.h"

#include "emit/emit.h"
#include "job/picture/frames.h"
#include "job/verify/verify_folder.h"
#include "options/output.h"
#include "options/templates.h"
#include <stdlib.h>
#include <string.h>

static const char *const witnesses[] = {
    [WITNESS_NONE] = "none", [WITNESS_TACHYON] = "tachyon", NULL};

static const Option own[] = {
    {.name = "output",
     SETS(FOLDER, VerifyOptions, folder),
     .argument = "DIR",
     .is_told = true,
     .help = "folder to write to: the report, the POV-Ray scene, and the color, depth, normal "
             "and id images of both renderers; it is created if it does not exist"},
    {BEAT_OPTION(VerifyOptions, picture.beat)},
    {.name = "bits",
     SETS(WHOLE, VerifyOptions, bits),
     .range = &bits_range,
     .group = GROUP_JUDGE,
     .argument = "8|16",
     .help = "bits per channel of the two images that are compared: 8 (sRGB) or 16 (linear)"},
    {.name = "kernels",
     SETS(CHOICE, VerifyOptions, kernels),
     .choices = render_kernel_names,
     .group = GROUP_RUN,
     .help = "processor instructions to use, for tests only; all values give the same image. "
             "Values"},
    {.name = "witness",
     SETS(CHOICE, VerifyOptions, witness),
     .choices = witnesses,
     .group = GROUP_JUDGE,
     .help = "third program that also renders the scene: tachyon, or none. All programs must then "
             "agree on the visible segment of each pixel and on its depth"},
    {.name = "tiles",
     SETS(WHOLE, VerifyOptions, tiles),
     FROM_TO(1, 10000),
     .group = GROUP_RUN,
     .help = "minimum number of tiles that POV-Ray renders the image in; the scene of a tile has "
             "only the vessels that its rays can hit. A tile that does not fit in memory is "
             "divided further"},
    {.name = "json",
     SETS(FLAG, VerifyOptions, json),
     .help = "print the report as JSON on standard output"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static void set_defaults(void *options)
{
    VerifyOptions *verify_options = options;
    picture_set_defaults(&verify_options->picture);
    verify_options->bits = 8;
    verify_options->tiles = 1;
    verify_options->kernels = KERNELS_FASTEST;
    verify_options->povray.patience_s = verify_options->tachyon.patience_s = PROGRAM_PATIENCE_S;
}

/* Checks the options and the memory. A pixel has about 40 bytes in the planes of each side
 * [job/picture/render.c]; 120 leaves as much for the comparison. */
static Status check(const VerifyOptions *options, Err *err)
{
    const PictureOptions *picture = &options->picture;
    if (strcmp(options->folder, "-") == 0)
        return err_set(err, STATUS_USAGE,
                       "-o: a report is a folder and cannot be written to standard output");
    TRY(bits_check(options->bits, err));
    TRY(picture_check_povray(picture, err));
    if (picture->beat > 0 &&
        !model_is_of((SceneModel)picture->model, MODEL_CYLINDERS | MODEL_BALLS))
        return err_set(err, STATUS_USAGE, "--beat is for --model rounded and cylinders");
    if (options->witness == WITNESS_TACHYON)
        TRY(emit_check_model(emitter_find("tachyon", false), (SceneModel)picture->model, err));
    return picture_check_memory(picture->size.pixels[0], picture->size.pixels[1], 120, err);
}

/* Moves a camera that was not specified by a fraction of a pixel. In trees with integer
 * coordinates, outlines, cuts and equally near surfaces are exactly at pixel centres of a framed
 * picture. There the rounding of either renderer decides what is visible. Ties would remain if a
 * fraction, their sum or their difference were a multiple of the distance between antialiasing
 * samples, 1/N pixel. Up to N = 6 they are at least 0.07/N from a multiple. For N = 7 the sum,
 * 0.428, is close to 3/7. */
static void move_off_ties(Camera *camera)
{
    static const double right_px = 0.137, up_px = 0.291;
    camera->location =
        vec3_add(camera->location, vec3_add(vec3_scale(camera->right, right_px / camera->width),
                                            vec3_scale(camera->up, up_px / camera->height)));
}

/* Returns STATUS_INPUT if neither side shows a vessel: their agreement would prove nothing. */
static Status check_shows_something(const Verification *verification, Err *err)
{
    const CompareResult *ids = &verification->found.planes[PLANE_ID];
    if (ids->values[MEASURE_COMMON_PIXELS] + ids->values[MEASURE_MISSING_PIXELS] +
            ids->values[MEASURE_EXTRA_PIXELS] + ids->values[MEASURE_SETTLED_PIXELS] >
        0)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "neither POV-Ray nor corcast shows a vessel of %s in this view, so nothing can "
                   "be verified: the camera misses the tree, or the vessels are too small",
                   verification->tree);
}

/* Reads the tree, creates the folder, draws with both programs and compares. */
static Status verify(Verification *verification, VerifyFolder *folder, Parsed *parsed, Err *err)
{
    const PictureOptions *picture = &verification->options->picture;
    PictureOptions all_moments = *picture; /* POV-Ray's scene contains all moments */
    PictureReport made;
    all_moments.coloring.frame = 0;
    all_moments.omits_effects = true;
    TRY(verifyfolder_claim(folder, &parsed->files, err));
    TRY(picture_scene(&all_moments, parsed, &verification->scene, &made, err));
    TRY(picture_check_ids(&verification->scene.geometry, verification->tree, err));
    TRY(picture_report(&verification->scene, &made, parsed->common.talk, err));
    TRY(picture_report_effects(&all_moments, "both pictures omit them", parsed->common.talk, err));
    if (!picture->stage.has_location)
        move_off_ties(&verification->scene.view.camera);
    verification->has_alpha = verification->scene.view.transparent;
    verification->scene.view.transparent = false; /* shown in front of the look's background */
    TRY(verification_pick_frame(verification, picture->coloring.frame, err));
    TRY(file_make_folder(verification->options->folder, err));
    TRY(verifyfolder_claim(folder, &parsed->files, err));
    TRY(shown_name(verification->tree, &verification->name, err));
    TRY(verification_draw(verification, err));
    TRY(verification_compare(verification, err));
    return check_shows_something(verification, err);
}

static Status write_report(Verification *verification, Err *err)
{
    const ReportCase report = verification_report(verification);
    char *page = NULL;
    verification->agrees = report_agrees(&report);
    TRY(templates_path("report", &page, err));
    Status status = report_write(&report, page, verification->options->folder, err);
    free(page);
    return status;
}

Status verify_run(VerifyOptions *options, Parsed *parsed, Verification *result, Err *err)
{
    Verification verification = {
        .options = options, .common = &parsed->common, .tree = parsed->operands[0]};
    VerifyFolder folder = {options->folder, -1};
    char *command = NULL;
    Status status;
    TRY_GOTO(check(options, err));
    TRY_GOTO(command_line_text(parsed, &command, err));
    TRY_GOTO(verification_add_command(&verification, command, err));
    TRY_GOTO(verify(&verification, &folder, parsed, err));
    TRY_GOTO(write_report(&verification, err));
    *result = verification;
    verification = (Verification){0};
done:
    free(command);
    verifyfolder_release(&folder);
    verification_release(&verification);
    return status;
}

const Command command_verify = {
    .name = "verify",
    .summary = "check that corcast and POV-Ray draw a tree alike",
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
