#include "app/commands.h"
#include "app/picture.h"
#include "app/povfiles.h"
#include <stdio.h>
#include <string.h>

typedef struct SceneOptions {
    const char *output;
    bool ids;
    PictureOptions picture;
} SceneOptions;

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, SceneOptions, output),
     .argument = "S.pov",
     .help = "the scene; its geometry goes to S.inc beside it"},
    {.name = "ids",
     SETS(SWITCH, SceneOptions, ids),
     .group = GROUP_POVRAY,
     .help = "isosurface, blob: with what POV-Ray needs for the id plane"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static void set_defaults(void *options)
{
    SceneOptions *own_options = options;
    picture_set_defaults(&own_options->picture);
}

/* The emitter for a file of this name; standard output gets POV-Ray's. */
static Status find_emitter(const char *output, const Emitter **emitter, Err *err)
{
    *emitter = emitter_of_extension(strcmp(output, "-") ? file_extension(output) : "pov");
    if (*emitter)
        return STATUS_OK;
    Text extensions = TEXT_INIT;
    for (const Emitter *row = emitters; row->name; row++)
        text_printf(&extensions, "%s.%s",
                    row == emitters ? ""
                    : row[1].name   ? ", "
                                    : " or ",
                    row->extension);
    Status status =
        err_set(err, STATUS_USAGE, "-o: '%s' does not end in %s", output, text_chars(&extensions));
    text_release(&extensions);
    return status;
}

static Status check(const SceneOptions *options, const Parsed *parsed, Err *err)
{
    const PictureOptions *picture = &options->picture;
    const OptionNeed needs[] = {
        {"ids", picture->model == SCENE_ISOSURFACE || picture->model == SCENE_BLOB,
         "is for --model isosurface and blob; other scenes have ids anyway"},
        {0}};
    TRY(options_check_needs(parsed, needs, err));
    TRY(picture_check_needs(picture, parsed, err));
    return picture_check_povray(picture, err);
}

static Status run_scene(void *options, Parsed *parsed, Err *err)
{
    const SceneOptions *own_options = options;
    const PictureOptions *picture = &own_options->picture;
    const char *tree = parsed->operands[0], *output = own_options->output;
    const Emitter *emitter;
    Scene scene = {0};
    EmitReport report = {0};
    TRY(check(own_options, parsed, err));
    TRY(find_emitter(output, &emitter, err));
    TRY(scene_files_note(emitter, output, &parsed->files, err));
    TRY(picture_scene(picture, tree, parsed->common.quiet, &scene, NULL, err));
    const EmitParams params = {.scene = &scene,
                               .shadows = picture->stage.shadows,
                               .ids = own_options->ids,
                               .cells = picture_cells(picture)};
    Status status = scene_files_write(emitter, &params, tree, output, &report, err);
    if (status == STATUS_OK && report.joint_sides > 0 && !parsed->common.quiet)
        fprintf(stderr,
                "corcast: more joints than POV-Ray holds exactly; they are meshes of %d sides, of "
                "more with Declare=Joint_Sides=N\n",
                report.joint_sides);
    scene_release(&scene);
    return status;
}

const Command command_scene = {
    .name = "scene",
    .summary = "write a tree as a POV-Ray scene",
    .operands = "T.swc -o S.pov",
    .examples = "  corcast scene tree.swc -o tree.pov\n"
                "  corcast scene tree.swc --model isosurface --size 2000x2000 -o tree.pov\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
    .size = sizeof(SceneOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0},
               {&picture_table, offsetof(SceneOptions, picture)},
               {&coloring_table, offsetof(SceneOptions, picture.coloring)}},
    .run = run_scene,
};
