/* A scene as the files that POV-Ray reads. */
#ifndef CORCAST_APP_POVFILES_H
#define CORCAST_APP_POVFILES_H

#include "app/files.h"
#include "base/base.h"
#include "emit/emit.h"
#include "scene/scene.h"
#include "verify/verify.h"

/* Takes note of the geometry that povfiles_write writes beside the scene `path`. STATUS_USAGE when
 * POV-Ray could not include it. */
MUST_CHECK Status povfiles_note(const char *path, Files *files, Err *err);

/* Writes `path` and, beside it, its geometry with the extension .inc; "-" is one file on standard
 * output. The rest as in PovrayParams; `report` may be NULL. */
MUST_CHECK Status povfiles_write(const Scene *scene, const char *tree_path, const char *path,
                                 bool shadows, bool ids, const CellParams *cells,
                                 PovrayReport *report, Err *err);

/* Which POV-Ray to run and how long to bear its silence, as the environment says: CORCAST_POVRAY
 * (povray) and CORCAST_POVRAY_PATIENCE, in seconds (600). STATUS_USAGE when that is no number. */
MUST_CHECK Status povray_from_environment(OracleParams *params, Err *err);

#endif
