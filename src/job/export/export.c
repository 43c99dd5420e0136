/* Runs the operation `export`: writes the vessels as a mesh or lines (meshing.c), as a volume of
 * voxels (volumes.c) or as a web page (webpage.c). The extension of the output selects the format.
 * Some extensions have a second format, which an option selects. An emitter is the writer of one
 * format [emit/emit.h]. */
#include "job/export/export.h"

#include "emit/emit.h"
#include "job/export/scenefiles.h"
#include "job/export/webpage.h"
#include "job/picture/picture.h"
#include "options/talk.h"
#include <string.h>

/* Maximum number of triangles of a .glb, about 3 MB, that is not too large for a web page. Above
 * it, a note suggests --lod. Larger: fewer notes. */
enum { MANY_TRIANGLES = 100000 };

/* Options of a surface have no effect on volumes and pages. */
#define OF_SURFACE WHEN(NO_VOLUME) | WHEN(NO_PAGE)

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, ExportOptions, output),
     .argument = "M.stl",
     .help = "file to write; its extension selects the format: a mesh (M.stl), curves, a volume "
             "of voxels (V.nii.gz) or an interactive web page (P.html)"},
    {.name = "model",
     SETS(CHOICE, ExportOptions, meshing.body),
     .choices = vessel_body_names,
     .group = GROUP_VESSELS,
     .when = WHEN(MESH) | OF_SURFACE,
     .help = "surface of the vessels: isosurface (blends vessels smoothly where they meet), "
             "rounded (cylinders with spheres at their ends)"},
    {.name = "mesh-tolerance",
     .former = "tolerance",
     SETS(NUMBER, ExportOptions, meshing.tolerance),
     .group = GROUP_VESSELS,
     .range = &tolerance_range,
     .when = WHEN(MESH) | OF_SURFACE,
     .help = "maximum distance of the triangles from the exact surface, as a fraction of the local "
             "radius"},
    {.name = "lod",
     SETS(NUMBER, ExportOptions, meshing.lod),
     .group = GROUP_VESSELS,
     FROM_TO(RANGE_ABOVE_0, 1),
     .when = WHEN(MESH) | OF_SURFACE,
     .help = "approximate fraction of the triangles to keep; smaller values move the triangles "
             "farther from the exact surface"},
    {.name = "tube-edge",
     SETS(NUMBER, ExportOptions, meshing.tube_edge),
     .group = GROUP_VESSELS,
     FROM_TO(0.05, 1e6),
     .otherwise = "as long as the tube",
     .when = WHEN(MESH) | OF_SURFACE,
     .help = "maximum edge length of the triangles along a straight tube, in units of its radius; "
             "set it for flow solvers"},
    {SMOOTH_OPTION(ExportOptions, smooth), .when = WHEN(NO_PAGE)},
    {.name = "prune-radius",
     SETS(NUMBER, ExportOptions, prune_radius_mm),
     .group = GROUP_VESSELS,
     .range = &prune_range,
     .unit = "mm",
     .otherwise = "0",
     .help = "radius below which segments are dropped, with their subtrees; 0 drops none"},
    {.name = "part-overlaps",
     SETS(FLAG, ExportOptions, meshing.part_overlaps),
     .group = GROUP_VESSELS,
     .when = WHEN(MESH) | OF_SURFACE,
     .help = "make overlapping vessels that are not connected thinner, until they no longer touch"},
    {.name = "parts",
     SETS(FLAG, ExportOptions, parts),
     .group = GROUP_VESSELS,
     .when = OF_SURFACE,
     .help = "for STL only: write the wall and each vessel end as a named solid, in text form. "
             "VTP, gmsh and VTU files always have these parts"},
    {.name = "layers",
     SETS(WHOLE, ExportOptions, meshing.layers.n_layers),
     .group = GROUP_VESSELS,
     FROM_TO(1, LAYERS_MAX),
     .when = WHEN(LAYERS) | OF_SURFACE,
     .help = "number of layers of prisms along the wall, for flow solvers; gmsh and VTU only"},
    {.name = "layer-thickness",
     SETS(NUMBER, ExportOptions, meshing.layers.thickness),
     .group = GROUP_VESSELS,
     FROM_TO(0.001, 0.5),
     .when = WHEN(LAYERS) | OF_SURFACE,
     .help = "thickness of all --layers together, as a fraction of the local radius. Layers are "
             "thinner where their prisms would be inverted and where walls are near each other"},
    {.name = "layer-growth",
     SETS(NUMBER, ExportOptions, meshing.layers.growth),
     .group = GROUP_VESSELS,
     FROM_TO(1, 2),
     .when = WHEN(LAYERS) | OF_SURFACE,
     .help = "thickness of a layer divided by the thickness of the next layer towards the wall"},
    {.name = "lattice",
     SETS(FLAG, ExportOptions, lattice),
     .group = GROUP_VESSELS,
     .when = OF_SURFACE,
     .help = "3MF only: describe the vessels by exact beams, one per segment (a beam lattice); "
             "the mesh in the file is then only a preview"},
    {.name = "wall",
     SETS(NUMBER, ExportOptions, wall_mm),
     .group = GROUP_VESSELS,
     FROM_TO(RANGE_ABOVE_0, 1e6),
     .unit = "mm",
     .otherwise = "no wall",
     .when = WHEN(NAMED_PARTS) | OF_SURFACE,
     .help = "thickness of a solid wall around the vessels: a second, outer surface is added at "
             "this distance. For files with named parts only (VTP, or STL with --parts)"},
    {.name = "print",
     SETS(TEXT, ExportOptions, print),
     .argument = "KEY=VALUE,...",
     .group = GROUP_VESSELS,
     .otherwise = "",
     .when = WHEN(MESH) | OF_SURFACE,
     .help = "prepare the model for a 3D printer, by a list of keys in any order; each may be "
             "omitted. scale=N multiplies all lengths of the tree by N (default 1); the following "
             "lengths are those of the print, in mm. min-diameter=MM thickens vessels thinner "
             "than MM to MM; with thin=prune they are dropped instead, with their subtrees. "
             "nozzle=MM, the diameter of the nozzle, makes it an error if the widest vessel or a "
             "wall is thinner. wall=MM makes each vessel a tube with a wall of MM; wall=0.2r "
             "makes the wall 0.2 times as thick as the vessel's radius. base or base=MM adds a "
             "plate of 2 or MM below the model, with support pins. block=box or block=cylinder "
             "makes the vessels channels in a block, instead of wall and base; its faces are at "
             "least margin=MM (default 3) away from the vessels, and ports extends the ends of "
             "the vessels to the faces, so that the channels are open. bed=AxBxC, the printer's "
             "build space, makes it an error if the model does not fit. docs/MAKERS.md describes "
             "all values"},
    {.name = "look",
     SETS(LOOKUP, ExportOptions, meshing.look),
     .group = GROUP_COLOR,
     .list = "looks",
     .when = WHEN(COLORS),
     .help = "look that sets the color and finish of the surface: a name, or the path, with a "
             "'/', of a file of your own, such as ./my.ini"},
};

/* Three layers that each grow by 1.3 towards the core, together a fifth of the radius; reasons of
 * these values not recorded. */
static void set_defaults(void *options)
{
    ExportOptions *own_options = options;
    own_options->meshing.tolerance = MESHING_TOLERANCE;
    own_options->meshing.lod = 1;
    own_options->meshing.layers = (LayerParams){.n_layers = 3, .thickness = 0.2, .growth = 1.3};
    own_options->meshing.look = "cast";
    coloring_set_defaults(&own_options->meshing.coloring);
}

/* Finds the emitter that --parts or --lattice selects, or else the default emitter for the
 * extension of the output. */
static Status find_emitter(const ExportOptions *options, const Emitter **emitter, Err *err)
{
    const Emitter *asked = NULL;
    TRY(scene_files_find(options->output, true, emitter, err));
    if (options->parts)
        asked = emitter_by_option((*emitter)->extension, "parts");
    else if (options->lattice)
        asked = emitter_by_option((*emitter)->extension, "lattice");
    else
        return STATUS_OK;
    if (options->parts && !asked && !(*emitter)->has_parts)
        return err_set(
            err, STATUS_USAGE,
            "--parts needs an .stl, .vtp, .msh or .vtu output, whose formats store names of parts");
    if (options->lattice && !asked)
        return err_set(err, STATUS_USAGE,
                       "--lattice needs a .3mf output, whose format stores beams");
    *emitter = asked ? asked : *emitter;
    return STATUS_OK;
}

/* Reads --wall and --print into options->settings. Errors: STATUS_USAGE if they exclude each other,
 * or if the format or the model cannot have a wall or a print. */
static Status read_print(ExportOptions *options, const Emitter *emitter, Err *err)
{
    PrintSettings *print = &options->settings;
    if (!options->print && options->wall_mm == 0)
        return STATUS_OK;
    if (options->print && options->wall_mm > 0)
        return err_set(err, STATUS_USAGE,
                       "--wall and --print exclude each other; use the key wall= of --print");
    TRY(printing_parse(options->print ? options->print : "", print, err));
    if (options->wall_mm > 0)
        print->params = (PrintParams){.wall_mm = options->wall_mm, .lids = true};
    options->meshing.print = print;
    if (print->prunes)
        options->prune_radius_mm =
            fmax(options->prune_radius_mm, print->min_diameter_mm / print->scale / 2);
    if (!strcmp(emitter->name, "mesh2"))
        return err_set(
            err, STATUS_USAGE,
            "`print` needs an output that stores solids; .inc is part of a POV-Ray scene");
    if (emitter->has_layers)
        return err_set(err, STATUS_USAGE,
                       "`%s` cannot be combined with layers of prisms (.msh and .vtu); write an "
                       ".stl or .vtp",
                       options->print ? "print" : "wall");
    if (print_is_joined(&print->params) && options->meshing.body != BODY_POTENTIAL)
        return err_set(
            err, STATUS_USAGE,
            "`%s`: walls, blocks and bases need flat vessel ends; use --model isosurface",
            options->print ? "print" : "wall");
    return STATUS_OK;
}

/* Finds the emitter of the mesh or the lines, and checks the options against it. Without an output,
 * the mesh is made as for a PLY file. */
static Status plan_mesh(ExportOptions *options, const Emitter **emitter, Err *err)
{
    if (options->output)
        TRY(find_emitter(options, emitter, err));
    else
        *emitter = emitter_find("ply", true);
    if ((*emitter)->has_parts && options->meshing.body == BODY_ROUND)
        return err_set(
            err, STATUS_USAGE,
            "--parts needs flat vessel ends, which `model` rounded lacks; use isosurface");
    return read_print(options, *emitter, err);
}

/* Reads the tree, and divides its segments into smooth curves if --smooth is on. `properties` are
 * the bits of ModelProperty of the exported model. */
static Status read_tree(const ExportOptions *options, unsigned properties, Parsed *parsed,
                        PictureTree *of, Err *err)
{
    TRY(picture_read_tree(&options->meshing.coloring, options->prune_radius_mm, parsed, of, err));
    const TreeMeta said = blood_specified(&options->meshing.coloring.blood);
    Status status = extension_apply(&options->extension, parsed, &of->tree, err);
    if (status == STATUS_OK)
        status = extension_report(&of->tree, &said, parsed->common.talk, err);
    if (status == STATUS_OK && options->smooth)
        status = picture_smooth_tree(of, model_with(properties), err);
    if (status != STATUS_OK)
        picture_tree_release(of);
    picture_report_smoothing(&of->smooth.report, parsed->common.talk);
    return status;
}

static Status make_mesh(const ExportOptions *options, const Emitter *emitter, Parsed *parsed,
                        MeshResult *mesh, Err *err)
{
    PictureTree of;
    TRY(read_tree(options, emitter->of_lines ? MODEL_VOXELS : MODEL_TRIANGLES, parsed, &of, err));
    return meshing_make(emitter, &options->meshing, &of, &parsed->common, mesh, err);
}

Status mesh_make(ExportOptions *options, Parsed *parsed, MeshResult *mesh, Err *err)
{
    const Emitter *emitter;
    TRY(plan_mesh(options, &emitter, err));
    return make_mesh(options, emitter, parsed, mesh, err);
}

static Status export_mesh(ExportOptions *options, Parsed *parsed, FileSet *files, Err *err)
{
    const Emitter *emitter;
    MeshResult mesh;
    TRY(plan_mesh(options, &emitter, err));
    TRY(scene_files_name(emitter, options->output, false, files, err));
    TRY(work_note_files(files, &parsed->files, err));
    TRY(make_mesh(options, emitter, parsed, &mesh, err));
    Status status = meshing_write(&mesh, files, parsed, err);
    if (status == STATUS_OK && mesh.mesh.n_triangles > MANY_TRIANGLES &&
        options->meshing.lod == 1 && strcmp(mesh.emitter->extension, "glb") == 0)
        talk_note(parsed->common.talk, "--lod 0.25 writes a quarter of the triangles for the web");
    meshing_release(&mesh);
    return status;
}

static Status export_volume(const ExportOptions *options, Parsed *parsed, FileSet *files, Err *err)
{
    const VolumeFormat *format = volume_format_find(options->output);
    PictureTree of;
    TRY(volumes_name(&options->volume, format, options->output, files, err));
    TRY(work_note_files(files, &parsed->files, err));
    TRY(read_tree(options, MODEL_VOXELS, parsed, &of, err));
    Status status = volumes_write(&options->volume, format, &of, files, parsed, err);
    picture_tree_release(&of);
    return status;
}

static Status export_page(const ExportOptions *options, const Parsed *parsed, FileSet *files,
                          Err *err)
{
    const Coloring *coloring = &options->meshing.coloring;
    PictureTree of;
    TRY(mem_strdup(&files->at[0].path, options->output, err));
    TRY(picture_read_tree(coloring, options->prune_radius_mm, parsed, &of, err));
    Status status = webpage_write(coloring, options->meshing.look, &of, files, parsed, err);
    picture_tree_release(&of);
    return status;
}

static bool is_page(const ExportOptions *options)
{
    return strcmp(file_extension(options->output), "html") == 0;
}

Status export_run(void *options, Parsed *parsed, Err *err)
{
    const char *output = ((const ExportOptions *)options)->output;
    FileSet files = {0};
    Status status = is_page(options)             ? export_page(options, parsed, &files, err)
                    : volume_format_find(output) ? export_volume(options, parsed, &files, err)
                                                 : export_mesh(options, parsed, &files, err);
    fileset_release(&files);
    return status;
}

/* Returns the emitter for the output; NULL for a volume or a page, and for an output that is
 * refused later. */
static const Emitter *emitter_of(const ExportOptions *options)
{
    const Emitter *emitter;
    if (!options->output)
        return emitter_find("ply", true);
    const bool found = !is_page(options) && !volume_format_find(options->output) &&
                       find_emitter(options, &emitter, NULL) == STATUS_OK;
    return found ? emitter : NULL;
}

/* A mesh with named ends states the flow through each end, so options about flow have an effect. A
 * page contains fields of the blood, so options about blood have an effect. */
static Status settle(void *set, const Parsed *parsed, Err *err)
{
    (void)parsed;
    (void)err;
    ExportOptions *options = set;
    const Emitter *emitter = emitter_of(options);
    options->meshing.coloring.uses_flow = emitter && emitter->has_parts;
    options->meshing.coloring.uses_blood = options->output && is_page(options);
    return STATUS_OK;
}

/* The format of the file decides which options have an effect. */
static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    (void)parsed;
    const ExportOptions *options = set;
    const Emitter *emitter = emitter_of(options);
    if (options->output && is_page(options))
        return WHEN(VOLUME) | WHEN(NO_PAGE) | WHEN(STEPS) | WHEN(ONE_MOMENT) | WHEN(WHOLE_RANGE);
    if (options->output && volume_format_find(options->output))
        return WHEN(COLORS) | WHEN(NO_VOLUME);
    return WHEN(VOLUME) |
           (emitter
                ? UNLESS(emitter->has_colors, COLORS) | UNLESS(emitter->of_meshes, MESH) |
                      UNLESS(emitter->has_parts, NAMED_PARTS) | UNLESS(emitter->has_layers, LAYERS)
                : 0);
}

static const OptionTable own_table = {OPTION_ROWS(own), .settle = settle, .unmet = unmet};

const Command command_export = {
    .name = "export",
    .summary = "write the vessels as a mesh, curves, voxels or an interactive web page",
    .operands = "T.swc -o M.stl",
    .examples = "  # a closed surface mesh\n"
                "  corcast export tree.swc -o tree.stl\n"
                "  # a mesh for the web, colored by Strahler order\n"
                "  corcast export tree.swc --color-by strahler -o tree.glb\n"
                "  # a mesh that deviates from the surface by at most 5 % of the radius\n"
                "  corcast export tree.swc --mesh-tolerance 0.05 -o tree.ply\n"
                "  # wall, inlets and outlets as separate parts, for a flow solver\n"
                "  corcast export tree.swc --parts -o tree.stl\n"
                "  # all ends are lengthened by 5 radii\n"
                "  corcast export tree.swc --extend 5 -o tree.vtp\n"
                "  # curves for Blender\n"
                "  corcast export tree.swc --color-by flow -o tree.py\n"
                "  # voxels of 0.1 mm, and the segment of each voxel\n"
                "  corcast export tree.swc --spacing 0.1 --labels segment -o tree.nii.gz\n"
                "  # an interactive web page\n"
                "  corcast export tree.swc --color-by flow -o tree.html\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
    .reads_tree = true,
    .size = sizeof(ExportOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0},
               {&volume_table, offsetof(ExportOptions, volume)},
               {&extension_table, offsetof(ExportOptions, extension)},
               COLORING_TABLES(ExportOptions, meshing.coloring)},
};
