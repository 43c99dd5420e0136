/* Runs the operation `answer`: makes the scene of a tree, lets the module answer prove bounds of
 * each pixel's color, and writes them to an OpenEXR file [docs/ANSWERS.md]. The scene is that of
 * `verify`, but the camera is not moved. Lengths, colors and lights are therefore those that
 * `render` draws. */
#include "job/verify/answer.h"

#include "options/output.h"
#include "options/talk.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The geometries that have answers. */
enum { BODY_CYLINDERS, BODY_JOINED, BODY_ROUNDED, BODY_ISOSURFACE, BODY_BLOB, BODY_MESH };
static const char *const bodies[] = {[BODY_CYLINDERS] = "cylinders",
                                     [BODY_JOINED] = "joined",
                                     [BODY_ROUNDED] = "rounded",
                                     [BODY_ISOSURFACE] = "isosurface",
                                     [BODY_BLOB] = "blob",
                                     [BODY_MESH] = "mesh",
                                     NULL};

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, AnswerOptions, output),
     .argument = "A.exr",
     .help = "OpenEXR file to write: a lower and an upper bound of the color of each pixel, for "
             "`corcast compare`"},
    {.name = "pattern",
     SETS(WHOLE, AnswerOptions, pattern),
     GIVEN(AnswerOptions, has_pattern),
     FROM_TO(1, ANSWER_MAX_PATTERN),
     .help = "number of samples per pixel. The color of a pixel is the mean of N x N samples and "
             "one at the center, which `corcast render --exact --antialias N` and POV-Ray's +A0.0 "
             "+AM1 +RN also draw; 1 takes only the sample at the center"},
    {.name = "area",
     SETS(FLAG, AnswerOptions, area),
     .excludes = "pattern",
     .clash = " are two definitions of the answer; use only one",
     .help = "define the color of a pixel as the mean over its whole area, instead of over the "
             "samples of --pattern"},
    {.name = "width",
     SETS(TEXT, AnswerOptions, width),
     .argument = "W",
     .help = "maximum width of the interval between the two bounds of a pixel that counts as "
             "decided, in sRGB values of 0 to 1. W is a number from 1e-12 to 1, or a fraction; "
             "1/510 is half a level of 8 bits"},
    {.name = "leaves",
     SETS(WHOLE, AnswerOptions, leaves),
     FROM_TO(1, 10000000),
     .needs = "area",
     .help = "maximum number of parts into which --area divides a pixel. A pixel that needs more "
             "parts keeps a wide interval, and counts as undecided if the interval is wider than "
             "--width"},
    {.name = "filter",
     SETS(NUMBER, AnswerOptions, filter),
     .argument = "PX",
     FROM_TO(1, 2),
     .needs = "area",
     .excludes = "certificate",
     .clash = " cannot be combined: a certificate needs a filter that is 1 pixel wide",
     .help = "with --area: width of the renderer's box filter, in pixels: the color of a pixel is "
             "the mean over a square of this width around its center. 1 is the area of the pixel "
             "itself"},
    {.name = "certificate",
     SETS(OUTPUT, AnswerOptions, certificate),
     .argument = "C.json",
     .help = "JSON file to write, for a checker that shares no code with corcast: the numbers of "
             "the scene, and the claims that prove the bounds of up to 24 pixels"},
    {.name = "squares",
     SETS(FLAG, AnswerOptions, squares),
     .needs = "area",
     .help = "with --area, for tests only: compute the intervals by a second, slower method, "
             "which divides pixels into squares. The intervals of both methods must overlap"},
    {.name = "model",
     SETS(CHOICE, AnswerOptions, body),
     .choices = bodies,
     .group = GROUP_VESSELS,
     .help = "vessel geometry: cylinders (one closed cylinder per segment), joined (cylinders "
             "connected by straight-sided transitions), rounded (cylinders with spheres where "
             "they meet or end), isosurface (smoothly blended surface), blob (POV-Ray's quick "
             "approximation of isosurface), mesh (isosurface as triangles). --area needs "
             "cylinders, rounded or mesh"},
    {.name = "background",
     SETS(COLOR, AnswerOptions, picture.background),
     GIVEN(AnswerOptions, picture.has_background),
     .group = GROUP_LIGHT,
     .otherwise = "set by --look",
     .help = "background color: a CSS name, #RRGGBB, or R,G,B each 0..1"},
};

static Status settle(void *set, const Parsed *parsed, Err *err)
{
    AnswerOptions *options = set;
    (void)parsed, (void)err;
    options->picture.model = 0;
    while (strcmp(model_names[options->picture.model], bodies[options->body]) != 0)
        options->picture.model++;
    return STATUS_OK;
}

static const OptionTable own_table = {OPTION_ROWS(own), .settle = settle};

/* The default width is half a level of 8 bits: an interval of this width contains at most two
 * codes. Reason of 20,000 parts not recorded; larger: fewer undecided pixels, more time. */
static void set_defaults(void *options)
{
    AnswerOptions *own_options = options;
    picture_set_defaults(&own_options->picture);
    own_options->body = BODY_ROUNDED;
    own_options->pattern = 1;
    own_options->width = "1/510";
    own_options->leaves = 20000;
    own_options->filter = 1;
}

/* Reads a number or a fraction of two numbers. */
static Status read_width(const char *text, double *width, Err *err)
{
    char *end;
    const double first = strtod(text, &end);
    const double second = *end == '/' ? strtod(end + 1, &end) : 1;
    *width = first / second;
    if (*end == '\0' && end > text && *width >= 1e-12 && *width <= 1)
        return STATUS_OK;
    return err_set(err, STATUS_USAGE,
                   "--width is '%s'; it must be a number or a fraction from 1e-12 to 1, such as "
                   "1/510",
                   text);
}

/* Checks the options that the tables cannot check. The 8 bytes per pixel beside the channels are an
 * allowance for the rest. */
static Status check(const AnswerOptions *options, Err *err)
{
    const PictureOptions *picture = &options->picture;
    const char *extension = file_extension(options->output);
    if (strcmp(extension, "exr") != 0)
        return err_set(err, STATUS_USAGE, "-o: '%s' does not end in .exr", options->output);
    if (picture->occlusion > 0)
        return err_set(err, STATUS_USAGE,
                       "--%s: no bounds can be proved for ambient occlusion, because it is "
                       "defined by a method of sampling; give --ao 0",
                       picture->has_occlusion ? "ao" : "look");
    return picture_check_memory(picture->size.pixels[0], picture->size.pixels[1],
                                ANSWER_CHANNELS * sizeof(float) + 8, err);
}

/* Writes the bounds and, as notes of the file, how they were made. docs/ANSWERS.md defines the
 * names of channels and notes. */
static Status write(const AnswerOptions *options, const Parsed *parsed, const Answer *answer,
                    const char *command, Err *err)
{
    static const ImageChannel channels[ANSWER_CHANNELS] = {
        {"lo.R", true}, {"lo.G", true},    {"lo.B", true}, {"hi.R", true}, {"hi.G", true},
        {"hi.B", true}, {"state.V", true}, {"id.V", true}, {"Z.lo", true}, {"Z.hi", true}};
    char pattern[16] = "area";
    if (!options->area)
        snprintf(pattern, sizeof pattern, "%d", options->pattern);
    const ImageNote notes[] = {{"Software", GENERATOR},
                               {"Comment", command},
                               {"answer", pattern},
                               {"answerWidth", options->width},
                               {"answerScene", answer->scene.hex}};
    const ImageNotes all = {.notes = notes, .count = sizeof notes / sizeof *notes};
    const ImageForm form = {.width = answer->plane.width,
                            .height = answer->plane.height,
                            .channels = ANSWER_CHANNELS,
                            .bits = 32,
                            .encoding = ENCODING_LINEAR,
                            .notes = &all,
                            .packing = {.threads = parsed->common.threads},
                            .named = channels};
    ImageWriter *writer;
    TRY(imagewriter_open(&writer, options->output, &form, err));
    const Status status = imagewriter_floats(writer, &answer->plane, err);
    if (status == STATUS_OK)
        return imagewriter_commit(writer, err);
    imagewriter_discard(writer);
    return status;
}

static Status make(AnswerOptions *options, Parsed *parsed, Answer *answer, Text *certificate,
                   Err *err)
{
    PictureReport made;
    Scene scene;
    Progress progress;
    AnswerParams params = {.pattern = options->area ? 0 : options->pattern,
                           .leaves = options->leaves,
                           .filter = options->filter,
                           .squares = options->squares,
                           .certified = 24, /* pixels; the help of --certificate states it */
                           .certificate = options->certificate ? certificate : NULL,
                           .shadows = options->picture.stage.shadows,
                           .threads = parsed->common.threads,
                           .progress = progress_report,
                           .progress_context = &progress};
    TRY(read_width(options->width, &params.width, err));
    TRY(picture_scene(&options->picture, parsed, &scene, &made, err));
    Status status = picture_check_ids(&scene.geometry, parsed->operands[0], err);
    if (status == STATUS_OK)
        status = picture_report(&scene, &made, parsed->common.talk, err);
    if (status == STATUS_OK) {
        progress_start(&progress, "proving", parsed->common.talk);
        status = answer_make(&scene, &params, answer, err);
        progress_end(&progress);
    }
    scene_release(&scene);
    return status;
}

json_t *answer_json(const AnswerReport *report)
{
    return JSON_OBJECT({"pixels", json_count(report->pixels)},
                       {"undecided", json_count(report->undecided)},
                       {"rays", json_count(report->beams)}, {"cpu_s", json_number(report->cpu_s)},
                       {"scene", json_text(report->scene.hex)});
}

Status answer_run(AnswerOptions *options, Parsed *parsed, AnswerReport *report, Err *err)
{
    const double start_s = clock_cpu_seconds();
    Answer answer = {0};
    char *command = NULL;
    Text certificate = TEXT_INIT;
    Status status;
    TRY(check(options, err));
    TRY_GOTO(command_line_text(parsed, &command, err));
    TRY_GOTO(make(options, parsed, &answer, &certificate, err));
    if (options->certificate)
        TRY_GOTO(file_write_text(options->certificate, &certificate, err));
    TRY_GOTO(write(options, parsed, &answer, command, err));
    *report = (AnswerReport){.pixels = (size_t)answer.plane.width * (size_t)answer.plane.height,
                             .undecided = answer.undecided,
                             .beams = answer.beams,
                             .cpu_s = clock_cpu_seconds() - start_s,
                             .scene = answer.scene};
done:
    free(command);
    text_release(&certificate);
    answer_release(&answer);
    return status;
}

const Command command_answer = {
    .name = "answer",
    .summary = "prove bounds for the color of each pixel of a picture",
    .operands = "T.swc -o A.exr",
    .examples = "  corcast answer tree.swc --pattern 3 -o tree.answer.exr\n"
                "  corcast render tree.swc --exact --antialias 3 -o tree.png\n"
                "  corcast compare tree.answer.exr tree.png\n"
                "\nThe command computes, for each pixel, two bounds that certainly contain its "
                "color. `corcast\ncompare A.exr picture.png` counts the pixels outside their "
                "bounds. The picture must be\ndrawn with the same sample points in each pixel as "
                "the answer. For --pattern N, draw it\nwith `corcast render --exact --antialias "
                "N`, or with POV-Ray and +A0.0 +AM1 +RN.\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
    .reads_tree = true,
    .without = "model background antialias color-blend erf cell-beta",
    .size = sizeof(AnswerOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0}, PICTURE_TABLES(AnswerOptions, picture)},
};
