/* The public header of the module emit: writes scenes, meshes and curves as files for other
 * programs, such as POV-Ray, Blender and OpenSCAD.
 *
 * Each file format is an Emitter, one row of the table `emitters`. A format writes one kind of
 * content: a scene (camera, lights, vessels), a triangle mesh, or curves along the vessels. The
 * caller fills EmitParams with the content and appends the result to texts:
 *
 *     const Emitter *emitter = emitter_find("pov", false);
 *     EmitOutput to = {.file = &file, .second = &second, .report = &report};
 *     TRY(emit_write(emitter, &params, &to, err));
 *
 * The fixed text of each language is in templates/. The C code adds numbers, and calls of macros
 * that the templates define. Lengths are mm. */
#ifndef CORCAST_EMIT_EMIT_H
#define CORCAST_EMIT_EMIT_H

#include "base/base.h"
#include "field/field.h"
#include "scene/scene.h"

/* The largest number of vessels that OpenSCAD unites quickly. Above it, a mesh is the better model.
 * Reason of the value not recorded. */
#define OPENSCAD_QUICK 100

/* Significant digits of the numbers in a scene. 9 digits give the same picture as all digits
 * [docs/POVRAY.md] and are easier to read. `verify` writes all digits. */
enum { EMIT_DIGITS = 9 };

/* The content of a file. All pointers are borrowed. The comment of a member names the emitters that
 * read it; other emitters ignore it. */
typedef struct EmitParams {
    const Scene *scene;           /* for emitters of scenes */
    const Anatomy *anatomy;       /* NULL: Strahler orders are 0, and trees have no names */
    const VesselMesh *mesh;       /* for emitters of meshes */
    const VesselTree *vessels;    /* for emitters of curves; and for emitters of meshes, where the
                                   * labels of the mesh are indices of its segments */
    const Appearance *appearance; /* for emitters with has_colors */
    const MeshEnds *ends;         /* for emitters with has_parts */
    const PrismLayers *layers;    /* for emitters with has_layers */
    const char *templates;        /* the folder of templates, with a folder for each language */
    const char *file;             /* name of the file, without folders, for comments in the file */
    const char *second_file;      /* name of the second file, without folders; NULL: one file has
                                   * all */
    const char *description;      /* description of the scene's content; line ends become blanks */
    const char *settings;         /* name of the settings file; NULL: none is written */
    int antialias;                /* samples along a side of a pixel; 1: the program's default */
    int digits;                   /* significant digits of doubles in scenes; 0: as many as read
                                   * back exactly */
    const char *generator;        /* name and version of corcast */
    const char *command;          /* the command line that makes the scene */
    bool shadows;                 /* lights cast shadows */
    bool occlusion;        /* the picture of `render` has ambient occlusion; the scene mentions it
                            * in a comment only */
    bool ids;              /* implicit surfaces: adds the colors by which the image of ids tells
                            * segments apart */
    bool planes;           /* Tachyon: colors encode depth and segment */
    CellParams cells;      /* isosurface */
    const CellTree *built; /* isosurface: its cells; NULL: they are computed */
    const PixelRect *part; /* POV-Ray: a rectangle of the picture. Objects that no ray through it
                            * can hit are not written; the other objects are unchanged. Requires
                            * `anatomy` to be NULL and, for an isosurface, `built`. NULL: all
                            * objects are written */
} EmitParams;

/* Facts about a written file. Members that do not apply to the format are 0. */
typedef struct EmitReport {
    size_t cells;      /* number of cells of an isosurface, or of a blob that is divided into cells;
                        * else 0 */
    int joint_sides;   /* number of sides of the mesh of a joint; 0: joints are exact shapes.
                        * POV-Ray can hold at most 349,000 exact joints [docs/POVRAY.md]. */
    double openscad_s; /* estimated time, in seconds, that OpenSCAD takes to unite the vessels; 0
                        * for other programs */
} EmitReport;

/* The texts that receive the files. All pointers are borrowed. */
typedef struct EmitOutput {
    Text *file;
    Text *second;       /* needed if params->second_file is not NULL */
    EmitReport *report; /* the caller zeroes it */
    Text *settings;     /* needed if params->settings is not NULL */
} EmitOutput;

/* A file format: one row of `emitters`. */
typedef struct Emitter {
    const char *name;               /* "povray" */
    const char *extension;          /* of its file: "pov" */
    const char *second_extension;   /* of its second file: "inc"; NULL: it has one file */
    const char *second_content;     /* "the geometry" */
    const char *settings_extension; /* of the settings file that its program, a renderer, reads:
                                     * "ini"; NULL: there is none */
    const char *description;        /* "a scene for POV-Ray 3.7" */
    bool binary;                    /* true: its file is not text */
    bool has_view;                  /* writes camera, lights and background, and not only vessels */
    bool of_meshes;                 /* writes params->mesh, not the scene */
    bool of_lines;      /* writes params->vessels as curves, with params->anatomy; not the scene */
    bool has_colors;    /* writes params->appearance, and groups by the orders of params->anatomy */
    bool has_parts;     /* writes params->ends */
    bool has_layers;    /* writes params->layers */
    const char *option; /* the option that selects it; NULL: it is the default of its extension */
    unsigned elements;  /* bits of ModelProperty: the elements of the models that it can write */
    /* Checks the name of the second file. Errors: STATUS_USAGE. NULL: any name is allowed. */
    Status (*check_name)(const char *second_file, Err *err);
    /* Appends the settings file params->settings. Errors: STATUS_USAGE if the program cannot read a
     * file of that name, and those of `write`. NULL: the format has no such file. */
    Status (*write_settings)(const EmitParams *params, Text *out, Err *err);
    /* Appends the file, and the second file, to the texts. If the texts have streams [base/text.h],
     * memory does not grow with the scene. On failure the texts contain incomplete files.
     *
     * Errors: STATUS_INPUT if a template is missing or lacks a placeholder, STATUS_USAGE as
     * check_name, STATUS_INFEASIBLE if the format or its program cannot hold the scene, STATUS_IO,
     * STATUS_MEMORY. */
    Status (*write)(const EmitParams *params, EmitOutput *to, Err *err);
} Emitter;

/* The table of formats. It ends with a row whose name is NULL. */
extern const Emitter emitters[];
/* Returns the default emitter for an extension ("pov"): of meshes or curves if `meshes_or_curves`,
 * else of scenes. Returns NULL if there is none. */
const Emitter *emitter_find(const char *extension, bool meshes_or_curves);
/* Returns the emitter with this extension that the command-line option `option` selects, or NULL if
 * there is none. */
const Emitter *emitter_by_option(const char *extension, const char *option);
/* Appends the extensions of the emitters of meshes and curves if `meshes_or_curves`, else of
 * scenes, as a list in a sentence: ".pov, .scad or .tachyon". */
void emitter_extensions(bool meshes_or_curves, Text *out);

/* Checks that the format can write a model of vessel geometry. Errors: STATUS_USAGE, with the names
 * of the models that the format can write. */
MUST_CHECK Status emit_check_model(const Emitter *emitter, SceneModel model, Err *err);

/* Appends the file, the second file and the settings file to the texts of *to. After an error the
 * texts hold incomplete files. Errors: those of emit_check_model, Emitter.check_name, Emitter.write
 * and Emitter.write_settings. */
MUST_CHECK Status emit_write(const Emitter *emitter, const EmitParams *params, EmitOutput *to,
                             Err *err);

/* Estimates the load of a scene for POV-Ray from the number of its objects. POV-Ray reads a scene
 * of load 1 in about ten seconds and 1 GB of memory, if its vessels are arranged as in grown trees.
 * POV-Ray can hold any scene of load 2 or less.
 *
 * Errors   STATUS_MEMORY.
 * Cost     O(objects); for an isosurface without params->built, also the cost of celltree_build. */
MUST_CHECK Status povray_load(const EmitParams *params, double *load, Err *err);

/* Appends the file that POV-Ray reads before a scene to draw depth, normals or ids instead of
 * colors [docs/POVRAY.md, section 6]. It is the same for all scenes. Uses params->templates.
 * Errors: those of Emitter.write. */
MUST_CHECK Status povray_write_planes(const EmitParams *params, Text *out, Err *err);

/* The box of a density file for POV-Ray. */
typedef struct DensityBox {
    Box box;            /* mm, in coordinates of its own */
    Vec3 origin;        /* position of the origin of these coordinates in those of the tree, mm */
    int64_t n[3];       /* number of voxels along each axis */
    double thickest_mm; /* largest diameter */
} DensityBox;

/* Appends a scene in which the vessels of a density file glow. params->file is the name of the
 * scene, params->second_file the name of the density file; templates, description, generator and
 * command of `params` are used, too. Errors: STATUS_USAGE if POV-Ray cannot read a file of that
 * name, and those of Emitter.write. */
MUST_CHECK Status emit_density(const EmitParams *params, const DensityBox *density, Text *out,
                               Err *err);

#endif
