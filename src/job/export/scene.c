/* The extension of the output chooses the emitter, whose row says what it can hold; options that a
 * format has no use for are refused. OpenSCAD has two: modules, which it unites for half a second
 * each, and one closed surface; where nothing that is asked for decides, the number of vessels
 * does. */
#include "job/export/scene.h"

#include "job/export/meshing.h"
#include "job/export/scenefiles.h"
#include "options/output.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const scad_forms[] = {
    [SCAD_AUTO] = "auto", [SCAD_PARAMETRIC] = "parametric", [SCAD_POLYHEDRON] = "polyhedron", NULL};

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, SceneOptions, output),
     .is_told = true,
     .argument = "S.pov|S.scad|S.tachyon",
     .help =
         "a scene for POV-Ray, its geometry in S.inc beside it, a model for OpenSCAD or a scene "
         "for Tachyon"},
    {.name = "ids",
     SETS(SWITCH, SceneOptions, ids),
     .group = GROUP_POVRAY,
     .when = WHEN(FIELD_IDS) | WHEN(POVRAY),
     .help = "isosurface, blob: with what POV-Ray needs for the id plane"},
    {.name = "ini",
     SETS(SWITCH, SceneOptions, ini),
     .group = GROUP_POVRAY,
     .when = WHEN(POVRAY),
     .help = "size, antialiasing and animations in S.ini, too: povray S.ini draws the picture"},
    {.name = "scad",
     SETS(CHOICE, SceneOptions, scad),
     .choices = scad_forms,
     .group = GROUP_VESSELS,
     .when = WHEN(OPENSCAD),
     .help = "S.scad: modules that answer to the customizer, or one closed surface; auto: by the "
             "number of vessels"},
};

static void set_defaults(void *options)
{
    SceneOptions *own_options = options;
    picture_set_defaults(&own_options->picture);
}

static Status check(const SceneOptions *options, const Emitter *emitter, Err *err)
{
    const PictureOptions *picture = &options->picture;
    const SceneModel model =
        picture->as_mesh ? model_with(MODEL_TRIANGLES) : (SceneModel)picture->model;
    if (options->ini && strcmp(options->output, "-") == 0)
        return err_set(err, STATUS_USAGE, "--ini is a file beside S.pov; standard output has none");
    TRY(picture_check_povray(picture, err));
    return emit_check_model(emitter, model, err);
}

/* What the user should know of the file besides. */
static void say_limits(const Emitter *emitter, const EmitReport *report, const Scene *scene,
                       const char *tree)
{
    Err misfit;
    if (emitter->has_view && picture_check_ids(&scene->geometry, tree, &misfit) != STATUS_OK)
        fprintf(stderr, "corcast: %s\n", misfit.text);
    if (report->joint_sides > 0)
        fprintf(stderr,
                "corcast: more joints than POV-Ray holds exactly; they are meshes of %d sides, of "
                "more with Declare=Joint_Sides=N\n",
                report->joint_sides);
    if (report->openscad_s > 0 && scene->geometry.drawn > OPENSCAD_QUICK)
        fprintf(stderr,
                "corcast: OpenSCAD takes about %.2g s to make a solid of %zu vessels, and its "
                "preview a moment; --scad polyhedron is a solid at once\n",
                report->openscad_s, scene->geometry.drawn);
}

static Status write_scene(const SceneOptions *options, const Emitter *emitter,
                          const PictureSource *source, const char *line, const Parsed *parsed,
                          Err *err)
{
    const PictureOptions *picture = &options->picture;
    const char *tree = source->of.path;
    Scene scene = {0};
    Anatomy anatomy = {0};
    EmitReport report = {0};
    PictureReport made;
    TRY(picture_scene_of(picture, source, parsed, &scene, &anatomy, &made, err));
    Status status = picture_say(&scene, &made, parsed->common.talk, err);
    if (status == STATUS_OK && emitter->has_view)
        status = picture_say_effects(picture, &scene.view, "the scene is without them",
                                     parsed->common.talk, err);
    const EmitParams params = {.scene = &scene,
                               .anatomy = &anatomy,
                               .command = line,
                               .antialias = picture->antialias,
                               .shadows = picture->stage.shadows,
                               .ids = options->ids,
                               .cells = picture_cells(picture)};
    if (status == STATUS_OK)
        status =
            scene_files_write(emitter, &params, tree, options->output, options->ini, &report, err);
    if (status == STATUS_OK && !parsed->common.quiet)
        say_limits(emitter, &report, &scene, tree);
    anatomy_release(&anatomy);
    scene_release(&scene);
    return status;
}

static Status write_surface(const SceneOptions *options, const Emitter *emitter,
                            const PictureSource *source, const Parsed *parsed, Err *err)
{
    const MeshingOptions meshing = {.tolerance = options->picture.tolerance,
                                    .part_overlaps = options->picture.part_overlaps};
    return meshing_write(emitter, &meshing, &source->of, options->output, parsed, err);
}

/* The form of a model for OpenSCAD, as far as the options decide. */
static ScadForm asked_form(const SceneOptions *options, const Parsed *parsed)
{
    if (options->scad != SCAD_AUTO)
        return options->scad;
    if (model_has(options->picture.model, MODEL_TRIANGLES))
        return SCAD_POLYHEDRON;
    bool of_vessels = options_typed(parsed, "model") || options_typed(parsed, "look") ||
                      options_typed(parsed, "color-by");
    return of_vessels ? SCAD_PARAMETRIC : SCAD_AUTO;
}

/* The emitter of a form; of SCAD_AUTO, and of other files, that of scenes. Standard output gets
 * POV-Ray's. */
static Status find_emitter(const char *output, ScadForm form, const Emitter **emitter, Err *err)
{
    const char *name = strcmp(output, "-") ? output : "scene.pov";
    bool scad = strcmp(file_extension(name), "scad") == 0;
    return scene_files_find(name, scad && form == SCAD_POLYHEDRON, emitter, err);
}

/* By the number of vessels, which is said. */
static ScadForm form_by_size(const Tree *tree, const SceneOptions *options, bool quiet)
{
    size_t n = 0;
    for (size_t i = 0; i < tree->n; i++)
        n += tree_is_segment(tree, i);
    if (n <= OPENSCAD_QUICK)
        return SCAD_PARAMETRIC;
    if (!quiet)
        fprintf(stderr,
                "corcast: %zu vessels are more than OpenSCAD unites in good time, %d: %s is one "
                "closed surface; --scad parametric writes modules\n",
                n, OPENSCAD_QUICK, options->output);
    return SCAD_POLYHEDRON;
}

/* Settles on an emitter and writes by it. */
static Status write_source(const SceneOptions *options, const Emitter *emitter,
                           const PictureSource *source, Parsed *parsed, Err *err)
{
    char *line = NULL;
    bool is_open =
        strcmp(emitter->extension, "scad") == 0 && asked_form(options, parsed) == SCAD_AUTO;
    if (is_open)
        TRY(find_emitter(options->output,
                         form_by_size(&source->of.tree, options, parsed->common.quiet), &emitter,
                         err));
    TRY(scene_files_note(emitter, options->output, options->ini, &parsed->files, err));
    if (emitter->of_meshes)
        return write_surface(options, emitter, source, parsed, err);
    TRY(command_line_text(parsed, &line, err));
    Status status = write_scene(options, emitter, source, line, parsed, err);
    free(line);
    return status;
}

Status scene_run(void *options, Parsed *parsed, Err *err)
{
    const SceneOptions *own_options = options;
    const Emitter *emitter;
    PictureSource source;
    TRY(find_emitter(own_options->output, asked_form(own_options, parsed), &emitter, err));
    TRY(check(own_options, emitter, err));
    TRY(picture_read_source(&own_options->picture, parsed, &source, err));
    Status status = write_source(own_options, emitter, &source, parsed, err);
    picture_source_release(&source);
    return status;
}

/* Finds the emitter for the output; NULL if there is none, which is refused later. */
static const Emitter *emitter_of(const SceneOptions *options, const Parsed *parsed)
{
    const Emitter *emitter;
    const bool found = options->output && find_emitter(options->output, asked_form(options, parsed),
                                                       &emitter, NULL) == STATUS_OK;
    return found ? emitter : NULL;
}

static Status settle(void *set, const Parsed *parsed, Err *err)
{
    (void)err;
    SceneOptions *options = set;
    const Emitter *emitter = emitter_of(options, parsed);
    options->picture.as_mesh = emitter && emitter->of_meshes;
    return STATUS_OK;
}

/* The format of the file decides which options have an effect. */
static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    const SceneOptions *options = set;
    const Emitter *emitter = emitter_of(options, parsed);
    if (!emitter)
        return 0;
    const PictureOptions *picture = &options->picture;
    const bool mesh = model_has((SceneModel)picture->model, MODEL_TRIANGLES);
    return UNLESS(emitter->has_view, CAMERA) |
           UNLESS(emitter->has_view && size_is_on_paper(&picture->size), ON_PAPER) |
           UNLESS(strcmp(emitter->extension, "pov") == 0, POVRAY) |
           UNLESS(strcmp(emitter->extension, "scad") == 0, OPENSCAD) |
           UNLESS(!emitter->of_meshes, VESSELS) | UNLESS(!emitter->of_meshes || mesh, MODELS);
}

static const OptionTable own_table = {OPTION_ROWS(own), .settle = settle, .unmet = unmet};

const Command command_scene = {
    .name = "scene",
    .summary = "write a tree as a scene for POV-Ray, OpenSCAD or Tachyon",
    .operands = "T.swc -o S.pov|S.scad|S.tachyon",
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
};
