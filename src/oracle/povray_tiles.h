/* Draws a scene with POV-Ray, tile by tile if the whole scene exceeds a limit of POV-Ray. Writes
 * the scene files, runs POV-Ray once per plane and tile, several runs at the same time, and
 * assembles the planes. Call povraytiles_prepare, povraytiles_draw, and povraytiles_free. */
#ifndef CORCAST_ORACLE_POVRAY_TILES_H
#define CORCAST_ORACLE_POVRAY_TILES_H

#include "emit/emit.h"
#include "oracle/planes.h"
#include "oracle/povray.h"

/* The parameters of a drawing. All pointers are borrowed until povraytiles_free. */
typedef struct PovrayTilesParams {
    EmitParams emit; /* the scene with its colors at all time steps, and the parameters of its file;
                      * file names, `ids`, `built` and `part` are ignored */
    const char *folder; /* an existing folder, for scenes and planes */
    double clock;       /* POV-Ray's clock, which selects the time step, in [0, 1] */
    int antialias;      /* N x N samples per pixel of the colors */
    int bits;           /* bits of the colors: 8 (sRGB) or 16 (linear) */
    bool alpha; /* alpha is also drawn; with several tiles it is not, and planes->alpha is empty */
    int min_tiles; /* 1 or more */
    int threads;   /* 0: all processors */
    ProgramChoice program;
    ProgramProgress *progress; /* called by any thread, but only by one at a time; may be NULL */
    void *progress_context;
} PovrayTilesParams;

/* All runs of POV-Ray for one picture. */
typedef struct PovrayTiles PovrayTiles;

/* Divides the picture into tiles, and writes their scenes: scene.pov and scene.inc, or with several
 * tiles scene.tile-1.pov and so on, and POVRAY_PLANES_FILE. There is one tile if the whole scene is
 * within POV-Ray's limits and `min_tiles` is 1.
 *
 * tiles   set on success; release it with povraytiles_free.
 * Errors  STATUS_INFEASIBLE if even the smallest tile exceeds POV-Ray's limits; STATUS_USAGE if the
 *         picture is too small for `min_tiles`; the errors of emit_write. */
MUST_CHECK Status povraytiles_prepare(const PovrayTilesParams *params, PovrayTiles **tiles,
                                      Err *err);

/* Returns the number of tiles, 1 or more. */
size_t povraytiles_count(const PovrayTiles *tiles);
/* Returns the number of runs of POV-Ray: one per plane and tile. */
size_t povraytiles_n_commands(const PovrayTiles *tiles);
/* Returns the command line of run `run`, counted from 0, as povray_command formats it; borrowed. */
const char *povraytiles_command(const PovrayTiles *tiles, size_t run);

/* Runs POV-Ray until all planes of all tiles are drawn, and reads them.
 *
 * planes  receives picture, depth, normals and ids, and alpha if it is drawn. Release it with
 *         planes_release, also after an error.
 * run     receives POV-Ray's version, and the duration of the color plane, summed over tiles.
 * Errors  those of povray_draw; STATUS_TOOL if a picture cannot be read. */
MUST_CHECK Status povraytiles_draw(PovrayTiles *tiles, OraclePlanes *planes, PovrayRun *run,
                                   Err *err);

/* Frees the runs. `tiles` may be NULL. */
void povraytiles_free(PovrayTiles *tiles);

#endif
