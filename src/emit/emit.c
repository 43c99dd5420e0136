/* A format is a row: what it is called, what it can hold, and a function that appends it to texts.
 * The texts flow into temporary files that take their names together once all is written, so that a
 * failure half way leaves what the user had. */
#include "emit/rows.h"

#include <string.h>

const Emitter emitters[] = {
    {.name = "povray",
     .extension = "pov",
     .second_extension = "inc",
     .description = "a scene for POV-Ray 3.7",
     .has_view = true,
     .elements = MODEL_PRIMITIVES | MODEL_FIELD,
     .check_name = povray_check_name,
     .write = povray_write},
    {.name = "openscad",
     .extension = "scad",
     .description = "a parametric model for OpenSCAD",
     .elements = MODEL_CYLINDERS | MODEL_BALLS,
     .write = openscad_write},
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
    {.name = "ply",
     .extension = "ply",
     .description = "triangles with normals and the segment of each",
     .binary = true,
     .of_meshes = true,
     .write = ply_write},
    {0},
};

const Emitter *emitter_find(const char *extension, bool of_meshes)
{
    for (const Emitter *emitter = emitters; emitter->name; emitter++)
        if (emitter->of_meshes == of_meshes && strcmp(emitter->extension, extension) == 0)
            return emitter;
    return NULL;
}

void emitter_extensions(bool of_meshes, Text *out)
{
    size_t n = 0, at = 0;
    for (const Emitter *emitter = emitters; emitter->name; emitter++)
        n += emitter->of_meshes == of_meshes;
    for (const Emitter *emitter = emitters; emitter->name; emitter++)
        if (emitter->of_meshes == of_meshes) {
            text_puts(out, at == 0 ? "." : at + 1 == n ? " or ." : ", .");
            text_puts(out, emitter->extension);
            at++;
        }
}

Status emit_check_model(const Emitter *emitter, SceneModel model, Err *err)
{
    if (emitter->of_meshes || model_is_of(model, emitter->elements))
        return STATUS_OK;
    Text able = TEXT_INIT;
    models_of(emitter->elements, &able);
    Status status = err_set(err, STATUS_USAGE, "`model` %s: %s holds %s", models[model].name,
                            emitter->description, text_chars(&able));
    text_release(&able);
    return status;
}

/* Fills the files, of which there are one or two. */
static Status write_streams(const Emitter *emitter, const EmitParams *params, const OutFile *files,
                            EmitReport *report, Err *err)
{
    Text out = TEXT_TO(files[0].stream), second = TEXT_TO(files[1].stream);
    Status status = emitter->write(params, &out, &second, report, err);
    if (params->manifest)
        text_puts(&second, params->manifest);
    if (status == STATUS_OK)
        status = text_flush(&out, err);
    if (status == STATUS_OK)
        status = text_flush(&second, err);
    if (status == STATUS_IO)
        err_prefix(err, "%s: ", (ferror(files[0].stream) ? files[0] : files[1]).path);
    text_release(&out);
    text_release(&second);
    return status;
}

Status emit_files(const Emitter *emitter, const EmitParams *params, const char *path,
                  const char *second_path, EmitReport *report, Err *err)
{
    OutFile files[2] = {0};
    EmitReport written = {0};
    Status status;
    size_t n = second_path ? 2 : 1;
    if (!emitter->of_meshes)
        TRY(emit_check_model(emitter, params->scene->geometry.model, err));
    if (second_path && emitter->check_name)
        TRY(emitter->check_name(params->second_file, err));
    TRY_GOTO(outfile_open(&files[0], path, err));
    if (second_path)
        TRY_GOTO(outfile_open(&files[1], second_path, err));
    TRY_GOTO(write_streams(emitter, params, files, &written, err));
    TRY(outfiles_commit(files, n, err));
    if (report)
        *report = written;
    return STATUS_OK;
done:
    outfile_discard(&files[0]);
    outfile_discard(&files[1]);
    return status;
}
