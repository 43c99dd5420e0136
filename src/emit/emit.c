/* A format is a row: its name, what it can hold, and a function that appends it to texts. The texts
 * are written to temporary files, which get their final names together when all is written. After a
 * failure the user's files are therefore unchanged. Text for standard output is held back until
 * then, so that its reader gets all or nothing. */
#include "emit/rows.h"

#include <string.h>

#define FORMAT(named, ending, holds, writer, ...)                                                  \
    {                                                                                              \
        .name = named, .extension = ending, .description = holds, .write = writer, __VA_ARGS__     \
    }
#define OF_MESHES(named, ending, holds, writer, ...)                                               \
    FORMAT(named, ending, holds, writer, .of_meshes = true, __VA_ARGS__)
#define OF_LINES(named, ending, holds, writer, ...)                                                \
    FORMAT(named, ending, holds, writer, .of_lines = true, .has_colors = true, __VA_ARGS__)

const Emitter emitters[] = {
    FORMAT("povray", "pov", "a scene for POV-Ray 3.7", povray_write, .has_view = true,
           .elements = MODEL_ELEMENTS, .second_extension = "inc", .second_holds = "the geometry",
           .settings_extension = "ini", .check_name = povray_check_name,
           .write_settings = povray_write_settings),
    FORMAT("openscad", "scad", "a parametric model for OpenSCAD", openscad_write,
           .elements = MODEL_CYLINDERS | MODEL_BALLS),
    FORMAT("tachyon", "tachyon", "a scene for Tachyon 0.99", tachyon_write, .has_view = true,
           .elements = MODEL_CYLINDERS | MODEL_BALLS | MODEL_TRIANGLES),
    OF_MESHES("polyhedron", "scad", "one closed surface for OpenSCAD", openscad_write_mesh,
              .binary = false),
    OF_MESHES("stl", "stl", "triangles for printers and CAD", stl_write, .binary = true),
    OF_MESHES("stl-parts", "stl", "triangles of named parts for solvers", stl_write_parts,
              .has_parts = true, .option = "parts"),
    OF_MESHES("vtp", "vtp", "triangles of named parts for VTK and SimVascular", vtp_write_mesh,
              .binary = true, .has_parts = true),
    OF_MESHES("ply", "ply", "triangles with normals and the segment of each", ply_write,
              .binary = true, .has_colors = true),
    OF_MESHES("glb", "glb", "binary glTF 2.0", glb_write, .binary = true, .has_colors = true),
    OF_MESHES("obj", "obj", "triangles in groups, and their materials", obj_write,
              .has_colors = true, .second_extension = "mtl", .second_holds = "the materials",
              .check_name = obj_check_name),
    OF_MESHES("3mf", "3mf", "triangles and their colours for printers", threemf_write,
              .binary = true, .has_colors = true),
    OF_LINES("blender", "py", "a script that makes curves in Blender", blender_write,
             .binary = false),
    OF_LINES("usd", "usda", "curves as Universal Scene Description", usd_write, .binary = false),
    OF_LINES("lattice", "3mf", "a lattice of beams for printers", lattice_write, .binary = true,
             .option = "lattice"),
    OF_MESHES("mesh2", "inc", "a mesh2 for POV-Ray 3.7", povray_write_mesh, .has_colors = true),
    {0},
};

static bool is_of_scenes(const Emitter *emitter)
{
    return !emitter->of_meshes && !emitter->of_lines;
}

/* Returns true if its extension stands for it among those of scenes, or of meshes and lines. */
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
