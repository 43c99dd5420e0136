/* Draws a scene with POV-Ray: writes the scene files, runs POV-Ray once per plane and tile, several
 * runs side by side, and puts the planes together. */
#ifndef CORCAST_ORACLE_POVRAY_TILES_H
#define CORCAST_ORACLE_POVRAY_TILES_H

#include "emit/emit.h"
#include "oracle/planes.h"
#include "oracle/povray.h"

/* What POV-Ray draws, and where. All pointers are borrowed until povraytiles_free. */
typedef struct PovrayTilesParams {
    EmitParams emit;    /* the scene, its colors at all moments, and how it is written; without file
                         * names, `ids`, `built` and `part` */
    const char *folder; /* an existing folder, for scenes and planes */
    double clock;       /* moment of the scene, in [0, 1] */
    int antialias;      /* N x N samples per pixel of the colors */
    int bits;           /* of the colors: 8 (sRGB) or 16 (linear) */
    bool alpha;         /* alpha is drawn, too, unless there are several tiles */
    int min_tiles;      /* 1 or more */
    int threads;        /* 0: all processors */
    ProgramChoice program;
    ProgramProgress *progress; /* called by any thread, by one at a time; may be NULL */
    void *progress_context;
} PovrayTilesParams;

/* All runs of POV-Ray for one picture. */
typedef struct PovrayTiles PovrayTiles;

/* Divides the picture into tiles, and writes their scenes: scene.pov and scene.inc, or with several
 * tiles scene.tile-1.pov and so on, and POVRAY_PLANES_FILE. There is one tile if POV-Ray can hold
 * the whole scene and `min_tiles` is 1.
 *
 * tiles   set on success; release it with povraytiles_free.
 * Errors  STATUS_INFEASIBLE if POV-Ray cannot hold the smallest tile, STATUS_USAGE if the picture
 *         is too small for `min_tiles`; and as emit_write. */
MUST_CHECK Status povraytiles_prepare(const PovrayTilesParams *params, PovrayTiles **tiles,
                                      Err *err);

/* Returns the number of tiles, 1 or more. */
size_t povraytiles_count(const PovrayTiles *tiles);
/* Returns the number of runs of POV-Ray. */
size_t povraytiles_n_commands(const PovrayTiles *tiles);
/* Returns the command line of a run, as povray_command formats it; borrowed. */
const char *povraytiles_command(const PovrayTiles *tiles, size_t run);

/* Runs POV-Ray until all planes of all tiles are drawn, and reads them.
 *
 * planes  receives picture, depth, normals and ids, and alpha if it is drawn. Release it with
 *         planes_release, also after an error.
 * run     receives POV-Ray's version, and the seconds of the color plane, summed over tiles.
 * Errors  as povray_draw. A picture that cannot be read is STATUS_TOOL. */
MUST_CHECK Status povraytiles_draw(PovrayTiles *tiles, OraclePlanes *planes, PovrayRun *run,
                                   Err *err);

/* NULL is allowed. */
void povraytiles_free(PovrayTiles *tiles);

#endif
