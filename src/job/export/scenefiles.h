/* A scene as the files that another program reads, and which POV-Ray to run. */
#ifndef CORCAST_JOB_EXPORT_SCENEFILES_H
#define CORCAST_JOB_EXPORT_SCENEFILES_H

#include "base/base.h"
#include "compare/compare.h"
#include "emit/emit.h"
#include "options/files.h"
#include "oracle/oracle.h"
#include "oracle/tachyon.h"
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

/* Which POV-Ray to run and how long to bear its silence, as the environment says: CORCAST_POVRAY
 * (povray) and CORCAST_POVRAY_PATIENCE, in seconds (600). STATUS_USAGE when that is no number. */
MUST_CHECK Status povray_from_environment(OracleParams *params, Err *err);
/* Likewise which Tachyon, CORCAST_TACHYON (tachyon), by the same patience. */
MUST_CHECK Status tachyon_from_environment(WitnessParams *params, Err *err);

#endif
