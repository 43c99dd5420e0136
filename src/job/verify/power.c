/* Runs the operation `power`: measures which planted faults a tolerance detects. The renderer runs
 * twice, and the faults are planted in a copy of the second picture. If the renderer does not
 * repeat itself exactly, the rule must also accept its noise. */
#include "job/verify/power.h"

#include "job/picture/coloring.h"
#include "oracle/shell.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const Option own[] = {
    {.name = "render",
     SETS(TEXT, PowerOptions, render),
     .argument = "COMMAND",
     .help = "shell command that renders an image into the file {}; the command is run twice"},
    {.name = "verdict",
     SETS(TEXT, PowerOptions, verdict),
     .group = GROUP_JUDGE,
     .argument = "COMMAND",
     .otherwise = "",
     .help = "shell command of another comparison program, whose detection of faults is measured "
             "too. corcast replaces {a} and {b} by the names of two PNG files; the exit status "
             "must be 0 if they agree, and another number if they differ"},
    {.name = "choose",
     SETS(OUTPUT, PowerOptions, choose),
     .argument = "FILE.ini",
     .excludes = "render verdict tier tolerance levels ppm pixelmatch",
     .help = "file to write, such as NAME.tolerance.ini: the strictest tolerance that accepts "
             "all operands, which are a reference and at least two further renderings of the "
             "same scene"},
    {.name = "alarms",
     SETS(NUMBER, PowerOptions, alarms),
     FROM_TO(0, 0.5),
     .group = GROUP_JUDGE,
     .needs = "choose",
     .otherwise = "1 / number of operands",
     .help = "with --choose: false alarm rate of the tolerance, the fraction of correct "
             "renderings that it may reject"},
    {.name = "extension",
     SETS(TEXT, PowerOptions, extension),
     .argument = "EXT",
     .help = "extension of the file {}: png, exr, tif, ppm or another format that `corcast "
             "compare` reads"},
    {.name = "background",
     SETS(COLOR, PowerOptions, background),
     .help = "color that transparent images are composited over: a CSS name, #RRGGBB, or R,G,B "
             "each 0..1"},
    {.name = "output",
     SETS(FOLDER, PowerOptions, folder),
     .argument = "DIR",
     .help = "folder to write to: the images whose fault was not detected"},
    {.name = "json",
     SETS(FLAG, PowerOptions, json),
     .help = "print the result as JSON on standard output, with every fault and rule"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static void set_defaults(void *options)
{
    PowerOptions *power = options;
    power->extension = "png";
    power->background = vec3(1, 1, 1);
}

/* ---- files ----------------------------------------------------------------------------------- */

enum { FILE_DRAWN, FILE_A, FILE_B, POWER_FILES };

/* The files of the commands, in a folder below the current one. Paths are owned, and absolute,
 * because commands may change the folder. */
typedef struct PowerFiles {
    char *folder, *files[POWER_FILES];
} PowerFiles;

static Status make_folder(char **folder, Err *err)
{
    char *here = realpath(".", NULL), *beside = NULL;
    if (!here)
        return err_set(err, STATUS_IO, "the current folder no longer exists");
    Status status;
    TRY_GOTO(file_join(here, "power", &beside, err));
    status = file_temporary_folder(beside, folder, err);
done:
    free(here);
    free(beside);
    return status;
}

/* Creates a temporary folder, and names the files in it that a command reads. They are removed
 * when the program is interrupted. */
static Status open_place(PowerFiles *place, const char *extension, Err *err)
{
    static const char *const names[POWER_FILES] = {
        [FILE_DRAWN] = "drawn", [FILE_A] = "a", [FILE_B] = "b"};
    TRY(make_folder(&place->folder, err));
    for (int i = 0; i < POWER_FILES; i++) {
        char **path = &place->files[i];
        TRY(mem_printf(path, err, "%s/%s.%s", place->folder, names[i],
                       i == FILE_DRAWN ? extension : "png"));
        TRY(file_remove_on_signal(*path, err));
    }
    return STATUS_OK;
}

/* ---- the renderer ---------------------------------------------------------------------------- */

/* Reads a picture as sRGB of its own depth; floats become 16-bit codes. */
static Status read_drawn(const PowerOptions *options, const char *path, Picture *picture, Err *err)
{
    const Rgb ground = rgb_of_option(options->background);
    const float background[3] = {ground.r, ground.g, ground.b};
    Image image;
    TRY(image_read(&image, path, ALPHA_KEPT, NULL, err));
    Status status;
    TRY_GOTO(image_composite(&image, background, err));
    status = image.plane.values ? picture_from_plane(picture, &image.plane, ENCODING_SRGB, 16, err)
                                : picture_to_srgb(picture, &image.picture, image.picture.bits, err);
done:
    image_release(&image);
    return status;
}

/* Runs the renderer once and reads its picture. `heard`: the renderer's output goes to standard
 * error. */
static Status draw(const PowerOptions *options, const PowerFiles *place, bool heard,
                   Picture *picture, Err *err)
{
    Text command = TEXT_INIT;
    int exit_status = 0;
    Status status = STATUS_OK;
    shell_fill(options->render, &(ShellMark){"{}", place->files[FILE_DRAWN], false}, 1, 0,
               &command);
    TRY_GOTO(text_check(&command, err));
    remove(place->files[FILE_DRAWN]); /* an old file is not what this run draws */
    TRY_GOTO(shell_run(text_chars(&command), heard, &exit_status, err));
    if (exit_status != 0)
        TRY_GOTO(err_set(err, STATUS_TOOL, "--render: the command fails (exit status %d): %s",
                         exit_status, options->render));
    status = read_drawn(options, place->files[FILE_DRAWN], picture, err);
    if (status == STATUS_INPUT) { /* the file is the renderer's */
        status = STATUS_TOOL;
        err_prefix(err, "--render: ");
    }
done:
    text_release(&command);
    return status;
}

/* ---- the rules ------------------------------------------------------------------------------- */

static Status tolerance_differs(void *context, const Picture *reference, const Picture *picture,
                                bool *differs, Err *err)
{
    CompareResult result;
    const Rendering a = {.picture = reference}, b = {.picture = picture};
    TRY(compare_pictures(&a, &b, context, &result, NULL, err));
    *differs = !result.agrees;
    return STATUS_OK;
}

/* The rule of another program. */
typedef struct VerdictCommand {
    const PowerFiles *place;
    char *command; /* owned; both files filled in; NULL: there is no such rule */
} VerdictCommand;

static Status command_differs(void *context, const Picture *reference, const Picture *picture,
                              bool *differs, Err *err)
{
    const VerdictCommand *verdict = context;
    int exit_status = 0;
    TRY(picture_write(reference, verdict->place->files[FILE_A], ENCODING_SRGB, NULL, NULL, err));
    TRY(picture_write(picture, verdict->place->files[FILE_B], ENCODING_SRGB, NULL, NULL, err));
    TRY(shell_run(verdict->command, false, &exit_status, err));
    *differs = exit_status != 0;
    return STATUS_OK;
}

/* Makes the shell command that judges two files in place of a tolerance. */
static Status fill_verdict(const PowerOptions *options, const PowerFiles *place,
                           VerdictCommand *verdict, Err *err)
{
    const ShellMark marks[] = {{"{a}", place->files[FILE_A], false},
                               {"{b}", place->files[FILE_B], false}};
    Text command = TEXT_INIT;
    verdict->place = place;
    shell_fill(options->verdict, marks, 2, 0, &command);
    Status status = text_take(&command, &verdict->command, err);
    text_release(&command);
    return status;
}

/* Writes a picture whose fault is missed; the name is that of the fault and its size:
 * "picture-shifted-0.03.png". */
static Status keep_missed(void *context, const PowerCase *missed, const Picture *picture, Err *err)
{
    const char *folder = context;
    char name[80], size[24] = "", *path = NULL;
    if (missed->fault->unit)
        snprintf(size, sizeof size, "-%g", missed->size);
    snprintf(name, sizeof name, "%s%s.png", missed->fault->name, size);
    for (char *at = name; *at; at++)
        *at = isspace((unsigned char)*at) ? '-' : *at;
    TRY(file_join(folder, name, &path, err));
    Status status = picture_write(picture, path, ENCODING_SRGB, NULL, NULL, err);
    free(path);
    return status;
}

/* ---- the operation --------------------------------------------------------------------------- */

/* Measures the power of a rule with two drawings of one scene. */
static Status measure(const PowerOptions *options, const PowerRule *rule, const Picture drawings[2],
                      int threads, Power *power, Err *err)
{
    const PowerInput input = {.reference = &drawings[0],
                              .drawn = &drawings[1],
                              .rule = rule,
                              .keep = options->folder ? keep_missed : NULL,
                              .keep_context = (void *)(uintptr_t)options->folder};
    if (options->folder)
        TRY(file_make_folder(options->folder, err));
    return power_measure(&input, threads, power, err);
}

/* Chooses a tolerance from the operands, writes it, and measures its power. */
static Status choose(const PowerOptions *options, const Parsed *parsed, PowerReport *report,
                     Err *err)
{
    const size_t n = (size_t)parsed->n_operands;
    Picture *pictures;
    Text ini = TEXT_INIT;
    Status status = STATUS_OK;
    TRY(mem_calloc(&pictures, n, sizeof *pictures, "pictures", err));
    for (size_t i = 0; i < n; i++)
        TRY_GOTO(read_drawn(options, parsed->operands[i], &pictures[i], err));
    TRY_GOTO(choose_tolerance(pictures, n, options->alarms, parsed->common.threads, &report->choice,
                              err));
    choice_ini(&report->choice, &ini);
    TRY_GOTO(file_write_text(options->choose, &ini, err));
    Tolerance tolerance = choice_tolerance(&report->choice);
    const PowerRule rule = {.name = "chosen", .differs = tolerance_differs, .context = &tolerance};
    status = measure(options, &rule, pictures, parsed->common.threads, &report->power, err);
done:
    for (size_t i = 0; i < n; i++)
        picture_release(&pictures[i]);
    free(pictures);
    text_release(&ini);
    return status;
}

/* Runs the renderer twice, and measures the power of the rule that the options specify. */
static Status measure_drawn(const PowerOptions *options, const PowerFiles *place,
                            const Parsed *parsed, Power *power, Err *err)
{
    Picture drawings[2] = {{0}, {0}};
    Tolerance tolerance;
    VerdictCommand verdict = {0};
    char *tier_name = NULL;
    const bool asks = options->verdict != NULL;
    Status status = STATUS_OK;
    TRY_GOTO(compare_tolerance(&options->judge, 0, &tolerance, &tier_name, err));
    if (asks)
        TRY_GOTO(fill_verdict(options, place, &verdict, err));
    for (int i = 0; i < 2; i++)
        TRY_GOTO(draw(options, place, !parsed->common.quiet, &drawings[i], err));
    const PowerRule rule = {.name = "yours",
                            .differs = asks ? command_differs : tolerance_differs,
                            .context = asks ? (void *)&verdict : (void *)&tolerance};
    status = measure(options, &rule, drawings, asks ? 1 : parsed->common.threads, power, err);
done:
    picture_release(&drawings[0]);
    picture_release(&drawings[1]);
    free(verdict.command);
    free(tier_name);
    return status;
}

/* Checks that the commands have their marks, and that there are operands only where they are used.
 */
static Status check(const PowerOptions *options, const Parsed *parsed, Err *err)
{
    if (options->choose && parsed->n_operands < 3)
        return err_set(err, STATUS_USAGE,
                       "--choose needs a reference and at least two more renderings of its scene");
    if (options->choose)
        return STATUS_OK;
    if (parsed->n_operands > 0)
        return err_set(err, STATUS_USAGE, "pictures are operands only with --choose FILE.ini");
    if (!options->render || !strstr(options->render, "{}"))
        return err_set(err, STATUS_USAGE,
                       "--render needs a command with {} in place of the output file, such as "
                       "--render 'povray scene.pov +O{} -D'");
    if (options->verdict && (!strstr(options->verdict, "{a}") || !strstr(options->verdict, "{b}")))
        return err_set(err, STATUS_USAGE,
                       "--verdict needs a command with {a} and {b} in place of the two pictures, "
                       "such as --verdict 'idiff -fail 0.004 {a} {b}'");
    return STATUS_OK;
}

Status power_run(const PowerOptions *options, Parsed *parsed, PowerReport *report, Err *err)
{
    PowerFiles place = {0};
    Status status;
    *report = (PowerReport){0};
    TRY(check(options, parsed, err));
    if (options->choose)
        return choose(options, parsed, report, err);
    TRY_GOTO(open_place(&place, options->extension, err));
    status = measure_drawn(options, &place, parsed, &report->power, err);
done:
    for (int i = 0; i < POWER_FILES; i++)
        file_discard_temporary(place.files[i]);
    file_discard_temporary(place.folder);
    return status;
}

const Command command_power = {
    .name = "power",
    .summary = "measure which faults in an image a comparison fails to detect",
    .operands = "--render COMMAND | REFERENCE R1 R2 ... --choose FILE.ini",
    .examples =
        "  corcast power --render 'povray scene.pov +O{} -D +W320 +H240' --levels 2 --ppm 100\n"
        "  corcast power --render 'blender -b s.blend -o //{}' --verdict 'idiff -fail 0.016 "
        "-failpercent 1 {a} {b}'\n"
        "  corcast power --render 'cp picture.png {}' --pixelmatch 0.1 -o missed\n"
        "  corcast power references/front.png run*/front.png --choose "
        "references/front.tolerance.ini\n"
        "\nThe command plants faults of 22 kinds, each in several sizes, in the image. For each "
        "kind the "
        "table\nstates the smallest size that your tolerance detects, beside published tolerances "
        "of "
        "other\nprograms. The exit status is 1 if your tolerance rejects a second rendering of the "
        "same "
        "scene.\n",
    .max_operands = MAX_OPERANDS,
    .size = sizeof(PowerOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0}, {&judge_options, offsetof(PowerOptions, judge)}},
};
