/* Finds the format of a scene, a surface or curves by its extension, and calls its writer. A table
 * has one row per format. A row has the name of a format, its capabilities, and the function that
 * writes it. */
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
#ifndef CORCAST_PAGE /* the web page that grows trees [web/] writes only STL */
    FORMAT("povray", "pov", "a scene for POV-Ray 3.7", povray_write, .has_view = true,
           .elements = MODEL_ELEMENTS, .second_extension = "inc", .second_content = "the geometry",
           .settings_extension = "ini", .check_name = povray_check_name,
           .write_settings = povray_write_settings),
    FORMAT("openscad", "scad", "a parametric model for OpenSCAD", openscad_write,
           .elements = MODEL_CYLINDERS | MODEL_BALLS),
    FORMAT("tachyon", "tachyon", "a scene for Tachyon 0.99", tachyon_write, .has_view = true,
           .elements = MODEL_CYLINDERS | MODEL_BALLS | MODEL_TRIANGLES),
    OF_MESHES("polyhedron", "scad", "one closed surface for OpenSCAD", openscad_write_mesh,
              .binary = false),
#endif
    OF_MESHES("stl", "stl", "triangles for printers and CAD", stl_write, .binary = true),
#ifndef CORCAST_PAGE
    OF_MESHES("stl-parts", "stl", "triangles of named parts for solvers", stl_write_parts,
              .has_parts = true, .option = "parts"),
    OF_MESHES("vtp", "vtp", "triangles of named parts for VTK and SimVascular", vtp_write_mesh,
              .binary = true, .has_parts = true),
    OF_MESHES("gmsh", "msh", "layers of prisms and named parts for gmsh", gmsh_write,
              .has_parts = true, .has_layers = true),
    OF_MESHES("vtu", "vtu", "layers of prisms and named parts for VTK", vtu_write_layers,
              .binary = true, .has_parts = true, .has_layers = true),
    OF_MESHES("ply", "ply", "triangles with normals and the segment of each", ply_write,
              .binary = true, .has_colors = true),
    OF_MESHES("glb", "glb", "binary glTF 2.0", glb_write, .binary = true, .has_colors = true),
    OF_MESHES("obj", "obj", "triangles in groups, and their materials", obj_write,
              .has_colors = true, .second_extension = "mtl", .second_content = "the materials",
              .check_name = obj_check_name),
    OF_MESHES("3mf", "3mf", "triangles and their colors for printers", threemf_write,
              .binary = true, .has_colors = true),
    OF_LINES("blender", "py", "a script that makes curves in Blender", blender_write,
             .binary = false),
    OF_LINES("usd", "usda", "curves as Universal Scene Description", usd_write, .binary = false),
    OF_LINES("lattice", "3mf", "a lattice of beams for printers", lattice_write, .binary = true,
             .option = "lattice"),
    OF_MESHES("mesh2", "inc", "a mesh2 for POV-Ray 3.7", povray_write_mesh, .has_colors = true),
#endif
    {0},
};

static bool is_of_scenes(const Emitter *emitter)
{
    return !emitter->of_meshes && !emitter->of_lines;
}

/* Returns true if the emitter is the default of its extension, among emitters of meshes and curves
 * if `meshes_or_curves`, else among emitters of scenes. */
static bool is_listed(const Emitter *emitter, bool meshes_or_curves)
{
    return is_of_scenes(emitter) != meshes_or_curves && !emitter->option;
}

const Emitter *emitter_find(const char *extension, bool meshes_or_curves)
{
    for (const Emitter *emitter = emitters; emitter->name; emitter++)
        if (is_listed(emitter, meshes_or_curves) && strcmp(emitter->extension, extension) == 0)
            return emitter;
    return NULL;
}

const Emitter *emitter_by_option(const char *extension, const char *option)
{
    for (const Emitter *emitter = emitters; emitter->name; emitter++)
        if (emitter->option && strcmp(emitter->option, option) == 0 &&
            strcmp(emitter->extension, extension) == 0)
            return emitter;
    return NULL;
}

void emitter_extensions(bool meshes_or_curves, Text *out)
{
    size_t n = 0, at = 0;
    for (const Emitter *emitter = emitters; emitter->name; emitter++)
        n += is_listed(emitter, meshes_or_curves);
    for (const Emitter *emitter = emitters; emitter->name; emitter++)
        if (is_listed(emitter, meshes_or_curves)) {
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

Status emit_write(const Emitter *emitter, const EmitParams *params, EmitOutput *to, Err *err)
{
    if (is_of_scenes(emitter))
        TRY(emit_check_model(emitter, params->scene->geometry.model, err));
    if (params->second_file && emitter->check_name)
        TRY(emitter->check_name(params->second_file, err));
    to->file->digits = params->digits;
    if (to->second)
        to->second->digits = params->digits;
    TRY(emitter->write(params, to, err));
    return params->settings ? emitter->write_settings(params, to->settings, err) : STATUS_OK;
}
