#include "app/commands.h"
#include "app/picture.h"
#include "app/povfiles.h"
#include <stdio.h>
#include <string.h>

static const Command command = {
    .name = "scene",
    .summary = "write a tree as a POV-Ray scene",
    .operands = "T.swc -o S.pov",
    .examples = "  corcast scene tree.swc -o tree.pov\n"
                "  corcast scene tree.swc --model isosurface --size 2000x2000 -o tree.pov\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
};

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

Status run_scene(int argc, char **argv, Err *err)
{
    PictureOptions picture;
    picture_options_init(&picture);
    const char *output = NULL;
    bool ids = false;
    const Option own[] = {
        {"output", OPTION_OUTPUT, &output, NULL, 0, 0, NULL, "S.pov",
         "the scene; its geometry goes to S.inc beside it"},
        {"ids", OPTION_SWITCH, &ids, NULL, 0, 0, NULL, NULL,
         "isosurface, blob: with what POV-Ray needs for the id plane (off)"},
        {0},
    };
    const Option *const tables[] = {own, picture.table, picture.coloring.table, NULL};
    Parsed parsed;
    TRY(options_parse(&command, tables, argc, argv, &parsed, err));
    Status status = STATUS_OK;
    Scene scene = {0};
    EmitReport report = {0};
    const Emitter *emitter = NULL;
    if (parsed.common.help)
        goto done;
    const OptionNeed needs[] = {
        {"ids", picture.model == SCENE_ISOSURFACE || picture.model == SCENE_BLOB,
         "is for --model isosurface and blob; other scenes have ids anyway"},
        {0}};
    TRY_GOTO(options_check_needs(&parsed, needs, err));
    TRY_GOTO(picture_check_needs(&picture, &parsed, err));
    TRY_GOTO(picture_check_povray(&picture, err));
    TRY_GOTO(find_emitter(output, &emitter, err));
    TRY_GOTO(scene_files_note(emitter, output, &parsed.files, err));
    TRY_GOTO(picture_scene(&picture, parsed.operands[0], parsed.common.quiet, &scene, NULL, err));
    const EmitParams params = {.scene = &scene,
                               .shadows = picture.stage.shadows,
                               .ids = ids,
                               .cells = picture_cells(&picture)};
    TRY_GOTO(scene_files_write(emitter, &params, parsed.operands[0], output, &report, err));
    if (report.joint_sides > 0 && !parsed.common.quiet)
        fprintf(stderr,
                "corcast: more joints than POV-Ray holds exactly; they are meshes of %d sides, of "
                "more with Declare=Joint_Sides=N\n",
                report.joint_sides);
done:
    scene_release(&scene);
    parsed_release(&parsed);
    return status;
}
