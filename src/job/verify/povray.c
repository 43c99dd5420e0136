/* Runs the operation `povray`: draws a scene file by POV-Ray, with the same switches as `verify`
 * does. */
#include "job/verify/povray.h"

#include "job/picture/frames.h"
#include "job/picture/picture.h"
#include "options/talk.h"
#include "options/templates.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Reads the size from the comment "// Size: WxH" of a scene that corcast has written. */
static Status size_of_scene(const char *path, PictureSize *size, Err *err)
{
    static const FileForm form = {.name = "a scene", .most_bytes = 4e9, .is_text = true};
    char *text = NULL;
    size_t length;
    int *side = size->pixels;
    TRY(file_read(path, &form, &text, &length, err));
    const char *line = strstr(text, "// Size: ");
    bool found = line && sscanf(line, "// Size: %dx%d", &side[0], &side[1]) == 2 && side[0] > 0 &&
                 side[1] > 0 && side[0] <= IMAGE_MAX_SIDE && side[1] <= IMAGE_MAX_SIDE;
    free(text);
    if (found)
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "%s has no line '// Size: WxH'; give the size with --size",
                   path);
}

static const char *const planes[] = {"color", "depth", "normal", "id", "depth-id", NULL};

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, PovrayOptions, output),
     .argument = "P.png",
     .help = "image to write"},
    {.name = "size",
     SETS(SIZE, PovrayOptions, size),
     GIVEN(PovrayOptions, has_size),
     FROM_TO(1, IMAGE_MAX_SIDE),
     .group = GROUP_CAMERA,
     .otherwise = "from the scene",
     .help = "size of the image: in pixels (800x600), or on paper with a unit (89mmx60mm; mm, "
             "cm, in or pt), which --dpi converts to pixels; one length with a unit gives a "
             "square (89mm). An image with other proportions than those of the scene is stretched"},
    {DPI_OF_SIZE(PovrayOptions, size), .group = GROUP_CAMERA, .when = WHEN(ON_PAPER),
     .help = "pixels per inch, for a --size on paper only"},
    {.name = "antialias",
     SETS(WHOLE, PovrayOptions, antialias),
     .range = &antialias_range,
     .group = GROUP_LIGHT,
     .when = WHEN(COLOR_PLANE),
     .help = "number of samples per pixel, N x N; 1 turns antialiasing off"},
    {.name = "bits",
     SETS(WHOLE, PovrayOptions, bits),
     .range = &bits_range,
     .argument = "8|16",
     .when = WHEN(COLOR_PLANE),
     .help = "bits per channel: 8 (sRGB) or 16 (linear)"},
    {.name = "alpha",
     SETS(FLAG, PovrayOptions, alpha),
     .group = GROUP_LIGHT,
     .when = WHEN(COLOR_PLANE),
     .help = "write transparency. The background is transparent only in a scene that `corcast "
             "scene --background none` has written; the image of another scene is opaque"},
    {.name = "plane",
     SETS(CHOICE, PovrayOptions, plane),
     .choices = planes,
     .help = "data that the pixels show: color (the usual image), depth (distance from the "
             "camera), normal (direction of the surface), id (number of the segment), depth-id "
             "(depth in red and green, id in blue). All except color need a scene that `corcast "
             "scene` has written; docs/POVRAY.md, section 6, describes how colors encode the data"},
};

static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    (void)parsed;
    const PovrayOptions *options = set;
    return UNLESS(options->plane == POVRAY_COLOR, COLOR_PLANE) |
           UNLESS(size_is_on_paper(&options->size), ON_PAPER);
}

static const OptionTable own_table = {OPTION_ROWS(own), .unmet = unmet};

static void set_defaults(void *options)
{
    *(PovrayOptions *)options = (PovrayOptions){
        .antialias = 1, .bits = 8, .plane = POVRAY_COLOR, .program.patience_s = PROGRAM_PATIENCE_S};
}

/* Checks the options, and finds the size of the picture. */
static Status check(PovrayOptions *options, const Parsed *parsed, Err *err)
{
    if (strcmp(file_extension(options->output), "png") != 0)
        return err_set(err, STATUS_USAGE, "-o: '%s' does not end in .png", options->output);
    TRY(bits_check(options->bits, err));
    TRY(file_check_regular(parsed->operands[0], err));
    return options->has_size ? STATUS_OK : size_of_scene(parsed->operands[0], &options->size, err);
}

Status povray_run(PovrayOptions *options, Parsed *parsed, PovrayRun *run, Err *err)
{
    Progress progress;
    char *planes_file = NULL;
    TRY(check(options, parsed, err));
    if (options->plane != POVRAY_COLOR)
        TRY(templates_path("povray/planes.inc", &planes_file, err));
    const PovrayParams params = {.program = options->program,
                                 .scene = parsed->operands[0],
                                 .planes = planes_file,
                                 .output = options->output,
                                 .width = options->size.pixels[0],
                                 .height = options->size.pixels[1],
                                 .antialias = options->antialias,
                                 .threads = parsed->common.threads,
                                 .plane = options->plane,
                                 .bits = options->bits,
                                 .alpha = options->alpha,
                                 .progress = progress_report,
                                 .progress_context = &progress};
    progress_start(&progress, "POV-Ray", parsed->common.talk);
    Status status = povray_draw(&params, run, err);
    progress_end(&progress);
    free(planes_file);
    if (status == STATUS_OK)
        talk_note(parsed->common.talk, "POV-Ray %s took %.1f s", run->version, run->seconds);
    return status;
}

const Command command_povray = {
    .name = "povray",
    .summary = "run POV-Ray on a scene",
    .operands = "S.pov -o P.png",
    .examples =
        "  corcast povray tree.pov -o tree.png\n"
        "  corcast povray tree.pov --size 4000x4000 --antialias 3 -o large.png\n"
        "  corcast povray tree.pov --plane depth -o depth.png\n"
        "\nenvironment variables, also for verify:\n"
        "  CORCAST_POVRAY           POV-Ray program, or a script that replaces it (default: "
        "povray)\n"
        "  CORCAST_POVRAY_PATIENCE  stop POV-Ray after this many seconds without "
        "output; 0: never\n                           (default: 600)\n"
        "  CORCAST_TACHYON          Tachyon program for verify --witness tachyon, stopped after "
        "the same\n                           time (default: tachyon)\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
    .size = sizeof(PovrayOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0}},
};
