/* POV-Ray's side of a verification. */
#ifndef CORCAST_JOB_VERIFY_POVRAY_SIDE_H
#define CORCAST_JOB_VERIFY_POVRAY_SIDE_H

#include "job/verify/verification.h"
#include "oracle/oracle.h"

typedef struct PovraySide PovraySide;

/* Writes the scene for POV-Ray, and adds the commands that have POV-Ray draw its planes: v->n_tiles
 * and v->commands. A scene that is more than POV-Ray holds, or where v->least_tiles > 1, is drawn
 * in tiles, each from scenes of its own, scene.tile-1.pov and so on. *side is for povray_side_free,
 * and borrows *v. STATUS_INFEASIBLE when POV-Ray cannot hold a tile of the fewest pixels,
 * STATUS_USAGE when there are not as many tiles; else errors as scene_files_write has them. */
MUST_CHECK Status povray_side_prepare(Verification *v, PovraySide **side, Err *err);

/* Has POV-Ray draw all planes, and reads them: v->povray, povray_picture and run. Another thread
 * may meanwhile read the rest of the Verification and write what else is drawn. Errors as
 * oracle_run has them. */
MUST_CHECK Status povray_side_draw(PovraySide *side, Err *err);

/* NULL is fine. */
void povray_side_free(PovraySide *side);

#endif
