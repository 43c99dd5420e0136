/* POV-Ray with the switches that `verify` gives it, on any scene; the size is what a scene of ours
 * asks for in its header. */
#include "cli/commands.h"
#include "job/export/scenefiles.h"
#include "job/picture/frames.h"
#include "job/picture/picture.h"
#include "options/options.h"
#include "options/talk.h"
#include "oracle/oracle.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The size that the scene's "// Size: WxH" comment asks for. */
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
    return err_set(err, STATUS_USAGE, "%s has no line '// Size: WxH'; give --size", path);
}

typedef struct PovrayOptions {
    const char *output;
    PictureSize size;
    bool has_size;
    int antialias, bits;
    bool alpha;
    OraclePlane plane;
} PovrayOptions;

static const char *const planes[] = {"color", "depth", "normal", "id", "depth-id", NULL};

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, PovrayOptions, output),
     .argument = "P.png",
     .help = "the picture"},
    {.name = "size",
     SETS(SIZE, PovrayOptions, size),
     GIVEN(PovrayOptions, has_size),
     FROM_TO(1, IMAGE_MAX_SIDE),
     .group = GROUP_CAMERA,
     .otherwise = "what the scene says",
     .help = "pixels, or on paper, as 89mmx60mm; 89mm is a square"},
    {DPI_OF_SIZE(PovrayOptions, size), .group = GROUP_CAMERA, .when = WHEN(ON_PAPER),
     .help = "pixels an inch of a size on paper"},
    {.name = "antialias",
     SETS(WHOLE, PovrayOptions, antialias),
     .range = &antialias_range,
     .group = GROUP_LIGHT,
     .when = WHEN(COLOR_PLANE),
     .help = "N x N samples a pixel"},
    {.name = "bits",
     SETS(WHOLE, PovrayOptions, bits),
     .range = &bits_range,
     .argument = "8|16",
     .when = WHEN(COLOR_PLANE),
     .help = "of the colours: 8, sRGB, or 16, linear"},
    {.name = "alpha",
     SETS(FLAG, PovrayOptions, alpha),
     .group = GROUP_LIGHT,
     .when = WHEN(COLOR_PLANE),
     .help = "transparent where the scene's background is: of a scene of --background none"},
    {.name = "plane",
     SETS(CHOICE, PovrayOptions, plane),
     .choices = planes,
     .help = "what a scene of ours shows"},
};

static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    (void)parsed;
    const PovrayOptions *options = set;
    return UNLESS(options->plane == ORACLE_COLOR, COLOR_PLANE) |
           UNLESS(size_is_on_paper(&options->size), ON_PAPER);
}

static const OptionTable own_table = {OPTION_ROWS(own), .unmet = unmet};

static void set_defaults(void *options)
{
    *(PovrayOptions *)options = (PovrayOptions){.antialias = 1, .bits = 8, .plane = ORACLE_COLOR};
}

static Status check(PovrayOptions *options, const Parsed *parsed, Err *err)
{
    if (strcmp(file_extension(options->output), "png") != 0)
        return err_set(err, STATUS_USAGE, "-o: '%s' does not end in .png", options->output);
    TRY(bits_check(options->bits, err));
    TRY(file_check_regular(parsed->operands[0], err));
    return options->has_size ? STATUS_OK : size_of_scene(parsed->operands[0], &options->size, err);
}

Status run_povray(void *options, Parsed *parsed, Err *err)
{
    PovrayOptions *own_options = options;
    Progress progress;
    OracleRun run;
    TRY(check(own_options, parsed, err));
    OracleParams params = {.scene = parsed->operands[0],
                           .output = own_options->output,
                           .width = own_options->size.pixels[0],
                           .height = own_options->size.pixels[1],
                           .antialias = own_options->antialias,
                           .threads = parsed->common.threads,
                           .plane = own_options->plane,
                           .bits = own_options->bits,
                           .alpha = own_options->alpha,
                           .progress = progress_report,
                           .progress_context = &progress};
    TRY(povray_from_environment(&params, err));
    progress_start(&progress, "POV-Ray", parsed->common.talk);
    Status status = oracle_run(&params, &run, err);
    progress_end(&progress);
    if (status == STATUS_OK && !parsed->common.quiet)
        fprintf(stderr, "POV-Ray %s took %.1f s\n", run.version, run.seconds);
    return status;
}

const Command command_povray = {
    .name = "povray",
    .summary = "run POV-Ray on a scene",
    .operands = "S.pov -o P.png",
    .examples = "  corcast povray tree.pov -o tree.png\n"
                "  corcast povray tree.pov --size 4000x4000 --antialias 3 -o large.png\n"
                "  corcast povray tree.pov --plane depth -o depth.png\n"
                "environment, here and for verify:\n"
                "  CORCAST_POVRAY           the program, or a script that stands for it (povray)\n"
                "  CORCAST_POVRAY_PATIENCE  seconds without a word after which it is ended (600; "
                "0: never)\n"
                "  CORCAST_TACHYON          likewise the witness of verify, with the same patience "
                "(tachyon)\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
    .size = sizeof(PovrayOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0}},
};
