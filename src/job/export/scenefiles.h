/* Names and fills the output files of a scene, a mesh or curves. Call scene_files_find and
 * scene_files_name. After the scene is made, call scene_files_put. */
#ifndef CORCAST_JOB_EXPORT_SCENEFILES_H
#define CORCAST_JOB_EXPORT_SCENEFILES_H

#include "emit/emit.h"
#include "job/work.h"

/* The files that one output consists of. The values are indices in FileSet.at. */
typedef enum SceneFile {
    SCENE_FILE,
    SCENE_SECOND,   /* a second file that some formats have, such as .inc beside .pov */
    SCENE_SETTINGS, /* the settings of the program that draws the scene */
    MESH_MANIFEST,  /* JSON with the facts about a mesh */
    MESH_ENDS,      /* a CSV table of the vessel ends of a mesh */
    MESH_CENTERLINE,
    MESH_GMSH, /* geometry for gmsh, with named surfaces and volumes */
    MESH_CORE, /* geometry for gmsh of the space inside the layers of prisms along the wall */
    SCENE_FILES
} SceneFile;

/* Finds the default emitter [emit/emit.h] for the extension of a file name.
 *
 * of_meshes  true: among the emitters of meshes and curves; false: among those of scenes.
 * emitter    receives the emitter, a static object; NULL after an error.
 * Errors     STATUS_USAGE, with the known extensions; STATUS_MEMORY. */
MUST_CHECK Status scene_files_find(const char *output, bool of_meshes, const Emitter **emitter,
                                   Err *err);

/* Sets the paths and roles (words for messages) of the file `path` and of the additional files that
 * the emitter writes. If `path` is "-", standard output, there are no additional files.
 *
 * settings  true: the settings file is written.
 * files     zeroed by the caller, who releases it with fileset_release even after an error.
 * Errors    STATUS_USAGE if the format cannot use the name of the second file; STATUS_MEMORY. */
MUST_CHECK Status scene_files_name(const Emitter *emitter, const char *path, bool settings,
                                   FileSet *files, Err *err);

/* Appends the scene, its second file and the settings to the texts of `files`.
 *
 * params     parameters of emit_write. The members file, second_file, settings, templates,
 *            description and generator are ignored.
 * tree_path  path of the tree, for the description in the file.
 * files      FileSet.at, after scene_files_name.
 * report     receives the facts about the scene; NULL: not wanted.
 * Errors     those of emit_write [emit/emit.h]. */
MUST_CHECK Status scene_files_put(const Emitter *emitter, const EmitParams *params,
                                  const char *tree_path, FileSlot files[], EmitReport *report,
                                  Err *err);

#endif
