/* Runs the operation `scene`: writes a tree as a scene file for POV-Ray, OpenSCAD or Tachyon. The
 * extension of the output selects the format. A model for OpenSCAD has one of two forms: calls of
 * modules, which OpenSCAD must unite at about half a second per vessel, or one closed surface. If
 * no option selects the form, the number of vessels does. */
#include "job/export/scene.h"

#include "job/export/meshing.h"
#include "job/export/scenefiles.h"
#include "job/picture/picture.h"
#include <string.h>

/* The form of a model for OpenSCAD. */
typedef enum ScadForm {
    SCAD_AUTO,       /* the number of vessels selects the form */
    SCAD_PARAMETRIC, /* modules, which OpenSCAD unites */
    SCAD_POLYHEDRON  /* one closed surface */
} ScadForm;

typedef struct SceneOptions {
    const char *output; /* its extension selects the format */
    bool ids;           /* adds the ids that POV-Ray needs to draw the id plane */
    bool ini;           /* also writes the settings file */
    ScadForm scad;
    PictureOptions picture;
} SceneOptions;

static const char *const scad_forms[] = {
    [SCAD_AUTO] = "auto", [SCAD_PARAMETRIC] = "parametric", [SCAD_POLYHEDRON] = "polyhedron", NULL};

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, SceneOptions, output),
     .is_told = true,
     .argument = "S.pov|S.scad|S.tachyon",
     .help = "file to write: a scene for POV-Ray (S.pov, with the geometry in S.inc beside it), "
             "a model for OpenSCAD (S.scad) or a scene for Tachyon (S.tachyon)"},
    {BEAT_OPTION(SceneOptions, picture.beat), .when = WHEN(POVRAY)},
    {.name = "ids",
     SETS(SWITCH, SceneOptions, ids),
     .group = GROUP_POVRAY,
     .when = WHEN(FIELD_IDS) | WHEN(POVRAY),
     .help = "for --model isosurface and blob only: add the data from which POV-Ray can render "
             "the id plane, which has the segment of each pixel"},
    {.name = "ini",
     SETS(SWITCH, SceneOptions, ini),
     .group = GROUP_POVRAY,
     .when = WHEN(POVRAY),
     .help = "also write S.ini, with the size, antialiasing and animation of the scene, so that "
             "`povray S.ini` renders the image"},
    {.name = "scad",
     SETS(CHOICE, SceneOptions, scad),
     .choices = scad_forms,
     .group = GROUP_VESSELS,
     .when = WHEN(OPENSCAD),
     .help = "OpenSCAD only: kind of model: parametric (modules with sliders in the customizer), "
             "polyhedron (one closed surface), auto (parametric for few vessels, polyhedron for "
             "many)"},
};

static void set_defaults(void *options)
{
    SceneOptions *own_options = options;
    picture_set_defaults(&own_options->picture);
}

/* Checks the options against the format. */
static Status check(const SceneOptions *options, const Emitter *emitter, Err *err)
{
    const PictureOptions *picture = &options->picture;
    const SceneModel model =
        picture->as_mesh ? model_with(MODEL_TRIANGLES) : (SceneModel)picture->model;
    if (options->ini && strcmp(options->output, "-") == 0)
        return err_set(err, STATUS_USAGE,
                       "--ini writes a file beside S.pov; it cannot be used with standard output");
    TRY(picture_check_povray(picture, err));
    if (picture->beat > 0 && picture->coloring.frame == 0 &&
        !model_is_of(model, MODEL_CYLINDERS | MODEL_BALLS))
        return err_set(err, STATUS_USAGE,
                       "--beat is for --model rounded and cylinders, unless --moment selects one "
                       "time step");
    return emit_check_model(emitter, model, err);
}

/* Returns the form of a model for OpenSCAD that the options select; SCAD_AUTO if they select
 * none. */
static ScadForm selected_form(const SceneOptions *options, const Parsed *parsed)
{
    if (options->scad != SCAD_AUTO)
        return options->scad;
    if (model_has(options->picture.model, MODEL_TRIANGLES))
        return SCAD_POLYHEDRON;
    bool of_vessels = options_typed(parsed, "model") || options_typed(parsed, "look") ||
                      options_typed(parsed, "color-by");
    return of_vessels ? SCAD_PARAMETRIC : SCAD_AUTO;
}

/* Finds the emitter for an output. The form matters only for .scad: SCAD_POLYHEDRON selects the
 * emitter of meshes. All other outputs have an emitter of scenes; standard output and a missing
 * output have the emitter for POV-Ray. */
static Status find_emitter(const char *output, ScadForm form, const Emitter **emitter, Err *err)
{
    const char *name = output && strcmp(output, "-") ? output : "scene.pov";
    bool scad = strcmp(file_extension(name), "scad") == 0;
    return scene_files_find(name, scad && form == SCAD_POLYHEDRON, emitter, err);
}

/* Selects the form by the number of vessels. Sends a note if it selects a surface. */
static ScadForm form_by_size(const Tree *tree, const char *output, const Talk *talk)
{
    size_t n = 0;
    for (size_t i = 0; i < tree->n; i++)
        n += tree_is_segment(tree, i);
    if (n <= OPENSCAD_QUICK)
        return SCAD_PARAMETRIC;
    talk_note(talk,
              "OpenSCAD would take too long to join %zu vessels (limit %d), so %s is one closed "
              "surface; use --scad parametric to write modules instead",
              n, OPENSCAD_QUICK, output);
    return SCAD_POLYHEDRON;
}

/* ---- the scene in memory --------------------------------------------------------------------- */

/* A scene in memory, or a surface if the format stores meshes. All members except `emitter` are
 * owned. */
typedef struct SceneResult {
    const Emitter *emitter; /* the format that the result was made for */
    PictureSource source;   /* the tree; if the emitter writes meshes, the tree has moved to
                             * `mesh` */
    Scene scene;            /* set if the emitter writes scenes, as is `anatomy` */
    Anatomy anatomy;
    MeshResult mesh; /* set if the emitter writes meshes */
    FileSet files;   /* the files of options->output */
} SceneResult;

static Status make_scene(const PictureOptions *picture, const Parsed *parsed, SceneResult *made,
                         Err *err)
{
    PictureReport report;
    TRY(picture_scene_of(picture, &made->source, parsed, &made->scene, &made->anatomy, &report,
                         err));
    TRY(picture_report(&made->scene, &report, parsed->common.talk, err));
    return made->emitter->has_view
               ? picture_report_effects(picture, "the scene omits them", parsed->common.talk, err)
               : STATUS_OK;
}

/* Selects the final emitter, now that the number of vessels is known, and records the output
 * files. */
static Status settle_format(const SceneOptions *options, Parsed *parsed, SceneResult *made,
                            Err *err)
{
    bool form_is_open = strcmp(made->emitter->extension, "scad") == 0 &&
                        selected_form(options, parsed) == SCAD_AUTO;
    if (form_is_open)
        TRY(find_emitter(options->output,
                         form_by_size(&made->source.of.tree, options->output, parsed->common.talk),
                         &made->emitter, err));
    TRY(scene_files_name(made->emitter, options->output, options->ini, &made->files, err));
    return work_note_files(&made->files, &parsed->files, err);
}

/* Reads the tree and makes the scene, or the surface if the format stores meshes. */
static Status make(const SceneOptions *options, Parsed *parsed, SceneResult *made, Err *err)
{
    const PictureOptions *picture = &options->picture;
    const MeshingOptions meshing = {.tolerance = picture->tolerance,
                                    .part_overlaps = picture->part_overlaps};
    TRY(find_emitter(options->output, selected_form(options, parsed), &made->emitter, err));
    TRY(check(options, made->emitter, err));
    TRY(picture_read_source(picture, parsed, &made->source, err));
    TRY(settle_format(options, parsed, made, err));
    return made->emitter->of_meshes ? meshing_make(made->emitter, &meshing, &made->source.of,
                                                   &parsed->common, &made->mesh, err)
                                    : make_scene(picture, parsed, made, err);
}

static void sceneresult_release(SceneResult *scene)
{
    picture_source_release(&scene->source);
    scene_release(&scene->scene);
    anatomy_release(&scene->anatomy);
    meshing_release(&scene->mesh);
    fileset_release(&scene->files);
}

/* ---- its files ------------------------------------------------------------------------------- */

/* The job of writing a scene. All pointers are borrowed. */
typedef struct SceneWriting {
    const SceneOptions *options;
    const SceneResult *made;
    EmitReport *report;
} SceneWriting;

static Status put_scene(const void *job, const char *command, FileSlot files[], Err *err)
{
    const SceneWriting *writing = job;
    const SceneResult *made = writing->made;
    const PictureOptions *picture = &writing->options->picture;
    const EmitParams params = {.scene = &made->scene,
                               .anatomy = &made->anatomy,
                               .command = command,
                               .antialias = picture->antialias,
                               .digits = EMIT_DIGITS,
                               .shadows = picture->stage.shadows,
                               .occlusion = picture->occlusion > 0,
                               .ids = writing->options->ids,
                               .cells = picture_cells(picture)};
    return scene_files_put(made->emitter, &params, made->source.of.path, files, writing->report,
                           err);
}

/* Sends notes about the limits of the file: ids that do not fit, joints that became meshes, and the
 * time that OpenSCAD takes. */
static void say_limits(const SceneResult *made, const EmitReport *report, const Talk *talk)
{
    Err misfit;
    const Geometry *geometry = &made->scene.geometry;
    if (made->emitter->has_view &&
        picture_check_ids(geometry, made->source.of.path, &misfit) != STATUS_OK)
        talk_note(talk, "%s", misfit.text);
    if (report->joint_sides > 0)
        talk_note(talk,
                  "POV-Ray cannot hold this many exact joints; they are meshes with %d sides (more "
                  "with Declare=Joint_Sides=N)",
                  report->joint_sides);
    if (report->openscad_s > 0 && geometry->drawn > OPENSCAD_QUICK)
        talk_note(talk,
                  "OpenSCAD needs about %.2g s to join %zu vessels to a solid; its preview is "
                  "fast; --scad polyhedron writes a finished solid",
                  report->openscad_s, geometry->drawn);
}

static Status write(const SceneOptions *options, const Parsed *parsed, SceneResult *scene, Err *err)
{
    EmitReport report = {0};
    const SceneWriting writing = {options, scene, &report};
    if (scene->emitter->of_meshes)
        return meshing_write(&scene->mesh, &scene->files, parsed, err);
    TRY(work_write(&scene->files, put_scene, &writing, parsed, err));
    say_limits(scene, &report, parsed->common.talk);
    return STATUS_OK;
}

Status scene_run(void *options, Parsed *parsed, Err *err)
{
    SceneResult scene = {0};
    Status status = make(options, parsed, &scene, err);
    if (status == STATUS_OK)
        status = write(options, parsed, &scene, err);
    sceneresult_release(&scene);
    return status;
}

/* Returns the emitter for the output; NULL if there is none. Such an output is refused later. */
static const Emitter *emitter_of(const SceneOptions *options, const Parsed *parsed)
{
    const Emitter *emitter;
    return find_emitter(options->output, selected_form(options, parsed), &emitter, NULL) ==
                   STATUS_OK
               ? emitter
               : NULL;
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
