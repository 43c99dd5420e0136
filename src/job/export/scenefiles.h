/* The files of a scene, a mesh or curves: their names, and their content. */
#ifndef CORCAST_JOB_EXPORT_SCENEFILES_H
#define CORCAST_JOB_EXPORT_SCENEFILES_H

#include "emit/emit.h"
#include "job/work.h"

/* Positions in FileSet. */
typedef enum SceneFile {
    SCENE_FILE,
    SCENE_SECOND,   /* the emitter's second file */
    SCENE_SETTINGS, /* the settings of the program that draws the scene */
    MESH_MANIFEST,  /* the facts about a mesh */
    MESH_ENDS,      /* a table of its ends */
    MESH_CENTERLINE,
    MESH_GMSH, /* its surfaces and volumes by name, for gmsh */
    MESH_CORE, /* what is inside its layers of prisms, for gmsh */
    SCENE_FILES
} SceneFile;

/* Finds the emitter of scenes, or of meshes and curves, for a file of this name. Errors:
 * STATUS_USAGE, with the extensions that there are. */
MUST_CHECK Status scene_files_find(const char *output, bool of_meshes, const Emitter **emitter,
                                   Err *err);

/* Sets the paths and roles of the files that the emitter writes to `path` and beside it. For "-",
 * which is standard output, this is one file.
 *
 * settings  the settings file is written.
 * files     zeroed, except for the taker; fileset_release releases it, also after an error.
 * Errors    STATUS_USAGE if the format cannot use a second file of that name, STATUS_MEMORY. */
MUST_CHECK Status scene_files_name(const Emitter *emitter, const char *path, bool settings,
                                   FileSet *files, Err *err);

/* Appends the file, the second file and the settings to the texts of `files`, whose paths
 * scene_files_name has set.
 *
 * params     need not contain names of files, templates, description and generator.
 * tree_path  the tree that is described as drawn.
 * report     may be NULL.
 * Errors     as emit_write. */
MUST_CHECK Status scene_files_put(const Emitter *emitter, const EmitParams *params,
                                  const char *tree_path, FileSlot files[], EmitReport *report,
                                  Err *err);

#endif
