/* POV-Ray's side of a verification. */
#ifndef CORCAST_APP_POVRAY_SIDE_H
#define CORCAST_APP_POVRAY_SIDE_H

#include "app/pictures/verification.h"

/* Writes the scene for POV-Ray, has it draw all planes, and reads them: v->povray, povray_picture,
 * run, n_tiles and the commands. A scene that is more than POV-Ray holds, or where
 * v->least_tiles > 1, is drawn in tiles, each from scenes of its own, scene.tile-1.pov and so on.
 * STATUS_INFEASIBLE when POV-Ray cannot hold a tile of the fewest pixels, STATUS_USAGE when there
 * are not as many tiles; else errors as scene_files_write and oracle_run have them. */
MUST_CHECK Status povray_side_draw(Verification *v, Err *err);

#endif
