/* The extension of the output chooses the emitter, whose row says what it can hold; options that a
 * format has no use for are refused. */
#include "app/commands.h"
#include "app/meshing.h"
#include "app/picture.h"
#include "app/povfiles.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* How a model for OpenSCAD is made. */
typedef enum ScadForm { SCAD_PARAMETRIC, SCAD_POLYHEDRON } ScadForm;
static const char *const scad_forms[] = {
    [SCAD_PARAMETRIC] = "parametric", [SCAD_POLYHEDRON] = "polyhedron", NULL};

typedef struct SceneOptions {
    const char *output;
    bool ids, ini;
    ScadForm scad;
    PictureOptions picture;
} SceneOptions;

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, SceneOptions, output),
     .is_told = true,
     .argument = "S.pov|S.scad",
     .help = "a scene for POV-Ray, its geometry in S.inc beside it, or a model for OpenSCAD"},
    {.name = "ids",
     SETS(SWITCH, SceneOptions, ids),
     .group = GROUP_POVRAY,
     .help = "isosurface, blob: with what POV-Ray needs for the id plane"},
    {.name = "ini",
     SETS(SWITCH, SceneOptions, ini),
     .group = GROUP_POVRAY,
     .help = "size, antialiasing and animations in S.ini, too: povray S.ini draws the picture"},
    {.name = "scad",
     SETS(CHOICE, SceneOptions, scad),
     .choices = scad_forms,
     .group = GROUP_VESSELS,
     .help = "S.scad: modules that answer to the customizer, or one closed surface"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static void set_defaults(void *options)
{
    SceneOptions *own_options = options;
    picture_set_defaults(&own_options->picture);
}

/* STATUS_USAGE for an option that has no effect on a file of this format. */
static Status check_format(const Emitter *emitter, const Parsed *parsed, Err *err)
{
    static const char of_view[] = "is for scenes with a camera (.pov); a solid has none";
    static const char of_povray[] = "is for scenes of POV-Ray (.pov)";
    static const char of_vessels[] = "is for vessels; a polyhedron is the surface of all";
    const bool view = emitter->has_view, povray = strcmp(emitter->extension, "pov") == 0;
    const bool vessels = !emitter->of_meshes;
    const OptionNeed needs[] = {{"size", view, of_view},
                                {"projection", view, of_view},
                                {"view", view, of_view},
                                {"location", view, of_view},
                                {"look-at", view, of_view},
                                {"up", view, of_view},
                                {"angle", view, of_view},
                                {"height", view, of_view},
                                {"margin", view, of_view},
                                {"antialias", view, of_view},
                                {"shadows", view, of_view},
                                {"background", view, of_view},
                                {"ids", povray, of_povray},
                                {"ini", povray, of_povray},
                                {"model", vessels, of_vessels},
                                {"look", vessels, of_vessels},
                                {"color-by", vessels, of_vessels},
                                {"scad", !povray, "is for models of OpenSCAD (.scad)"},
                                {0}};
    return options_check_needs(parsed, needs, err);
}

static Status check(const SceneOptions *options, const Emitter *emitter, const Parsed *parsed,
                    Err *err)
{
    const PictureOptions *picture = &options->picture;
    TRY(check_format(emitter, parsed, err));
    if (options->ini && strcmp(options->output, "-") == 0)
        return err_set(err, STATUS_USAGE, "--ini is a file beside S.pov; standard output has none");
    TRY(picture_check_needs(picture, parsed, err));
    TRY(picture_check_povray(picture, err));
    return emit_check_model(emitter, (SceneModel)picture->model, err);
}

/* What the user should know of the file besides. */
static void say_limits(const EmitReport *report, const Scene *scene)
{
    enum { QUICK = 100 };
    if (report->joint_sides > 0)
        fprintf(stderr,
                "corcast: more joints than POV-Ray holds exactly; they are meshes of %d sides, of "
                "more with Declare=Joint_Sides=N\n",
                report->joint_sides);
    if (report->openscad_s > 0 && scene->geometry.drawn > QUICK)
        fprintf(stderr,
                "corcast: OpenSCAD takes about %.2g s to make a solid of %zu vessels, and its "
                "preview a moment; --scad polyhedron is a solid at once\n",
                report->openscad_s, scene->geometry.drawn);
}

static Status write_scene(const SceneOptions *options, const Emitter *emitter, const char *line,
                          const Parsed *parsed, Err *err)
{
    const PictureOptions *picture = &options->picture;
    const char *tree = parsed->operands[0];
    Scene scene = {0};
    Anatomy anatomy = {0};
    EmitReport report = {0};
    TRY(picture_scene(picture, parsed, &scene, &anatomy, NULL, err));
    const EmitParams params = {.scene = &scene,
                               .anatomy = &anatomy,
                               .command = line,
                               .antialias = picture->antialias,
                               .shadows = picture->stage.shadows,
                               .ids = options->ids,
                               .cells = picture_cells(picture)};
    Status status =
        scene_files_write(emitter, &params, tree, options->output, options->ini, &report, err);
    if (status == STATUS_OK && !parsed->common.quiet)
        say_limits(&report, &scene);
    anatomy_release(&anatomy);
    scene_release(&scene);
    return status;
}

/* The emitter that is asked for; standard output gets POV-Ray's. */
static Status find_emitter(const SceneOptions *options, const Emitter **emitter, Err *err)
{
    const char *output = strcmp(options->output, "-") ? options->output : "scene.pov";
    bool scad = strcmp(file_extension(output), "scad") == 0;
    return scene_files_find(output, scad && options->scad == SCAD_POLYHEDRON, emitter, err);
}

static Status run_scene(void *options, Parsed *parsed, Err *err)
{
    const SceneOptions *own_options = options;
    const MeshingOptions meshing = {.tolerance = MESHING_TOLERANCE,
                                    .prune_radius_mm = own_options->picture.prune_radius_mm};
    const Emitter *emitter;
    char *line = NULL;
    TRY(find_emitter(own_options, &emitter, err));
    TRY(check(own_options, emitter, parsed, err));
    TRY(scene_files_note(emitter, own_options->output, own_options->ini, &parsed->files, err));
    if (emitter->of_meshes)
        return meshing_write(emitter, &meshing, own_options->output, parsed, err);
    TRY(command_line_text(parsed, &line, err));
    Status status = write_scene(own_options, emitter, line, parsed, err);
    free(line);
    return status;
}

const Command command_scene = {
    .name = "scene",
    .summary = "write a tree as a scene for POV-Ray or OpenSCAD",
    .operands = "T.swc -o S.pov|S.scad",
    .examples = "  corcast scene tree.swc -o tree.pov\n"
                "  corcast scene tree.swc --model isosurface --size 2000x2000 -o tree.pov\n"
                "  corcast scene tree.swc -o tree.scad\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
    .reads_tree = true,
    .size = sizeof(SceneOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0}, PICTURE_TABLES(SceneOptions, picture)},
    .run = run_scene,
};
