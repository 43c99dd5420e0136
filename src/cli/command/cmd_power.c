/* What a tolerance would miss, of any renderer whose command line writes a picture. The command is
 * run twice, so that the faults are planted in another drawing than the reference: where a renderer
 * does not repeat itself, the tolerance has its noise to bear, too. */
#include "cli/commands.h"
#include "compare/compare.h"
#include "job/picture/coloring.h"
#include "job/verify/compare_options.h"
#include "options/output.h"
#include "oracle/shell.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct PowerOptions {
    const char *render, *verdict, *extension, *folder;
    bool json;
    Vec3 background; /* sRGB in [0, 1] */
    JudgeOptions judge;
} PowerOptions;

static const Option own[] = {
    {.name = "render",
     SETS(TEXT, PowerOptions, render),
     .argument = "COMMAND",
     .help = "draws a picture into the file {}; run twice by the shell"},
    {.name = "verdict",
     SETS(TEXT, PowerOptions, verdict),
     .group = GROUP_JUDGE,
     .argument = "COMMAND",
     .otherwise = "",
     .help = "a tolerance of another program: exit status 0 where the PNGs {a} and {b} agree"},
    {.name = "extension",
     SETS(TEXT, PowerOptions, extension),
     .argument = "EXT",
     .help = "of the file {}: png, exr, tif, ppm and others that compare reads"},
    {.name = "background",
     SETS(COLOR, PowerOptions, background),
     .help = "what transparent pictures are laid on"},
    {.name = "output",
     SETS(FOLDER, PowerOptions, folder),
     .argument = "DIR",
     .help = "a folder for the pictures whose fault is missed"},
    {.name = "json", SETS(FLAG, PowerOptions, json), .help = "as JSON, every fault and rule"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static void set_defaults(void *options)
{
    PowerOptions *own_options = options;
    own_options->extension = "png";
    own_options->background = vec3(1, 1, 1);
}

/* ---- files ----------------------------------------------------------------------------------- */

enum { FILE_DRAWN, FILE_A, FILE_B, PLACE_FILES };

/* Files of the commands, in a folder of the current one; all names are owned, and absolute, because
 * commands may go to other folders. */
typedef struct Place {
    char *folder, *files[PLACE_FILES];
} Place;

static Status make_folder(char **folder, Err *err)
{
    char *here = realpath(".", NULL), *beside = NULL;
    if (!here)
        return err_set(err, STATUS_IO, "the current folder is gone");
    Status status = file_join(here, "power", &beside, err);
    if (status == STATUS_OK)
        status = file_temporary_folder(beside, folder, err);
    free(here);
    free(beside);
    return status;
}

static Status open_place(Place *place, const char *extension, Err *err)
{
    Text name = TEXT_INIT;
    text_printf(&name, "drawn.%s", extension);
    const char *const names[PLACE_FILES] = {
        [FILE_DRAWN] = text_chars(&name), [FILE_A] = "a.png", [FILE_B] = "b.png"};
    Status status = make_folder(&place->folder, err);
    for (int i = 0; i < PLACE_FILES && status == STATUS_OK; i++) {
        char *path = NULL;
        status = file_join(place->folder, names[i], &path, err);
        if (status == STATUS_OK)
            status = file_remove_on_signal(path, err);
        if (status == STATUS_OK)
            place->files[i] = path;
        else
            free(path);
    }
    text_release(&name);
    return status;
}

static void close_place(Place *place)
{
    for (int i = 0; i < PLACE_FILES; i++)
        file_forget(place->files[i]);
    file_forget(place->folder);
}

/* ---- the renderer ---------------------------------------------------------------------------- */

/* In sRGB, of the file's own depth, or 16 bits where that holds floats. */
static Status read_drawn(const PowerOptions *options, const char *path, Picture *picture, Err *err)
{
    const Rgb ground = rgb_of_option(options->background);
    const float background[3] = {ground.r, ground.g, ground.b};
    Image image;
    TRY(image_read(&image, path, ALPHA_KEPT, NULL, err));
    Status status = image_lay_on(&image, background, err);
    if (status == STATUS_OK && image.plane.values)
        status = picture_from_plane(picture, &image.plane, ENCODING_SRGB, 16, err);
    else if (status == STATUS_OK)
        status = picture_to_srgb(picture, &image.picture, image.picture.bits, err);
    image_release(&image);
    return status;
}

static Status draw(const PowerOptions *options, const Place *place, bool heard, Picture *picture,
                   Err *err)
{
    Text command = TEXT_INIT;
    int exit_status = 0;
    Status status = STATUS_OK;
    shell_fill(options->render, "{}", place->files[FILE_DRAWN], &command);
    TRY_GOTO(text_check(&command, err));
    remove(place->files[FILE_DRAWN]); /* an old one is not what this run draws */
    TRY_GOTO(shell_run(text_chars(&command), heard, &exit_status, err));
    if (exit_status != 0)
        TRY_GOTO(err_set(err, STATUS_TOOL, "--render: the command fails (exit status %d): %s",
                         exit_status, options->render));
    status = read_drawn(options, place->files[FILE_DRAWN], picture, err);
    if (status == STATUS_INPUT) { /* of the renderer's making */
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

/* A verdict of another program. */
typedef struct Verdict {
    const Place *place;
    char *command; /* owned; both files filled in */
} Verdict;

static Status command_differs(void *context, const Picture *reference, const Picture *picture,
                              bool *differs, Err *err)
{
    const Verdict *verdict = context;
    int exit_status = 0;
    TRY(picture_write(reference, verdict->place->files[FILE_A], ENCODING_SRGB, NULL, NULL, err));
    TRY(picture_write(picture, verdict->place->files[FILE_B], ENCODING_SRGB, NULL, NULL, err));
    TRY(shell_run(verdict->command, false, &exit_status, err));
    *differs = exit_status != 0;
    return STATUS_OK;
}

static Status fill_verdict(const PowerOptions *options, const Place *place, Verdict *verdict,
                           Err *err)
{
    Text half = TEXT_INIT, whole = TEXT_INIT;
    shell_fill(options->verdict, "{a}", place->files[FILE_A], &half);
    Status status = text_check(&half, err);
    if (status == STATUS_OK) {
        shell_fill(text_chars(&half), "{b}", place->files[FILE_B], &whole);
        status = text_take(&whole, &verdict->command, err);
    }
    verdict->place = place;
    text_release(&half);
    text_release(&whole);
    return status;
}

/* Writes a picture whose fault is missed as "picture-shifted-0.03.png". */
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

/* ---- the command ----------------------------------------------------------------------------- */

static Status measure(const PowerOptions *options, const Place *place, const Parsed *parsed,
                      Power *power, Err *err)
{
    Picture drawings[2] = {{0}, {0}};
    Tolerance tolerance;
    Verdict verdict = {0};
    char *tier_name = NULL;
    const bool asks = options->verdict != NULL;
    Status status = STATUS_OK;
    TRY_GOTO(compare_tolerance(&options->judge, 0, &tolerance, &tier_name, err));
    if (asks)
        TRY_GOTO(fill_verdict(options, place, &verdict, err));
    for (int i = 0; i < 2; i++)
        TRY_GOTO(draw(options, place, !parsed->common.quiet, &drawings[i], err));
    if (options->folder)
        TRY_GOTO(file_make_folder(options->folder, err));
    const PowerRule rule = {.name = "yours",
                            .differs = asks ? command_differs : tolerance_differs,
                            .context = asks ? (void *)&verdict : (void *)&tolerance};
    status = power_measure(&drawings[0], &drawings[1], &rule, asks ? 1 : parsed->common.threads,
                           options->folder ? keep_missed : NULL, (void *)(uintptr_t)options->folder,
                           power, err);
done:
    picture_release(&drawings[0]);
    picture_release(&drawings[1]);
    free(verdict.command);
    free(tier_name);
    return status;
}

static Status print(const PowerOptions *options, const Power *power, Err *err)
{
    if (options->json)
        return json_write(power_json(power), "-", err);
    Text text = TEXT_INIT;
    power_text(power, &text);
    Status status = text_check(&text, err);
    if (status == STATUS_OK)
        fputs(text_chars(&text), stdout);
    text_release(&text);
    return status;
}

/* STATUS_USAGE unless the commands have their marks. */
static Status check(const PowerOptions *options, Err *err)
{
    const bool own_rule = options->verdict == NULL;
    if (!options->render || !strstr(options->render, "{}"))
        return err_set(err, STATUS_USAGE,
                       "--render is a command with {} for the file that it draws into, as "
                       "--render 'povray scene.pov +O{} -D'");
    if (!own_rule && (!strstr(options->verdict, "{a}") || !strstr(options->verdict, "{b}")))
        return err_set(err, STATUS_USAGE,
                       "--verdict is a command with {a} and {b} for the two pictures, as "
                       "--verdict 'idiff -fail 0.004 {a} {b}'");
    return STATUS_OK;
}

Status run_power(void *options, Parsed *parsed, Err *err)
{
    const PowerOptions *own_options = options;
    Place place = {0};
    Power power = {0};
    Status status = STATUS_OK;
    TRY(check(own_options, err));
    TRY_GOTO(open_place(&place, own_options->extension, err));
    TRY_GOTO(measure(own_options, &place, parsed, &power, err));
    TRY_GOTO(print(own_options, &power, err));
    status = power.alarm[0] ? STATUS_DIFFERS : STATUS_OK;
done:
    close_place(&place);
    power_release(&power);
    return status;
}

const Command command_power = {
    .name = "power",
    .summary = "what a tolerance would miss in a renderer's pictures",
    .operands = "--render COMMAND",
    .examples =
        "  corcast power --render 'povray scene.pov +O{} -D +W320 +H240' --levels 2 --ppm 100\n"
        "  corcast power --render 'blender -b s.blend -o //{}' --verdict 'idiff -fail 0.016 "
        "-failpercent 1 {a} {b}'\n"
        "  corcast power --render 'cp picture.png {}' --pixelmatch 0.1 -o missed\n"
        "\nFaults of 22 kinds, each of several sizes, are planted in the picture; the table says "
        "from\nwhich size on the tolerance finds each, beside tolerances that others publish. Exit "
        "status 1\nwhen the tolerance calls two drawings of the same scene different.\n",
    .max_operands = 0,
    .size = sizeof(PowerOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0}, {&judge_options, offsetof(PowerOptions, judge)}},
};
