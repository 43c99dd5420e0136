/* Names and fills the output files of a scene, a mesh or curves. */
#ifndef CORCAST_JOB_EXPORT_SCENEFILES_H
#define CORCAST_JOB_EXPORT_SCENEFILES_H

#include "emit/emit.h"
#include "job/work.h"

/* The files of an output: indices in FileSet.at. */
typedef enum SceneFile {
    SCENE_FILE,
    SCENE_SECOND,   /* the emitter's second file */
    SCENE_SETTINGS, /* the settings of the program that draws the scene */
    MESH_MANIFEST,  /* the facts about a mesh */
    MESH_ENDS,      /* a table of its ends */
    MESH_CENTERLINE,
    MESH_GMSH, /* geometry for gmsh, with named surfaces and volumes */
    MESH_CORE, /* geometry for gmsh: the space inside the layers of prisms */
    SCENE_FILES
} SceneFile;

/* Finds the default emitter [emit/emit.h] for the extension of a file name: of meshes and curves if
 * `of_meshes`, else of scenes. Errors: STATUS_USAGE, with the known extensions; STATUS_MEMORY.
 * *emitter is then NULL. */
MUST_CHECK Status scene_files_find(const char *output, bool of_meshes, const Emitter **emitter,
                                   Err *err);

/* Sets the paths and roles of the file `path` and of the additional files that the emitter writes.
 * For "-", standard output, there are no additional files.
 *
 * settings  the settings file is written.
 * files     zeroed by the caller, who releases it with fileset_release even after an error.
 * Errors    STATUS_USAGE if the format cannot use the name of the second file; STATUS_MEMORY. */
MUST_CHECK Status scene_files_name(const Emitter *emitter, const char *path, bool settings,
                                   FileSet *files, Err *err);

/* Appends the file, the second file and the settings to the texts of `files`. The paths of `files`
 * must have been set by scene_files_name.
 *
 * params     the members file, second_file, settings, templates, description and generator are
 *            ignored.
 * tree_path  path of the tree, for the description.
 * report     may be NULL.
 * Errors     those of emit_write. */
MUST_CHECK Status scene_files_put(const Emitter *emitter, const EmitParams *params,
                                  const char *tree_path, FileSlot files[], EmitReport *report,
                                  Err *err);

#endif
