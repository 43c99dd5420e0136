/* A format is a row: what it is called, what it can hold, and a function that appends it to texts.
 * The texts flow into temporary files that take their names together once all is written, so that a
 * failure half way leaves what the user had. What goes to standard output is held until then, so
 * that who reads it gets all or nothing. */
#include "emit/rows.h"

#include <string.h>

const Emitter emitters[] = {
    {.name = "povray",
     .extension = "pov",
     .second_extension = "inc",
     .second_holds = "the geometry",
     .settings_extension = "ini",
     .description = "a scene for POV-Ray 3.7",
     .has_view = true,
     .elements = MODEL_PRIMITIVES | MODEL_FIELD | MODEL_TRIANGLES,
     .check_name = povray_check_name,
     .write = povray_write,
     .write_settings = povray_write_settings},
    {.name = "openscad",
     .extension = "scad",
     .description = "a parametric model for OpenSCAD",
     .elements = MODEL_CYLINDERS | MODEL_BALLS,
     .write = openscad_write},
    {.name = "tachyon",
     .extension = "tachyon",
     .description = "a scene for Tachyon 0.99",
     .has_view = true,
     .elements = MODEL_CYLINDERS | MODEL_BALLS | MODEL_TRIANGLES,
     .write = tachyon_write},
    {.name = "polyhedron",
     .extension = "scad",
     .description = "one closed surface for OpenSCAD",
     .of_meshes = true,
     .write = openscad_write_mesh},
    {.name = "stl",
     .extension = "stl",
     .description = "triangles for printers and CAD",
     .binary = true,
     .of_meshes = true,
     .write = stl_write},
    {.name = "stl-parts",
     .extension = "stl",
     .description = "triangles of named parts for solvers",
     .of_meshes = true,
     .has_parts = true,
     .option = "parts",
     .write = stl_write_parts},
    {.name = "vtp",
     .extension = "vtp",
     .description = "triangles of named parts for VTK and SimVascular",
     .binary = true,
     .of_meshes = true,
     .has_parts = true,
     .write = vtp_write_mesh},
    {.name = "ply",
     .extension = "ply",
     .description = "triangles with normals and the segment of each",
     .binary = true,
     .of_meshes = true,
     .has_colors = true,
     .write = ply_write},
    {.name = "glb",
     .extension = "glb",
     .description = "binary glTF 2.0",
     .binary = true,
     .of_meshes = true,
     .has_colors = true,
     .write = glb_write},
    {.name = "obj",
     .extension = "obj",
     .second_extension = "mtl",
     .second_holds = "the materials",
     .description = "triangles in groups, and their materials",
     .of_meshes = true,
     .has_colors = true,
     .check_name = obj_check_name,
     .write = obj_write},
    {.name = "3mf",
     .extension = "3mf",
     .description = "triangles and their colours for printers",
     .binary = true,
     .of_meshes = true,
     .has_colors = true,
     .write = threemf_write},
    {.name = "blender",
     .extension = "py",
     .description = "a script that makes curves in Blender",
     .of_lines = true,
     .has_colors = true,
     .write = blender_write},
    {.name = "usd",
     .extension = "usda",
     .description = "curves as Universal Scene Description",
     .of_lines = true,
     .has_colors = true,
     .write = usd_write},
    {.name = "lattice",
     .extension = "3mf",
     .description = "a lattice of beams for printers",
     .binary = true,
     .of_lines = true,
     .has_colors = true,
     .option = "lattice",
     .write = lattice_write},
    {.name = "mesh2",
     .extension = "inc",
     .description = "a mesh2 for POV-Ray 3.7",
     .of_meshes = true,
     .has_colors = true,
     .write = povray_write_mesh},
    {0},
};

static bool is_of_scenes(const Emitter *emitter)
{
    return !emitter->of_meshes && !emitter->of_lines;
}

/* Whether its extension stands for it among those of scenes, or of meshes and lines. */
static bool is_listed(const Emitter *emitter, bool of_meshes)
{
    return is_of_scenes(emitter) != of_meshes && !emitter->option;
}

const Emitter *emitter_find(const char *extension, bool of_meshes)
{
    for (const Emitter *emitter = emitters; emitter->name; emitter++)
        if (is_listed(emitter, of_meshes) && strcmp(emitter->extension, extension) == 0)
            return emitter;
    return NULL;
}

const Emitter *emitter_asked(const char *extension, const char *option)
{
    for (const Emitter *emitter = emitters; emitter->name; emitter++)
        if (emitter->option && strcmp(emitter->option, option) == 0 &&
            strcmp(emitter->extension, extension) == 0)
            return emitter;
    return NULL;
}

void emitter_extensions(bool of_meshes, Text *out)
{
    size_t n = 0, at = 0;
    for (const Emitter *emitter = emitters; emitter->name; emitter++)
        n += is_listed(emitter, of_meshes);
    for (const Emitter *emitter = emitters; emitter->name; emitter++)
        if (is_listed(emitter, of_meshes)) {
            text_puts(out, at == 0 ? "." : at + 1 == n ? " or ." : ", .");
            text_puts(out, emitter->extension);
            at++;
        }
}

Status emit_check_model(const Emitter *emitter, SceneModel model, Err *err)
{
    if (!is_of_scenes(emitter) || model_is_of(model, emitter->elements))
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "`model` %s: %s holds %s", models[model].name,
                   emitter->description, models_of(emitter->elements).text);
}

/* What is written: the file, the second one, the settings, and what stands beside. Those that there
 * are stand in `files` one after another. */
enum { SETTINGS = 2, BESIDE = 3, OUTPUTS = BESIDE + BESIDES };

typedef struct Outputs {
    Text text[OUTPUTS];
    const char *path[OUTPUTS]; /* NULL: there is none */
    OutFile files[OUTPUTS];
    size_t n;
} Outputs;

static Status open_outputs(Outputs *outputs, Err *err)
{
    for (size_t i = 0; i < OUTPUTS; i++) {
        OutFile *file = &outputs->files[outputs->n];
        if (!outputs->path[i])
            continue;
        TRY(outfile_open(file, outputs->path[i], err));
        outputs->text[i] = file->stream == stdout ? TEXT_INIT : TEXT_TO(file->stream);
        outputs->n++;
    }
    return STATUS_OK;
}

/* Names the file that could not be written in a failure of I/O. Returns `status`. */
static Status with_path(Status status, const Outputs *outputs, Err *err)
{
    size_t i = 0;
    while (i + 1 < outputs->n && !ferror(outputs->files[i].stream))
        i++;
    if (status == STATUS_IO)
        err_prefix(err, "%s: ", outputs->files[i].path);
    return status;
}

/* Hands what has not flowed yet over to the text's stream. */
static Status end_output(Text *text, FILE *stream, Err *err)
{
    Text held = TEXT_TO(stream);
    if (stream != stdout)
        return text_flush(text, err);
    text_add(&held, text);
    Status status = text_flush(&held, err);
    text_release(&held);
    return status;
}

static Status fill_outputs(const Emitter *emitter, const EmitParams *params, Outputs *outputs,
                           EmitReport *report, Err *err)
{
    Text *text = outputs->text;
    EmitOutput to = {&text[0], &text[1], report};
    TRY(emitter->write(params, &to, err));
    if (params->settings)
        TRY(emitter->write_settings(params, &text[SETTINGS], err));
    for (size_t i = 0; i < BESIDES; i++)
        if (params->beside[i])
            text_add(&text[BESIDE + i], params->beside[i]);
    for (size_t i = 0, n = 0; i < OUTPUTS; i++)
        if (outputs->path[i])
            TRY(end_output(&text[i], outputs->files[n++].stream, err));
    return STATUS_OK;
}

Status emit_files(const Emitter *emitter, const EmitParams *params, const char *path,
                  const char *second_path, EmitReport *report, Err *err)
{
    Outputs outputs = {.path = {path, second_path, params->settings_path}};
    EmitReport written = {0};
    Status status;
    if (is_of_scenes(emitter))
        TRY(emit_check_model(emitter, params->scene->geometry.model, err));
    if (second_path && emitter->check_name)
        TRY(emitter->check_name(params->second_file, err));
    for (size_t i = 0; i < BESIDES; i++)
        outputs.path[BESIDE + i] = params->beside_path[i];
    TRY_GOTO(open_outputs(&outputs, err));
    TRY_GOTO(with_path(fill_outputs(emitter, params, &outputs, &written, err), &outputs, err));
    TRY_GOTO(outfiles_commit(outputs.files, outputs.n, err));
    if (report)
        *report = written;
done:
    for (size_t i = 0; i < OUTPUTS; i++) {
        text_release(&outputs.text[i]);
        outfile_discard(&outputs.files[i]);
    }
    return status;
}
