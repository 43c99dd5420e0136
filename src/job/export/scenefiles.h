/* A scene as the files that another program reads. */
#ifndef CORCAST_JOB_EXPORT_SCENEFILES_H
#define CORCAST_JOB_EXPORT_SCENEFILES_H

#include "base/base.h"
#include "emit/emit.h"
#include "options/files.h"
#include "scene/scene.h"

/* The emitter of scenes, or of meshes, for a file of this name. STATUS_USAGE, naming the
 * extensions that there are. */
MUST_CHECK Status scene_files_find(const char *output, bool of_meshes, const Emitter **emitter,
                                   Err *err);

/* Takes note of the files that scene_files_write writes beside `path`, also of its settings or not.
 * STATUS_USAGE when the format cannot name one so. */
MUST_CHECK Status scene_files_note(const Emitter *emitter, const char *path, bool settings,
                                   Files *files, Err *err);

/* Writes `path` and, beside it, the emitter's second file, its settings if asked, and of a mesh
 * what params->beside has; "-" is one file on standard output. `params` lacks what follows from the
 * paths, the templates, and who writes. The rest as emit_files. */
MUST_CHECK Status scene_files_write(const Emitter *emitter, const EmitParams *params,
                                    const char *tree_path, const char *path, bool settings,
                                    EmitReport *report, Err *err);

#endif
