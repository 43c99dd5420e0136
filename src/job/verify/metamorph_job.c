/* Runs the operation `metamorph`: searches for defects of a renderer with pairs of random scenes
 * [metamorph/metamorph.h], and writes the result as JSON. The scenes and pictures of the search are
 * in a temporary folder inside the output folder, which is removed at the end. */
#include "job/verify/metamorph_job.h"

#include "options/output.h"
#include <stdlib.h>

static const char *const formats[] = {"pov", "tachyon", "swc", NULL};

static const Option own[] = {
    {.name = "format",
     SETS(CHOICE, MetamorphOptions, format),
     .choices = formats,
     .help = "format of the scenes: pov or tachyon (shapes), or swc (trees)"},
    {.name = "relations",
     SETS(TEXT, MetamorphOptions, relations),
     .argument = "LIST",
     .otherwise = "all",
     .help = "relations to test, separated by commas. A relation is the change between the two "
             "scenes of a pair. All formats have repeat, scale-up, scale-down, translation, "
             "rotation, crop (adds rows above and below), behind and outside (add a vessel out of "
             "sight), split (cuts a vessel in two). pov and tachyon also have mirror, order (of "
             "shapes), lights (order of lights), hidden (adds a sphere in a sphere). swc also has "
             "rows (order of rows), ids. pov also has cone (replaces a cylinder), union, bounds "
             "(bounding spheres), sturm (root solver), cancelled (adds blob components that "
             "cancel each other), container and accuracy (of isosurfaces)"},
    {.name = "seconds",
     SETS(NUMBER, MetamorphOptions, seconds),
     FROM_TO(0.001, 1e6),
     .unit = "s",
     .help = "maximum time of the search, without the time for confirming pairs, making scenes "
             "small and writing reports. The number of pairs then depends on the machine, unless "
             "--pairs ends the search first"},
    {.name = "pairs",
     SETS(COUNT, MetamorphOptions, max_pairs),
     FROM_TO(0, 1e9),
     .argument = "N",
     .help = "maximum number of pairs; 0 sets no limit"},
    {.name = "output",
     SETS(FOLDER, MetamorphOptions, renderer.folder),
     .argument = "DIR",
     .help = "folder to write to: metamorph.json, and one folder per cause"},
};

static const OptionTable own_table = OPTION_TABLE(own);

/* A rendering of more than 20 s counts as not drawn. More renderings at the same time test more
 * pairs on a machine with more processors. Reasons of the numbers not recorded. */
static void set_defaults(void *options)
{
    MetamorphOptions *metamorph = options;
    metamorph->seconds = 60;
    metamorph->renderer.shell = (ShellRenderer){.timeout_s = 20, .jobs = 16};
}

static Status write_result(const MetamorphOptions *options, const Metamorph *result, Err *err)
{
    char *path = NULL;
    TRY(file_join(options->renderer.folder, "metamorph.json", &path, err));
    Status status = json_write(metamorph_json(result), path, err);
    free(path);
    return status;
}

Status metamorph_make(const MetamorphOptions *options, Parsed *parsed, Metamorph *result, Err *err)
{
    Progress progress;
    char *folder = NULL, *beside = NULL, *scenes = NULL;
    Status status;
    progress_start(&progress, "testing", parsed->common.talk);
    TRY_GOTO(renderer_open_folder(&options->renderer, "the reports", &folder, err));
    TRY_GOTO(file_join(folder, "scenes", &beside, err));
    TRY_GOTO(file_temporary_folder(beside, &scenes, err));
    const MetamorphParams params = {.renderer = {options->renderer.shell, options->format, scenes},
                                    .relations = options->relations,
                                    .seed = parsed->common.seed,
                                    .max_pairs = options->max_pairs,
                                    .seconds = options->seconds,
                                    .output = options->renderer.folder,
                                    .progress = progress_report,
                                    .progress_context = &progress};
    TRY_GOTO(metamorph_run(&params, result, err));
    status = write_result(options, result, err);
done:
    progress_end(&progress);
    free(folder);
    free(beside);
    file_discard_temporary(scenes);
    return status;
}

const Command command_metamorph = {
    .name = "metamorph",
    .summary = "find defects of a renderer from pairs of scenes that must give the same picture",
    .operands = "--render COMMAND -o DIR",
    .examples =
        "  corcast metamorph --render 'povray +I{scene} +O{picture} +W{width} +H{height} -D +WT1' "
        "-o povray\n"
        "  corcast metamorph --format tachyon --render 'tachyon {scene} -numthreads 1 -format PPM "
        "-o {picture}' -o tachyon\n"
        "  corcast metamorph --format swc --render 'corcast render {scene} {camera} -o {picture} "
        "--quiet' -o self\n"
        "\n"
        "corcast makes pairs of random scenes and lets the renderer draw them. The second scene of "
        "a\n"
        "pair is the first one with a change whose effect on the picture is known, such as a\n"
        "translation of scene and camera. A pair fails if the second picture lacks the expected\n"
        "effect. corcast draws a failing pair again with three shifted cameras, and confirms it if "
        "at\n"
        "least two of the three fail in the same way. corcast makes a confirmed pair as small as\n"
        "possible and reports it in DIR/CAUSE. The exit status is 1 if a cause was found.\n",
    .max_operands = 0,
    .size = sizeof(MetamorphOptions),
    .set_defaults = set_defaults,
    .tables = {{&renderer_options, offsetof(MetamorphOptions, renderer)}, {&own_table, 0}},
};
