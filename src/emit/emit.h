/* The door of the room emit: scene -> files for other programs. Their languages stand in
 * templates/; C writes only numbers and calls of what the templates define. */
#ifndef CORCAST_EMIT_EMIT_H
#define CORCAST_EMIT_EMIT_H

#include "base/base.h"
#include "field/field.h"
#include "scene/scene.h"

/* The most vessels that OpenSCAD unites in good time; of more, a mesh is the better model. */
#define OPENSCAD_QUICK 100

/* What may stand beside a mesh, each in a file of its own. */
typedef enum EmitBeside {
    BESIDE_MANIFEST,
    BESIDE_ENDS,       /* a table of its ends */
    BESIDE_CENTERLINE, /* its tree */
    BESIDE_GMSH,       /* its surfaces and volumes by name, for gmsh */
    BESIDES
} EmitBeside;

/* What is written, and how it is called. All is borrowed. */
typedef struct EmitParams {
    const Scene *scene;               /* NULL for an emitter of meshes or lines */
    const Anatomy *anatomy;           /* of its tree; NULL: orders are 0, and nothing is named */
    const VesselMesh *mesh;           /* for an emitter of meshes; else NULL. Likewise: */
    const VesselTree *vessels;        /* whose segments the mesh's labels name, or that are lines */
    const Appearance *appearance;     /* for an emitter of meshes or lines with colours */
    const double *orders;             /* Strahler order of each segment, by its number; likewise */
    const MeshEnds *ends;             /* of the mesh, for an emitter with parts */
    const Text *beside[BESIDES];      /* what stands beside the mesh; NULL: nothing */
    const char *beside_path[BESIDES]; /* its path; NULL: it is not written */
    const char *templates;            /* the folder of templates, one folder for each language */
    const char *file;        /* names of the files as they stand in them, without folders; */
    const char *second_file; /* NULL: what would go to the second file stands in the first */
    const char *description; /* what the scene shows; line ends in it become blanks */
    const char *settings; /* NULL, or the file, beside those, that its program is started with; */
    const char *settings_path; /* where it is written; both or neither */
    int antialias;             /* samples along a pixel's side; 1: the program's own choice */
    const char *generator;     /* program and version */
    const char *command;       /* that makes the scene, one line */
    bool shadows;
    bool ids;         /* isosurface, blob: with the paint that the id plane needs */
    bool planes;      /* Tachyon: colours that tell depth and segment, in the place of the look's */
    CellParams cells; /* isosurface */
    const CellTree *built; /* isosurface: its cells where they are found already; NULL: they are
                            * found anew */
    const PixelRect *part; /* POV-Ray, without an anatomy, with cells that are built: only what the
                            * rays of this part of the picture can meet, each piece as the whole
                            * scene has it; NULL: all */
} EmitParams;

typedef struct EmitReport {
    size_t cells;    /* of an isosurface, or of a blob that is cut into cells; else 0 */
    int joint_sides; /* of a joint's mesh; 0: joints are exact, which POV-Ray can hold 349,000 of */
    double openscad_s; /* estimate of how long OpenSCAD takes to make a solid; else 0 */
} EmitReport;

/* A format that scenes are written in: one row of `emitters`. */
typedef struct Emitter {
    const char *name;             /* "povray" */
    const char *extension;        /* of its file: "pov" */
    const char *second_extension; /* of the file beside it: "inc"; NULL: it writes one file */
    const char *second_holds;     /* "the geometry" */
    const char
        *settings_extension; /* of the file that its program is started with: "ini"; or NULL */
    const char *description; /* "a scene for POV-Ray 3.7" */
    bool binary;
    bool has_view;      /* it holds camera, lights and background, and not the vessels alone */
    bool of_meshes;     /* it writes params->mesh, not the scene */
    bool of_lines;      /* likewise params->vessels, by params->anatomy; there is no mesh */
    bool has_colors;    /* of meshes: it writes params->appearance and groups by params->orders */
    bool has_parts;     /* of meshes: it writes params->ends */
    const char *option; /* that asks for it; NULL: it is the format of its extension */
    unsigned elements;  /* it can write what is made of these: bits ModelElement */
    /* STATUS_USAGE when the format cannot name a second file so. NULL: it takes any name. */
    Status (*check_name)(const char *second_file, Err *err);
    /* Appends the file params->settings to *out. STATUS_USAGE when the program cannot be given a
     * file of that name. NULL: the format has no such file. */
    Status (*write_settings)(const EmitParams *params, Text *out, Err *err);
    /* Appends the file to *out and, where params->second_file is given, the second one to *second,
     * as they are made: with streams [base/text.h] memory does not grow with the scene. *report is
     * zeroed before. STATUS_INPUT when a template is missing or does not fit, STATUS_USAGE as
     * check_name, STATUS_INFEASIBLE when the format or its program cannot hold the scene,
     * STATUS_IO, STATUS_MEMORY; the texts then end anywhere. */
    Status (*write)(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                    Err *err);
} Emitter;

/* A row without a name ends them. */
extern const Emitter emitters[];
/* The emitter of scenes, or of meshes and lines, whose files have this extension ("pov"), or NULL.
 */
const Emitter *emitter_find(const char *extension, bool of_meshes);
/* The emitter of meshes or lines with this extension that an option of this name asks for, or NULL.
 */
const Emitter *emitter_asked(const char *extension, const char *option);
/* Appends the extensions of one or the other: ".pov or .scad". */
void emitter_extensions(bool of_meshes, Text *out);

/* STATUS_USAGE when the format cannot hold a model, with the names of those that it can. */
MUST_CHECK Status emit_check_model(const Emitter *emitter, SceneModel model, Err *err);

/* Writes `path`, "-" being standard output, `second_path`, which is NULL when and only when
 * params->second_file is, the settings and what stands beside: all take their final names, or none
 * does. `report` may be NULL. As emit_check_model, and all that `write` returns. */
MUST_CHECK Status emit_files(const Emitter *emitter, const EmitParams *params, const char *path,
                             const char *second_path, EmitReport *report, Err *err);

/* How much work the scene is for POV-Ray, by the number of its pieces: POV-Ray reads each plane of
 * a scene of load 1 in some ten seconds and at most 1 GB, where vessels lie as in grown trees; it
 * can hold a load of 2 of any model. STATUS_MEMORY. O(pieces); of an isosurface without cells that
 * are built, as celltree_build. */
MUST_CHECK Status povray_load(const EmitParams *params, double *load, Err *err);

/* How much of a box vessels fill, in a density file for POV-Ray. */
typedef struct DensityBox {
    Box box;            /* mm */
    Vec3 origin;        /* where its origin lies in the coordinates of the tree */
    int64_t n[3];       /* voxels */
    double thickest_mm; /* a diameter */
} DensityBox;

/* Appends a scene, params->file, in which the vessels of the density file params->second_file glow.
 * Of the rest of `params` it needs templates, description, generator and command. STATUS_USAGE when
 * POV-Ray cannot read a file of that name, STATUS_INPUT as Emitter.write. */
MUST_CHECK Status emit_density(const EmitParams *params, const DensityBox *density, Text *out,
                               Err *err);

#endif
