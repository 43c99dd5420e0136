/* The operation `scene`: writes a tree as a scene for POV-Ray, OpenSCAD or Tachyon. */
#ifndef CORCAST_JOB_EXPORT_SCENE_H
#define CORCAST_JOB_EXPORT_SCENE_H

#include "job/export/meshing.h"
#include "job/picture/picture.h"
#include "job/work.h"
#include "options/options.h"

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

/* Describes the operation. Its options set a SceneOptions. */
extern const Command command_scene;

/* A scene in memory, or a surface if the format stores meshes. All members except `emitter` are
 * owned. */
typedef struct SceneResult {
    const Emitter *emitter; /* the format that the result was made for */
    PictureSource source;   /* the tree; if the emitter writes meshes, the tree has moved to
                             * `mesh` */
    Scene scene;            /* set if the emitter writes scenes, as is `anatomy` */
    Anatomy anatomy;
    MeshResult mesh; /* set if the emitter writes meshes */
    FileSet files;   /* the files of options->output; none if there is no output */
} SceneResult;

/* Makes the scene of a tree. Without an output, the scene is made for POV-Ray. Sends notes about
 * parts of the tree and effects that the scene does not contain.
 *
 * taker    receives the files of scene_write; NULL: they are written to the file system.
 * out      set on success only. It borrows from `options` and `parsed`; release it with
 *          sceneresult_release.
 * Errors   STATUS_USAGE if an option has no effect on the format, or if the output has no known
 *          extension; those of picture_read_source, picture_scene_of, scene_files_name and
 *          meshing_make. */
MUST_CHECK Status scene_make(const SceneOptions *options, Parsed *parsed, const FileTaker *taker,
                             SceneResult *out, Err *err);
void sceneresult_release(SceneResult *scene);

/* Writes the files of a scene that scene_make has made with the same options, which must have an
 * output. Sends notes about the limits of the file. Must be called only once. Errors: those of
 * scene_files_put, meshing_write and work_write. */
MUST_CHECK Status scene_write(const SceneOptions *options, const Parsed *parsed, SceneResult *scene,
                              Err *err);

/* Makes a scene and writes it. `options` is a SceneOptions with an output. Errors: those of
 * scene_make and scene_write. */
MUST_CHECK Status scene_run(void *options, Parsed *parsed, Err *err);

#endif
