/* The operation `scene`: writes a tree as a scene for POV-Ray, OpenSCAD or Tachyon. */
#ifndef CORCAST_JOB_EXPORT_SCENE_H
#define CORCAST_JOB_EXPORT_SCENE_H

#include "job/export/meshing.h"
#include "job/picture/picture.h"
#include "job/work.h"
#include "options/options.h"

/* How a model for OpenSCAD is made. */
typedef enum ScadForm {
    SCAD_AUTO,       /* by the number of vessels */
    SCAD_PARAMETRIC, /* modules, which OpenSCAD unites */
    SCAD_POLYHEDRON  /* one closed surface */
} ScadForm;

typedef struct SceneOptions {
    const char *output; /* its extension selects the format */
    bool ids;           /* adds what POV-Ray needs for the id plane */
    bool ini;           /* writes the settings file, too */
    ScadForm scad;
    PictureOptions picture;
} SceneOptions;

/* Describes the operation. Its options set a SceneOptions. */
extern const Command command_scene;

/* A scene in memory, or the surface that a format without scenes needs. Everything but `emitter` is
 * owned. */
typedef struct SceneResult {
    const Emitter *emitter; /* the format that the result was made for */
    PictureSource source;   /* its tree has moved to `mesh` if the emitter writes meshes */
    Scene scene;            /* if the emitter writes scenes, like `anatomy` */
    Anatomy anatomy;
    MeshResult mesh; /* if the emitter writes meshes */
    FileSet files;   /* the files of options->output; none if there is no output */
} SceneResult;

/* Makes the scene of a tree. Without an output, the scene is made for POV-Ray. Reports what the
 * scene does not show of the tree.
 *
 * taker    receives the files of scene_write instead of the file system; NULL: they are written.
 * out      borrows from `options` and `parsed`; release it with sceneresult_release.
 * Errors   STATUS_USAGE if an option has no effect on the format, or if the output has no known
 *          extension; those of picture_read_source, picture_scene_of, scene_files_name and
 *          meshing_make. */
MUST_CHECK Status scene_make(const SceneOptions *options, Parsed *parsed, const FileTaker *taker,
                             SceneResult *out, Err *err);
void sceneresult_release(SceneResult *scene);

/* Writes the files of a scene that scene_make has made with the same options, which must have an
 * output. Reports the limits of the file. To be called once. Errors: those of scene_files_put,
 * meshing_write and work_write. */
MUST_CHECK Status scene_write(const SceneOptions *options, const Parsed *parsed, SceneResult *scene,
                              Err *err);

/* Makes and writes the scene of a SceneOptions with an output. */
MUST_CHECK Status scene_run(void *options, Parsed *parsed, Err *err);

#endif
