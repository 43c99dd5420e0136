/* Draws the ids and depths of a scene with Tachyon and reads these planes. Tachyon is a renderer
 * that shares no code with corcast or POV-Ray. It reads coordinates in single precision, computes
 * in double precision, and writes depth in 65535 steps. */
#ifndef CORCAST_ORACLE_TACHYON_H
#define CORCAST_ORACLE_TACHYON_H

#include "emit/emit.h"
#include "image/image.h"
#include "oracle/program.h"

/* The parameters of a drawing. All pointers are borrowed. */
typedef struct TachyonParams {
    EmitParams emit;    /* the scene, and the parameters of its file; file names are ignored */
    const char *folder; /* an existing folder, for the scene and the planes */
    int threads;        /* 0: Tachyon's own default */
    ProgramChoice program;
} TachyonParams;

/* The facts about the two runs. */
typedef struct TachyonRun {
    char version[16]; /* "0.99"; "unknown" if Tachyon prints none */
    double seconds;   /* wall-clock time of both planes */
} TachyonRun;

/* Writes the scene to scene.tachyon, runs Tachyon once for the ids and once for the depth, and
 * reads both planes, tachyon.id.ppm and tachyon.depth.ppm.
 *
 * frame   zeroed before; receives id and depth (mm along the ray; INFINITY where no surface is
 *         visible). Release it with frame_release, also after an error.
 * run     receives version and duration; also changed by a call that fails.
 * Errors  STATUS_INPUT if the format cannot store the scene; the errors of program_draw. If Tachyon
 *         fails, the sentence quotes Tachyon's message. */
MUST_CHECK Status tachyon_draw(const TachyonParams *params, Frame *frame, TachyonRun *run,
                               Err *err);

#endif
